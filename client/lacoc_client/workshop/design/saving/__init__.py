"""Saves a student's own files; with a table of postures, all else that is in them is kept."""
