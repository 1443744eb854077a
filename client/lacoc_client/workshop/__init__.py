"""Pages for learning: designing a gait alone (/design), in a class, and the six phases of both."""
