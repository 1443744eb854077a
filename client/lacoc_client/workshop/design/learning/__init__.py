"""The six phases on the page: `learner` turns a student's acts into evidence, `diary` keeps it."""
