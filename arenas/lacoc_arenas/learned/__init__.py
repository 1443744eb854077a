"""Learned bots: which numbers of a frame they see, and how these numbers choose a key."""
