"""The record of a match: written beat by beat, read back, proven."""
