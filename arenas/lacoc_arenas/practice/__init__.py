"""Practice: one robot, an open field, no time limit (workshop 4-4)."""
