"""A whole contest: entries, facts, matches at courts or without a network, and its checks."""
