"""Robots: their files, models, limits and samples."""
