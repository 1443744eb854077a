"""The contest file, and the ways for each person to get into a contest."""
