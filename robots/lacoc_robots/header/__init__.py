"""Reads the workshop's C header of a robot, and writes it as a robot file (workshop 4-3)."""
