"""Finds ports for servers that are started again at the same address."""

import random
import socket

# Systems take ports of outgoing connections from above this range (on Linux from 32768, elsewhere
# from 49152). So a chosen port stays free until the test's server listens there.
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
