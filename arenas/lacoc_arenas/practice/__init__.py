"""Practice: one robot, an open field, no end (workshop 4-4)."""
