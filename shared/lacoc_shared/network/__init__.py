"""Connections over Zenoh: sessions, their configuration, addresses and certificates."""
