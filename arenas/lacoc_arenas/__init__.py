"""Games: their rules, fields and bots."""
