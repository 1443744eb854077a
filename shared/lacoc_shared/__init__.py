"""Definitions that both ends of a match share."""

__version__ = "0.1.0"
