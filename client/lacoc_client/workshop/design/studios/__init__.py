"""Connections to studios, which let robots walk: `asker` to one studio, `studios` to several."""
