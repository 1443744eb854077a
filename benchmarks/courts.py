"""`python -m benchmarks.courts`: many courts on one machine, and how many beats are late.

Each court is `lacoc serve` in PLAYING. One process holds the seats of all courts and presses keys.
At the same time a bare sleeper, which wakes 50 times a second and does nothing else, shows how late
this machine is by itself. A slow beat starts more than 20 ms late; each court counts its own.
"""

import argparse
import json
import os
import sys
import tempfile
import time
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from processes import ask, court, read_line, started, used_s

from lacoc_server.court.pace import Pace
from lacoc_shared.seat import Phase

AIM = 0.001
_SETTLE_S = 5.0


def courts(number: int, seconds: float, arena: str) -> dict[str, Any]:
    """Measure how many beats of many courts are slow.

    Args:
        number: number of courts.
        seconds: length of the measurement.
        arena: the game that all courts play.

    Returns:
        The numbers of beats and of slow beats, for the courts and for a sleeper (a process that
        only sleeps from beat to beat); and the courts' processor time for a beat and as a share of
        all cores.
    """
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        opened = [
            stack.enter_context(court(arena, folder / str(index), "--seconds", "86400"))
            for index in range(number)
        ]
        players = stack.enter_context(started("benchmarks.players"))
        tell = [
            {
                "name": one.name,
                "address": one.address,
                "tokens": dict(one.tokens),
                "referee": one.referee,
            }
            for one in opened
        ]
        ask(players, json.dumps(tell))
        time.sleep(_SETTLE_S)
        sleeper = stack.enter_context(started("benchmarks.courts", "--sleep"))
        read_line(sleeper)
        before, slept = ask(players, "count"), ask(sleeper, "count")
        cpu_s, at_s = [used_s(one.process) for one in opened], time.monotonic()
        time.sleep(seconds)
        after, slept_after = ask(players, "count"), ask(sleeper, "count")
        passed_s = time.monotonic() - at_s
        used = [used_s(one.process) - was for one, was in zip(opened, cpu_s, strict=True)]
    assert all(one["phase"] == Phase.PLAYING for one in after), after
    pairs = list(zip(before, after, strict=True))
    beats = sum(b["beat"] - a["beat"] for a, b in pairs)
    slow = sum(b["slow_beats"] - a["slow_beats"] for a, b in pairs)
    bare_beats = slept_after["beats"] - slept["beats"]
    bare_slow = slept_after["slow_beats"] - slept["slow_beats"]
    return {
        "courts": number,
        "cores": len(os.sched_getaffinity(0)),
        "load": os.getloadavg()[0],
        "seconds": passed_s,
        "beats": beats,
        "slow_beats": slow,
        "bare_beats": bare_beats,
        "bare_slow_beats": bare_slow,
        "share": slow / beats - bare_slow / bare_beats,
        "worst_court": max(b["slow_beats"] - a["slow_beats"] for a, b in pairs),
        "real_time": beats / (number * 50 * passed_s),
        "cpu_ms_a_beat": 1000 * sum(used) / beats,
        "cpu_share": sum(used) / passed_s / len(os.sched_getaffinity(0)),
        "keys": sum(b["pressed"] - a["pressed"] for a, b in pairs),
    }


def _sleep() -> None:
    """Sleep from beat to beat as a court does; answer each input line with beats and slow beats."""
    pace, beats = Pace(time.monotonic()), 0
    os.set_blocking(sys.stdin.fileno(), False)
    print("{}", flush=True)
    while True:
        time.sleep(pace.wait_s(time.monotonic()))
        pace.begin(time.monotonic())
        beats += 1
        if sys.stdin.readline():
            print(json.dumps({"beats": beats, "slow_beats": pace.slow_beats}), flush=True)


def main() -> None:
    """Run the benchmark and print its results."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.courts", description=__doc__)
    parser.add_argument("--courts", type=int, default=20)
    parser.add_argument("--seconds", type=float, default=120.0)
    parser.add_argument("--arena", default="othello")
    parser.add_argument("--sleep", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.sleep:
        _sleep()
    found = courts(options.courts, options.seconds, options.arena)
    print(json.dumps(found, indent=1))
    sys.exit(found["share"] >= AIM)


if __name__ == "__main__":
    main()
