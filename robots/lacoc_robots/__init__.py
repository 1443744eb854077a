"""Robots: their files, their models for physics, their limits, and sample robots."""
