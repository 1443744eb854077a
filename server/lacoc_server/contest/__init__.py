"""Runs a whole contest: keeps entries and facts, has the matches played, and checks the results."""
