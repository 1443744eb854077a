"""The link of an event: what it contains, and what its pages tell commands about the event."""
