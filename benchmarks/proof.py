"""Tries the proof of records on honest matches and on forgeries, and times it.

python -m benchmarks.proof honest --matches 40 --seconds 180
python -m benchmarks.proof forged --forgeries 1000
python -m benchmarks.proof time --seconds 180
"""

import argparse
import hashlib
import json
import pickle
import random
import statistics
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from benchmarks.forger import Forger
from benchmarks.played import elsewhere, play
from lacoc_server.journal.judge import Judge
from lacoc_server.journal.replay import verify
from lacoc_server.journal.section import SectionFinding, Worlds, simulate_section
from lacoc_server.journal.verdict import Verdict, VerdictKind, conclude
from lacoc_server.match.match import Match
from lacoc_server.world import arithmetic
from lacoc_server.world.world import World
from lacoc_shared.codec import encode
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.reader import Record
from lacoc_shared.words import render

_WHAT = ("honest", "forged", "time", "fingerprint", "verdicts", "forge")
"""What one run does; a run under the other arithmetic does one of the last three."""
_CORES = 2
_FORGED_S = 12.0
"""Length of the matches that are forged [s]: three sections."""


class Prover:
    """Verifies many copies of a record; equal sections of the copies are simulated only once."""

    def __init__(self) -> None:
        self._worlds = Worlds()
        self._findings: dict[bytes, SectionFinding] = {}

    def verdict(self, record: Record) -> Verdict | str:
        """Verify a record; return the verdict, or why the record can't be verified."""
        try:
            judge = Judge(record, None, dict(record.snapshots))
            findings = [self._simulate(section) for section in judge.sections()]
        except UserError as error:
            return str(error)
        judged, other = [judge.difference], judge.other_model
        return conclude(record.headers, judge.beats, judge.frames, judged, findings, other)

    def _simulate(self, section: Any) -> SectionFinding:
        # The number of a build means something only within its own record.
        build, section.build = section.build, None
        content = pickle.dumps((build.setup, build.entries, section))
        section.build = build
        name = hashlib.blake2b(content, digest_size=16).digest()
        if name not in self._findings:
            worlds = Worlds() if build.number or section.start is None else self._worlds
            self._findings[name] = simulate_section(section, worlds)
        return self._findings[name]


@dataclass(frozen=True)
class Forged:
    """The results of verifying forgeries."""

    tried: int
    passed: list[str]
    """The names of the forgeries that verified as if they were honest."""
    kinds: dict[str, int]


def forge(paths: Sequence[Path], count: int, seed: int) -> Forged:
    """Forge copies of records, and verify each copy.

    Args:
        paths: honest records in pairs; the second of a pair gives sections for the first.
        count: number of forgeries.
        seed: seed of the random choice of forgeries.
    """
    chance = random.Random(seed)
    records = [Record.read(path) for path in paths]
    pairs = list(zip(records[::2], records[1::2], strict=True))
    kinds: Counter[str] = Counter()
    passed = []
    for index, (honest, other) in enumerate(pairs):
        prover, forger = Prover(), Forger(honest, other)
        if not (isinstance(found := prover.verdict(honest), Verdict) and found.same):
            raise AssertionError(f"the honest record is not proven: {found}")
        for _ in range(count * (index + 1) // len(pairs) - count * index // len(pairs)):
            name, record = forger.forge(chance)
            kinds[name.partition(",")[0]] += 1
            found = prover.verdict(record)
            if isinstance(found, Verdict) and found.same:
                passed.append(f"{name}: {render(found.said)}")
    return Forged(count, passed, dict(kinds))


def main() -> None:
    """Do what the command line says; exit with 1 if a verdict is wrong."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.proof", description=__doc__)
    parser.add_argument("what", choices=_WHAT)
    parser.add_argument("records", nargs="*", type=Path)
    parser.add_argument("--matches", type=int, default=40)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--forgeries", type=int, default=1000)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    right = True
    match options.what:
        case "honest":
            right = _honest(options.matches, options.seconds)
        case "forged":
            right = _forged(options.forgeries, options.seed)
        case "time":
            _time(options.seconds, options.rounds)
        case "fingerprint":
            print(json.dumps(dict(arithmetic.here())))
        case "verdicts":
            for path in options.records:
                print(json.dumps(_verdict(path)), flush=True)
        case "forge":
            found = forge(options.records, options.forgeries, options.seed)
            print(json.dumps(found.__dict__))
    sys.exit(not right)


def _honest(matches: int, seconds: float) -> bool:
    """Verify matches here and under another arithmetic; return whether every verdict is right."""
    with (
        tempfile.TemporaryDirectory() as name,
        ProcessPoolExecutor(_CORES, get_context("spawn")) as pool,
    ):
        paths = list(pool.map(partial(play, Path(name), seconds=seconds), range(matches)))
        here = list(pool.map(_verdict, paths))
        parts = [list(map(str, paths[core::_CORES])) for core in range(_CORES)]
        run = partial(elsewhere, "benchmarks.proof")
        found = pool.map(run, [["verdicts", *part] for part in parts if part])
        there = [json.loads(line) for lines in found for line in lines.splitlines()]
        left = [path.name for path in paths]
    for kind, verdicts in (("here", here), ("under the other arithmetic", there)):
        counts = Counter(verdict["kind"] for verdict in verdicts)
        worst = max(verdicts, key=lambda verdict: float(verdict["distance"]))
        print(f"{kind}: {dict(counts)}; worst {worst['distance']:.1e} in {worst['name']}")
        for verdict in verdicts:
            if verdict["kind"] == VerdictKind.DIFFERS:
                print(f"  {verdict['name']}: {verdict['text']}")
    print("distances: " + ", ".join(f"{verdict['distance']:.0e}" for verdict in there))
    return (
        len(left) == len(here) == len(there)
        and all(verdict["kind"] == VerdictKind.SAME for verdict in here)
        and all(verdict["kind"] == VerdictKind.OTHER_ARITHMETIC for verdict in there)
    )


def _verdict(path: Path) -> dict[str, Any]:
    *_, verdict = verify(Record.read(path), processes=1)
    assert isinstance(verdict, Verdict)
    return {
        "name": path.name,
        "kind": verdict.kind.value,
        "distance": verdict.distance,
        "text": render(verdict.said),
    }


def _forged(count: int, seed: int) -> bool:
    """Verify forgeries here and under another arithmetic; return whether none of them passed."""
    with tempfile.TemporaryDirectory() as name:
        # Two pairs of matches; a pair has the same robots, so that sections can be swapped.
        paths = [play(Path(name), number, _FORGED_S) for number in (0, 30, 1, 31)]
        words = ["forge", *map(str, paths), "--forgeries", str(count), "--seed", str(seed)]
        with ProcessPoolExecutor(1, get_context("spawn")) as pool:
            theirs = pool.submit(elsewhere, "benchmarks.proof", words)
            found = [forge(paths, count, seed), Forged(**json.loads(theirs.result()))]
    for kind, forged in zip(("here", "under the other arithmetic"), found, strict=True):
        print(f"{kind}: {len(forged.passed)} of {forged.tried} forgeries pass")
        for passed in forged.passed:
            print(f"  {passed}")
    print("kinds: " + ", ".join(f"{name} {count}" for name, count in found[0].kinds.items()))
    return not any(forged.passed for forged in found)


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
        *_, verdict = verify(record)
        sections_s.append(time.perf_counter() - begin_s)
        assert isinstance(verdict, Verdict)
        assert verdict.kind is VerdictKind.SAME
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
