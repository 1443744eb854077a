"""The teacher's page of a class: what it asks, and what it is told."""
