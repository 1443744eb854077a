"""A match as numbered pieces of a second, which any web cache can keep for a crowd."""
