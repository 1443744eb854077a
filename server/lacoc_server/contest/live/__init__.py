"""A contest at its courts: the office, and the processes that it keeps running."""
