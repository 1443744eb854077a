"""The subcommands of `lacoc` that need a court."""
