"""Data that a match keeps: the judged ticks, for take-backs, and its whole state as bytes."""
