"""The pages on which people learn: a gait studio of one's own, a class, and the phases of both."""
