"""Saving into files that a person works with, so that nothing of theirs is lost."""
