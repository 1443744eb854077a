"""Finds ports for servers that are started again at the same address."""

import os
import random
import socket

# Systems take ports of outgoing connections from above this range (on Linux from 32768, elsewhere
# from 49152). So a chosen port stays free until the test's server listens there.
_CHOICE = range(20_000, 32_000)


def free_port() -> int:
    """Return a TCP port of 127.0.0.1 at which nobody listens.

    Nobody gets the same one soon after, and tests that run in parallel choose from different ports:
    the server may begin to listen only seconds later.
    """
    while True:
        if not _left:
            _left.extend(_own())
        port = _left.pop()
        with socket.socket() as probe:
            try:
                probe.bind(("127.0.0.1", port))
            except OSError:
                continue
            return port


def _own() -> list[int]:
    """Return this process's share of the ports, in random order."""
    worker = int(os.environ.get("PYTEST_XDIST_WORKER", "gw0").removeprefix("gw"))
    workers = int(os.environ.get("PYTEST_XDIST_WORKER_COUNT", "1"))
    share = _CHOICE[worker::workers]
    return random.sample(share, len(share))


_left = _own()
