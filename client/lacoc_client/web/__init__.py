"""Serves browsers: matches, recordings, a contest's pages and its office (docs/gateway.md)."""
