"""Forges records, and counts how many are proven as if they were honest.

    python -m tests.campaigns.forge.proof --forgeries 1000

They are verified here, and with another arithmetic.
"""

import hashlib
import pickle
import random
import sys
import tempfile
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from arguments import arguments
from bot_matches import play
from other_arithmetic import elsewhere
from tests.campaigns.forge.record import Forger

from lacoc_server.journal.judge import Judge
from lacoc_server.journal.section import SectionFinding, Worlds, simulate_section
from lacoc_server.journal.verdict import Verdict, conclude
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.reader import Record
from lacoc_shared.words import render

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


def forged(paths: Sequence[str], count: int, seed: int) -> dict[str, Any]:
    """Forge as `forge` does; take and return what JSON can tell."""
    return forge([*map(Path, paths)], count, seed).__dict__


def main() -> None:
    """Verify forgeries here and with another arithmetic; exit with 1 if any passed."""
    options = arguments(__doc__, forgeries=1000, seed=1)
    with tempfile.TemporaryDirectory() as name, ThreadPoolExecutor(1) as aside:
        # Two pairs of matches; a pair has the same robots, so that sections can be swapped.
        paths = [play(Path(name), number, _FORGED_S) for number in (0, 30, 1, 31)]
        work = ([*map(str, paths)], options.forgeries, options.seed)
        theirs = aside.submit(elsewhere, forged, *work)
        found = [forge(paths, *work[1:]), Forged(**theirs.result())]
    for kind, one in zip(("here", "with another arithmetic"), found, strict=True):
        print(f"{kind}: {len(one.passed)} of {one.tried} forgeries pass")
        for passed in one.passed:
            print(f"  {passed}")
    print("kinds: " + ", ".join(f"{name} {count}" for name, count in found[0].kinds.items()))
    sys.exit(any(one.passed for one in found))


if __name__ == "__main__":
    main()
