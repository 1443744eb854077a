"""A match cut into numbered pieces of one second, which any web cache can keep for a crowd."""
