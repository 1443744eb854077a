"""What an organiser does with a contest: the same acts for commands and for the office."""
