"""The six phases on the page: `diary` keeps what a student does, `learner` sees it happen."""
