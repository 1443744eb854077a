"""The six phases on the page: `learner` makes evidence of what a student does, `diary` keeps it."""
