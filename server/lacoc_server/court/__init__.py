"""The court: the process that holds one match at a time."""
