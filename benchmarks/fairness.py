"""Is a match fair whose contestants have links of different speed?

    python -m benchmarks.fairness programs --seconds 90
    python -m benchmarks.fairness pages --seconds 70

Two contestants press the same key in response to the same frame: two controllers at a real court,
or two pages (without a browser) at one gateway. One of them is behind a proxy that adds delay and
jitter both ways. The benchmark reads in the record in how many pairs both keys took effect in the
same beat, and whether each late key is recorded as late. Pages also compare what the court
measured, which pages and referee read, with their own pings through the same proxies: the medians
must agree within 10 %; the court counts in whole beats, so its figure may be a beat more.
"""

import statistics
import tempfile
from pathlib import Path
from typing import Any, NamedTuple

from arguments import arguments
from mirrored_pair import SEATS, Played, Trip, play, play_on_pages

from benchmarks.figures import finish
from lacoc_shared.seat import BEAT_S

LEAST_SAME = 0.95
"""Share of pairs that must take effect in the same beat with equal links."""


class _Case(NamedTuple):
    input_delay: str
    delay_s: float
    """Delay of the slow link in each direction."""
    jitter_s: float
    """Jitter of the slow link in each direction."""
    most_ms: int = 400


PROGRAMS = (
    _Case("none", 0.1, 0.025),
    _Case("equal", 0.1, 0.0),
    _Case("equal", 0.1, 0.025),
    _Case("equal", 0.1, 0.05),
    _Case("equal", 0.2, 0.05, 700),
)
PAGES = tuple(
    (arena, input_delay)
    for arena in ("othello", "flag-strike")
    for input_delay in ("equal", "none")
)
PAGE_LINKS_S = ((0.01, 0.0), (0.1, 0.025))


def told(input_delay: str, played: Played) -> dict[str, Any]:
    """Return the figures of a case, and under "fair" whether it is as it must be."""
    pairs, health = played.pairs, played.health
    apart = [slow - fast for fast, slow in (one.beats for one in pairs)]
    same = apart.count(0) / len(apart)
    found: dict[str, Any] = {
        "input_delay": input_delay,
        "pairs": len(pairs),
        "frames_lost": played.lost,
        "same_beat": same,
        "apart_ms": 1000 * BEAT_S * statistics.median(apart),
        "apart_most_beats": max(map(abs, apart)),
        "late": [sum(one.late[seat] > 0 for one in pairs) for seat in range(len(SEATS))],
        "all_late_logged": all(any(one.late) or one.beats[0] == one.beats[1] for one in pairs),
        "round_trips_ms": [
            (seat.round_trip_p50_ms, seat.round_trip_p95_ms) for seat in health.seats
        ],
        "common_delay_ms": health.input_delay_ms,
    }
    found["fair"] = same >= LEAST_SAME if input_delay == "equal" else found["apart_ms"] > 0
    if played.pings:
        found["pings_ms"], found["shown_ms"] = played.pings, played.shown
        found["fair"] &= all(map(Trip.fits, played.pings, played.shown))
    return found


def main() -> None:
    """Play all cases; the exit code is 1 if one is not as fair as it must be."""
    options = arguments(__doc__, ("programs", "pages"), seconds=(90.0, "of play, each case"))
    seconds = options.seconds
    found = []
    with tempfile.TemporaryDirectory() as name:
        folders = (Path(name) / str(number) for number in range(100))
        if options.what == "programs":
            for case in PROGRAMS:
                (folder := next(folders)).mkdir()
                played = play(folder, *case[:3], most_ms=case.most_ms, seconds=seconds)
                link = f"{case.delay_s * 1000:.0f} ± {case.jitter_s * 1000:.0f} ms each way"
                found.append({"slow_link": link, **told(case.input_delay, played)})
        else:
            for arena, input_delay in PAGES:
                (folder := next(folders)).mkdir()
                played = play_on_pages(folder, arena, input_delay, PAGE_LINKS_S, seconds=seconds)
                found.append({"arena": arena, **told(input_delay, played)})
    finish({"cases": found}, all(one["fair"] for one in found))


if __name__ == "__main__":
    main()
