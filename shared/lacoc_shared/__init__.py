"""Definitions that courts and their clients share."""

__version__ = "0.1.0"
