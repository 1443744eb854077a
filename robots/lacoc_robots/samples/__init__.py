"""Sample robots, each with a gait that walks."""
