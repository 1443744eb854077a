"""Reads the C header in which the workshop describes a robot, and makes a robot file of it."""
