"""A six-legged robot with long legs."""
