"""The subcommands of `lacoc` that need this package, such as serve, simulate and contest."""
