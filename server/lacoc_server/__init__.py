"""The court, which alone decides what happens in a match; the office; the studio; simulation."""
