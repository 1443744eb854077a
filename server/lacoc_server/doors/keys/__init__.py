"""Certificates and invitations of a contest with keys."""
