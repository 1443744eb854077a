"""Verifies honest records on this machine and with another arithmetic, and times this.

python -m benchmarks.proof honest --matches 40 --seconds 180
python -m benchmarks.proof time --seconds 180
"""

import statistics
import sys
import tempfile
import time
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context
from pathlib import Path

from arguments import arguments
from bot_matches import play
from other_arithmetic import elsewhere
from verdicts import told, verdict

from lacoc_server.journal.verdict import VerdictKind
from lacoc_server.match.match import Match
from lacoc_server.world.world import World
from lacoc_shared.codec import encode
from lacoc_shared.record.reader import Record

_CORES = 2


def main() -> None:
    """Do what the command line says; exit with 1 if a verdict is wrong."""
    options = arguments(__doc__, ("honest", "time"), matches=40, seconds=60.0, rounds=5)
    if options.what == "time":
        _time(options.seconds, options.rounds)
    else:
        sys.exit(not _honest(options.matches, options.seconds))


def _honest(matches: int, seconds: float) -> bool:
    """Verify matches here and with another arithmetic; return whether every verdict is right."""
    with (
        tempfile.TemporaryDirectory() as name,
        ProcessPoolExecutor(_CORES, get_context("spawn")) as pool,
    ):
        paths = list(pool.map(partial(play, Path(name), seconds=seconds), range(matches)))
        names = [*map(str, paths)]
        found = {
            VerdictKind.SAME: list(pool.map(told, names)),
            VerdictKind.OTHER_ARITHMETIC: list(pool.map(partial(elsewhere, told), names)),
        }
    right = True
    for wanted, verdicts in found.items():
        counts = Counter(one["kind"] for one in verdicts)
        worst = max(verdicts, key=lambda one: float(one["distance"]))
        print(f"{wanted}: {dict(counts)}; worst {worst['distance']:.1e} in {worst['name']}")
        for one in verdicts:
            if one["kind"] != wanted:
                right = False
                print(f"  {one['name']}: {one['text']}")
    return right


def _time(seconds: float, rounds: int) -> None:
    """Time in turns how long it takes to verify a match, and to simulate it whole on one core."""
    with tempfile.TemporaryDirectory() as name:
        record = Record.read(play(Path(name), 0, seconds))
    whole_s, sections_s = [], []
    for _ in range(rounds):
        begin_s = time.perf_counter()
        _simulate_whole(record)
        whole_s.append(time.perf_counter() - begin_s)
        begin_s = time.perf_counter()
        assert verdict(record).kind is VerdictKind.SAME
        sections_s.append(time.perf_counter() - begin_s)
    ratios = [one / other for one, other in zip(sections_s, whole_s, strict=True)]
    print(
        f"verify {statistics.median(sections_s):.2f} s, simulated whole on one core "
        f"{statistics.median(whole_s):.2f} s, ratio {statistics.median(ratios):.2f} "
        f"({min(ratios):.2f} to {max(ratios):.2f}); aim: at most 0.7 on two cores"
    )


def _simulate_whole(record: Record) -> None:
    """Simulate a record from its first to its last beat, and compare its frames."""
    match, frames = Match(record.header.setup, World), dict(record.frames)
    for number in range(record.last_beat + 1):
        frame = encode(match.beat(record.inputs.get(number, ())).frame)
        assert frames.get(number, frame) == frame


if __name__ == "__main__":
    main()
