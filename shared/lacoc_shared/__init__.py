"""What both ends of a match must agree on."""

__version__ = "0.1.0"
