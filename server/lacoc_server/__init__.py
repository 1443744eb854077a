"""The court: the process that alone decides what happens in a match."""
