"""Clients of a court: controllers, referees, spectators, gateways."""
