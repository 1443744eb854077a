"""The command `lacoc` and what its subcommands share."""
