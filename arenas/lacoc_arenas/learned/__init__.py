"""Bots that a machine learned: what they see of a frame as numbers, and how numbers make a key."""
