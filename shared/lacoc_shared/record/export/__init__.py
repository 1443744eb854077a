"""What a record gives to other programs."""
