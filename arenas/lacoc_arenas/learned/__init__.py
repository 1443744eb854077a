"""Learned bots: which numbers of a frame they see, and how they choose a key from these."""
