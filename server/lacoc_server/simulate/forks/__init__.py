"""Forks of a record: a match that goes on from any of its beats, as it was or with a change."""
