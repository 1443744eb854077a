"""A robot with eight legs."""
