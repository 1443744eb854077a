"""Saves tables into a student's own files, and keeps everything else that is in them."""
