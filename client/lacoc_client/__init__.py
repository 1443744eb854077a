"""Clients of a court: controllers, referees, spectators and gateways."""
