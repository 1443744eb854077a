"""Everyone but the court."""
