"""A whole contest: entries, facts, matches at courts or without a network, and proof of it all."""
