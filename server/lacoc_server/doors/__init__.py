"""What comes into a court from the network and what goes out."""
