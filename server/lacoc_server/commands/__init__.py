"""The subcommands of `lacoc` that need this package: courts, simulated matches, trials, keys."""
