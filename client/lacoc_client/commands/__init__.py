"""The subcommands of `lacoc` that need no court on this machine."""
