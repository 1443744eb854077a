"""The link that opens an event: what it contains, and what a command learns from its pages."""
