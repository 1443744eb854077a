"""`python -m benchmarks.fair_pages`: is a match fair whose contestants play on pages?

Two pages (without a browser) at one gateway press the same key in response to the same frame. One
is behind a proxy of 10 ms each way, the other behind 100 ± 25 ms. The benchmark reads in the record
when both keys took effect, and compares what the court measured, which pages and referee read, with
the pages' own pings through the same proxies. The medians must agree within 10 %; the court counts
in whole beats, so its figure may be a beat more.
"""

import argparse
import statistics
import sys
import tempfile
from pathlib import Path

from mirrored_pair import EVERY_BEATS, Played, Trip, play_on_pages

from lacoc_shared.seat import BEAT_S

LINKS_S = ((0.01, 0.0), (0.1, 0.025))
ARENAS = ("othello", "flag-strike")
LEAST_SAME = 0.95


def main() -> None:
    """Play all cases; the exit code is 1 if one is not as fair as it must be."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.fair_pages", description=__doc__)
    parser.add_argument("--pairs", type=int, default=200, help="keys of both, each case")
    options = parser.parse_args()
    seconds = (options.pairs + 5) * EVERY_BEATS * BEAT_S
    fair = True
    for arena in ARENAS:
        for input_delay in ("equal", "none"):
            with tempfile.TemporaryDirectory() as folder:
                played = play_on_pages(Path(folder), arena, input_delay, LINKS_S, seconds=seconds)
            fair &= _tell(arena, input_delay, played)
    sys.exit(not fair)


def _tell(arena: str, input_delay: str, played: Played) -> bool:
    """Print a case; return whether it is as it must be."""
    apart = [slow - fast for fast, slow in (pair.beats for pair in played.pairs)]
    same = apart.count(0) / len(apart)
    apart_ms = 1000 * BEAT_S * statistics.median(apart)
    true = all(map(Trip.fits, played.pings, played.shown))
    print(
        f"{arena}, {input_delay}: {len(apart)} pairs, {100 * same:.1f} % in the same beat, "
        f"median {apart_ms:.0f} ms apart; common delay {played.health.input_delay_ms} ms"
    )
    for name, ping, court in zip(("near", "far"), played.pings, played.shown, strict=True):
        print(
            f"  {name}: pings {ping.p50_ms:.0f} (95 %: {ping.p95_ms:.0f}) ms; "
            f"the court measured {court.p50_ms:.0f} (95 %: {court.p95_ms:.0f}) ms"
        )
    print(f"  what pages and referee read is {'true' if true else 'FALSE'}", flush=True)
    return true and (same >= LEAST_SAME if input_delay == "equal" else apart_ms > 0)


if __name__ == "__main__":
    main()
