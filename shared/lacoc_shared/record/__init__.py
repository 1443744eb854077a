"""The record of a match: written while the match runs, and read again for replays and exports."""
