"""The link that everybody has: what it says, and what its pages tell commands of the event."""
