"""Ports for servers that must come back at the same place."""

import random
import socket

# Below those that systems give to connections (49152 and up, on Linux 32768 and up): a test's
# port is free from when it is asked for until its server listens.
_CHOICE = range(20_000, 32_000)


def free_port() -> int:
    """Return a TCP port of 127.0.0.1 at which nobody listens."""
    while True:
        port = random.choice(_CHOICE)
        with socket.socket() as probe:
            try:
                probe.bind(("127.0.0.1", port))
            except OSError:
                continue
            return port
