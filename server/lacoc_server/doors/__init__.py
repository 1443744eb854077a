"""The doors of a court: what comes in from the network, and what goes out."""
