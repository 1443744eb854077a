"""Connections to studios, which let robots walk: `asker` to one, `studios` to several."""
