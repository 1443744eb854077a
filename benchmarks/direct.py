"""Runs hundreds of direct spectators in one process at little cost; ten count their frames.

    python -m benchmarks.direct ADDRESS COURT SPECTATORS

Each spectator has a session of its own with all the subscriptions of a spectator. Each line on
standard input ends a count and prints it as JSON, as `crowd` does.
"""

import argparse
import json
import sys
import time
from contextlib import ExitStack

from lacoc_shared.keyspace import Keys
from lacoc_shared.network.session import Mailbox, open_client

PROBES = 10
_PROBE_DEPTH = 4096
_OPEN_S = 60.0


def main() -> None:
    """Open the sessions. At each line of the input, print the frames since the last line."""
    parser = argparse.ArgumentParser()
    parser.add_argument("address")
    parser.add_argument("court")
    parser.add_argument("spectators", type=int)
    options = parser.parse_args()
    keys = Keys(options.court)
    with ExitStack() as stack:
        probes: list[Mailbox] = []
        kept = []
        for number in range(options.spectators):
            session = stack.enter_context(open_client([options.address], _OPEN_S))
            # A ring is filled without Python; callbacks for all spectators would take a whole core.
            if number < PROBES:
                probes.append(session.mailbox(keys.frame, _PROBE_DEPTH))
            else:
                kept.append(session.ring(keys.frame, 1))
            kept.append(session.ring(keys.health, 1))
            kept += [session.ring(keys.sheet, 1), session.ring(keys.event, 64)]
        print(json.dumps({"open": options.spectators}), flush=True)
        began_s = time.monotonic()
        while sys.stdin.readline():
            counts = [_emptied(probe) for probe in probes]
            now_s = time.monotonic()
            print(json.dumps({"seconds": now_s - began_s, "counts": counts}), flush=True)
            began_s = now_s


def _emptied(probe: Mailbox) -> tuple[int, int]:
    """Empty a mailbox; return its number of frames and of bytes."""
    frames = size = 0
    while (mail := probe.take()) is not None:
        frames, size = frames + 1, size + len(mail.payload)
    return frames, size


if __name__ == "__main__":
    main()
