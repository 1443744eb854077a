"""A contest at its courts: the office, and the processes of courts, pages and bots."""
