"""The games that robots play: their rules, fields and bots."""
