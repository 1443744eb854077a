"""Keeps what the rules of a match saw and decided, for take-backs, and saves whole matches."""
