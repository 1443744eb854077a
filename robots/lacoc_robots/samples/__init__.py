"""Robots to begin with, each with a gait that walks."""
