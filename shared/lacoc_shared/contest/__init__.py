"""The contest file, and how each person gets into a contest."""
