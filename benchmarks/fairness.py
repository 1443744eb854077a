"""`python -m benchmarks.fairness`: do both keys take effect in the same beat?

Two controllers at a real court press the same key in response to the same frame. One of them is
behind a proxy that adds delay and jitter both ways. The benchmark reads in the record in how many
pairs both keys took effect in the same beat, and whether each late key is recorded as late.
"""

import argparse
import statistics
import tempfile
from pathlib import Path
from typing import NamedTuple

from mirrored_pair import SEATS, Played, play
from rich.console import Console
from rich.table import Table


class _Case(NamedTuple):
    input_delay: str
    delay_s: float
    """Delay of the slow link in each direction."""
    jitter_s: float
    """Jitter of the slow link in each direction."""
    most_ms: int = 400

    @property
    def link(self) -> str:
        return f"{self.delay_s * 1000:.0f} ± {self.jitter_s * 1000:.0f} ms each way"


CASES = (
    _Case("none", 0.1, 0.025),
    _Case("equal", 0.1, 0.0),
    _Case("equal", 0.1, 0.025),
    _Case("equal", 0.1, 0.05),
    _Case("equal", 0.2, 0.05, 700),
)


def main() -> None:
    """Play all cases and print a table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.fairness", description=__doc__)
    parser.add_argument("--seconds", type=float, default=90.0, help="of play, each case")
    options = parser.parse_args()
    table = Table(
        "slow link", "input_delay", "pairs", "same beat", "apart, median and most",
        "late (fast, slow), all logged", "p50, p95 fast", "p50, p95 slow", "common delay",
    )  # fmt: skip
    for case in CASES:
        with tempfile.TemporaryDirectory() as folder:
            played = play(Path(folder), *case[:3], most_ms=case.most_ms, seconds=options.seconds)
        row = _row(case, played)
        print(" | ".join(row), flush=True)
        table.add_row(*row)
    Console(width=200).print(table)


def _row(case: _Case, played: Played) -> tuple[str, ...]:
    pairs, health = played.pairs, played.health
    apart = [abs(one.beats[1] - one.beats[0]) for one in pairs]
    same = apart.count(0)
    late = [sum(one.late[seat] > 0 for one in pairs) for seat in range(len(SEATS))]
    logged = all(any(one.late) or one.beats[0] == one.beats[1] for one in pairs)
    trips = [
        f"{seat.round_trip_p50_ms or 0:.0f}, {seat.round_trip_p95_ms or 0:.0f} ms"
        for seat in health.seats
    ]
    return (
        case.link,
        case.input_delay,
        f"{len(pairs)} and {played.lost} frames lost",
        f"{100 * same / len(pairs):.1f} %",
        f"{statistics.median(apart):.0f}, {max(apart)} beats",
        f"{late[0]}, {late[1]}; {'yes' if logged else 'no'}" if health.input_delay_ms else "-",
        *trips,
        f"{health.input_delay_ms} ms",
    )


if __name__ == "__main__":
    main()
