"""The Zenoh session, its configuration, addresses and certificates."""
