"""A match as a pure function of its setup and its inputs."""
