"""Serves pages to browsers: matches, recordings, a contest and its office (docs/gateway.md)."""
