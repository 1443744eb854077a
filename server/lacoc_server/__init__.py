"""The court: the only authority of a match."""
