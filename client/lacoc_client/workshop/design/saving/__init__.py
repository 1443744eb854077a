"""Saves tables into a student's own files, and loses nothing else that is in them."""
