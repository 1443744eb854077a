"""A whole contest: entries, facts, matches on courts or without a network, and proof of it all."""
