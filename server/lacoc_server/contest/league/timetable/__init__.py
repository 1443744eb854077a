"""What is played next, where and when; pure."""
