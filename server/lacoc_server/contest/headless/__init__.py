"""A contest without a network: bots play its games in many processes."""
