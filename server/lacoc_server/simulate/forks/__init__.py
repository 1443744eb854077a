"""Forks of a record: its match goes on from one of its beats, as it was or with a change."""
