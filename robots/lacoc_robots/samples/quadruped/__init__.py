"""A robot with four legs."""
