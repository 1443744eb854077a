"""The record of a match: journal while it runs, replay when it is over (docs/architecture.md)."""
