"""What `lacoc doctor` looks at."""
