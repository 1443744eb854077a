"""Pages for learning: to design a gait (/design), alone or in a class, in six phases."""
