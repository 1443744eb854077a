"""`python -m benchmarks.watched`: does a crowd make a court's beats longer?

A real court plays a match with two controllers; `--courts 4` are four of them, each with its match.
The crowd is any number of pages through one gateway and of direct spectators of the first court,
for instance `--pages 300` or `--direct 100`. Pages watch the courts in turns. Rounds without and
with the crowd take turns. The time of a beat is its whole work on the wall clock. The crowd runs in
its own processes on the last core, where it disturbs the courts least (Linux only).
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

from processes import LACOC, ask, read_line, started

from lacoc_shared.seat import BEATS_PER_S

AIM = 1.2
HUNDREDS = 300
"""With more direct spectators than this, the ratio has no aim: only no beat may be missed."""
_SETTLE_S = 2.0


def watched(direct: int, pages: int, courts: int, seconds: float, rounds: int) -> dict[str, Any]:
    """Measure courts' beats in turns: rounds without spectators, and rounds with a crowd of them.

    Args:
        direct: number of spectators with a session of their own with the first court.
        pages: number of spectators through a gateway.
        courts: number of courts.
        seconds: length of a round.
        rounds: number of rounds of each kind.

    Returns:
        The times of beats of all courts without and with the crowd (medians of the rounds'
        percentiles), their ratios, the numbers of slow and missed beats, and the frame rate of the
        slowest spectator.
    """
    alone, with_crowd = [], []
    slowest_hz: list[float] = []
    with ExitStack() as stack:
        names = [f"court-{number}" for number in range(1, courts + 1)]
        processes = [
            stack.enter_context(started("tests.processes.measured_court", name)) for name in names
        ]
        opened = [read_line(process) for process in processes]
        players = stack.enter_context(started("benchmarks.players"))
        ask(players, json.dumps(opened))
        file = Path(stack.enter_context(tempfile.TemporaryDirectory()), "contest.toml")
        file.write_text("".join(map(_entry, opened)))
        words = ("--contest", str(file), "--viewers", str(pages + 1))
        gateway = stack.enter_context(started(LACOC, "web", "--json", *words))
        url = read_line(gateway)["url"]
        for _ in range(rounds):
            alone.append(_round(processes, seconds))
            with _crowd(opened[0], direct) as sessions, _pages(url, pages, names) as windows:
                for one in (*sessions, *windows):
                    ask(one, "count")
                with_crowd.append(_round(processes, seconds))
                for one in (*sessions, *windows):
                    counted = ask(one, "count")
                    frames = min(frames for frames, _ in counted["counts"])
                    slowest_hz.append(frames / counted["seconds"])
        for process in processes:
            process.communicate("stop\n", timeout=60)
    ratios = [
        after["p99_ms"] / before["p99_ms"] for before, after in zip(alone, with_crowd, strict=True)
    ]
    return {
        "direct": direct,
        "pages": pages,
        "courts": courts,
        "p99_alone_ms": statistics.median(one["p99_ms"] for one in alone),
        "p99_watched_ms": statistics.median(one["p99_ms"] for one in with_crowd),
        "p50_alone_ms": statistics.median(one["p50_ms"] for one in alone),
        "p50_watched_ms": statistics.median(one["p50_ms"] for one in with_crowd),
        "ratios": [round(ratio, 3) for ratio in ratios],
        "ratio": statistics.median(ratios),
        "beats": sum(one["beats"] for one in with_crowd),
        "missed": sum(one["missed"] for one in with_crowd),
        "slow": sum(one["slow"] for one in with_crowd),
        "slow_alone": sum(one["slow"] for one in alone),
        "slowest_hz": min(slowest_hz),
    }


def _entry(opened: dict[str, Any]) -> str:
    """Return a court's part of the contest file."""
    return f'[court.{opened["name"]}]\narena = "othello"\nlisten = ["{opened["address"]}"]\n'


def _round(courts: Sequence[subprocess.Popen[str]], seconds: float) -> dict[str, float]:
    time.sleep(_SETTLE_S)
    begins_s = [ask(court, "count")["at_s"] for court in courts]
    time.sleep(seconds)
    told = [ask(court, "count") for court in courts]
    wall_ms = sorted(1000 * took_s for one in told for took_s in one["wall_s"])
    missed = 0
    for begin_s, one in zip(begins_s, told, strict=True):
        due = int((one["at_s"] - begin_s) * BEATS_PER_S)
        missed += max(0, due - len(one["wall_s"]) - 1)  # one beat may be due just now
    return {
        "beats": len(wall_ms),
        "missed": missed,  # the courts did not catch up with these
        "slow": sum(one["slow_beats"] for one in told),
        "p50_ms": statistics.median(wall_ms),
        "p99_ms": statistics.quantiles(wall_ms, n=100)[-1],
    }


@contextmanager
def _crowd(opened: dict[str, Any], number: int) -> Iterator[list[subprocess.Popen[str]]]:
    where = (opened["address"], opened["name"], str(number))
    with _on_last_core("benchmarks.direct", *where, wanted=number) as crowd:
        yield crowd


@contextmanager
def _pages(url: str, number: int, courts: Sequence[str]) -> Iterator[list[subprocess.Popen[str]]]:
    words = (url, str(number), "25", *courts)
    with _on_last_core("tests.processes.crowd", *words, wanted=number) as crowd:
        yield crowd


@contextmanager
def _on_last_core(module: str, *words: str, wanted: int) -> Iterator[list[subprocess.Popen[str]]]:
    """Give a crowd's process once all its spectators are connected; give [] if `wanted` is 0."""
    if not wanted:
        yield []
        return
    with started(module, *words) as process:
        os.sched_setaffinity(process.pid, sorted(os.sched_getaffinity(0))[-1:])
        read_line(process)
        yield [process]


def main() -> None:
    """Run the benchmark and print its results."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.watched", description=__doc__)
    parser.add_argument("--direct", type=int, default=0, help="spectators of the court itself")
    parser.add_argument("--pages", type=int, default=0, help="spectators through a gateway")
    parser.add_argument("--courts", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=10.0, help="of each round")
    parser.add_argument("--rounds", type=int, default=7)
    options = parser.parse_args()
    found = watched(**vars(options))
    print(json.dumps(found, indent=1))
    held = found["ratio"] <= AIM or options.direct > HUNDREDS
    sys.exit(bool(found["missed"]) or not held)


if __name__ == "__main__":
    main()
