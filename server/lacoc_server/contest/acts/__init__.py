"""What an organiser can do with a contest. Commands and the office use the same functions."""
