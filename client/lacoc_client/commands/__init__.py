"""The subcommands of `lacoc` for everyone but the court."""
