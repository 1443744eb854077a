"""The command `lacoc` and what all its subcommands share."""
