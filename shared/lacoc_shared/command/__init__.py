"""The command `lacoc`, and the parts that its subcommands share."""
