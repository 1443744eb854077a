"""`python -m benchmarks.odds`: do the odds of forks come true, and do highlights miss a swing?

Calibration: plays many short matches. Games, openings, bots and delays are drawn by chance. At some
random moments of each match, forks with the same bots give the odds. Of all moments at which a seat
had a chance of 70 %, about 70 % must have been won in the match itself. A moment is counted for
each seat, because the chance of the other seat is the rest; a draw is half a win.

Highlights (`--highlights`): in the first matches, every second of play has a moment with many
forks. The first forks of each moment give the highlights. All other forks give the five largest
swings between two moments. The highlights must contain at least 80 % of these swings.

By score (`--by-score`): plays whole matches, and asks each second for the chance by score and clock
alone (client/web/src/core/chance.ts).

Rows are appended to a file, so a benchmark that was stopped goes on where it was.
"""

import json
import math
import random
import sys
import tempfile
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from functools import partial
from pathlib import Path
from statistics import NormalDist
from typing import Any

from arguments import arguments
from bot_matches import BOTS, bot_match
from msgspec.structs import replace

from lacoc_arenas.arena import load as load_arena
from lacoc_server.simulate.forks import odds
from lacoc_server.simulate.forks.chances import (
    ChanceJob,
    MatchCourse,
    Odds,
    Wish,
    compute_odds,
    margins,
)
from lacoc_server.simulate.forks.odds import MomentOdds, Swing
from lacoc_server.simulate.forks.origin import ForkSource, read_source
from lacoc_server.simulate.workers import Workers
from lacoc_shared.messages import Frame
from lacoc_shared.seat import BEATS_PER_S, Phase
from lacoc_shared.words import Phrase

_WEIGHTS = (1, 3, 3)
"""How often each bot plays; with `straight`, most matches are decided from the start."""
_SMALL = {"pitch_m": 0.15, "disc_radius_m": 0.0675}
"""An Othello field of half the size, on which much happens in a short time."""
_GAMES: tuple[tuple[str, dict[str, Any]], ...] = (
    ("othello", {"game": {**_SMALL, "opening": "reversi"}}),
    ("othello", {"game": {**_SMALL, "opening": "checkers"}}),
    ("flag-strike", {}),
)
_BIN = 0.05
_LARGEST = 5
_OTHERS = 5
"""How many forks of each moment give the largest swings; the others give the highlights."""
_FIRST_S = 10
"""Second of play from which pages show a chance by score and clock."""
_LEAST = 0.05
"""Smaller changes of a chance are no swing, as in `lacoc replay highlights`."""


def main() -> int:
    """Play the matches that are not in the file yet, and print how the odds came true."""
    options = arguments(
        __doc__,
        matches=200,
        moments=(2, "of each match"),
        forks=(5, "at each moment"),
        seconds=(15.0, "of play, each match"),
        highlights=(0, "matches whose swings are sought"),
        by_score=(0, "whole matches in which score and clock are asked"),
        jobs=int,
        rows=(Path("odds.jsonl"), "file of results"),
    )
    one: Callable[..., dict[str, Any]]
    if options.by_score:
        numbers, one = range(options.by_score), _by_score
    elif options.highlights:
        numbers, one = range(options.highlights), partial(_swings, options.forks, options.seconds)
    else:
        numbers = range(options.matches)
        one = partial(_odds, options.moments, options.forks, options.seconds)
    # One file may have rows of all kinds.
    own = "leads" if options.by_score else "largest" if options.highlights else "asked"
    rows = {row["number"]: row for row in _read(options.rows) if own in row}
    with Workers(options.jobs, background=True, limit_s=3600.0) as workers:
        futures = [workers.submit(one, number) for number in numbers if number not in rows]
        for future in futures:
            row = future.result()
            rows[row["number"]] = row
            with options.rows.open("a", encoding="utf-8") as file:
                file.write(f"{json.dumps(row)}\n")
    chosen = [rows[number] for number in numbers]
    if options.by_score:
        return _tell(chosen, [said for row in chosen for said in _said_by_score(row)])
    return _tell_swings(chosen) if options.highlights else _tell_odds(chosen)


def _read(path: Path) -> Iterator[dict[str, Any]]:
    if path.exists():
        yield from map(json.loads, path.read_text(encoding="utf-8").splitlines())


def _odds(moments: int, forks: int, seconds: float, number: int) -> dict[str, Any]:
    """Play a match, and ask for its odds at some moments."""
    with tempfile.TemporaryDirectory() as folder:
        source, bots, chance = _match(Path(folder), number, seconds)
        course = MatchCourse(source)
        assert course.end is not None
        asked = []
        for beat in sorted(chance.sample(course.playing, moments)):
            variants = tuple(range(1, forks + 1))
            file = str(Path(folder, f"{source.match_id}.mcap"))
            found = margins(ChanceJob(file=file, beat=beat, bots=bots, variants=variants))
            assert not isinstance(found, Phrase), found
            asked.append({"clock_s": course.clock_s(beat), "margins": found})
        return {"number": number, "won": course.end.chance, "bots": bots, "asked": asked}


def _swings(forks: int, seconds: float, number: int) -> dict[str, Any]:
    """Play a match; return its largest swings by some forks, and the highlights by others."""
    with tempfile.TemporaryDirectory() as folder:
        source, bots, _ = _match(Path(folder), number, seconds)
        file = str(Path(folder, f"{source.match_id}.mcap"))
        wish = Wish(file=file, bots=bots, forks=forks + _OTHERS, step_s=1.0)
        *_, curve = compute_odds(wish, _Here(), None, lambda done, of: None)
        chosen = odds.highlights(_from_forks(curve, slice(forks)), least=_LEAST)
        largest = odds.steps(_from_forks(curve, slice(forks, None)))
        largest.sort(key=lambda step: -abs(step.change))
        return {
            "number": number,
            "largest": [_stretch(one) for one in largest[:_LARGEST]],
            "highlights": [_stretch(one) for one in chosen],
            "moments": len(curve.moments),
            "playing": len(MatchCourse(source).playing),
        }


def _by_score(number: int) -> dict[str, Any]:
    """Play a whole match; return its lead at each second of play, and who won."""
    chance = random.Random(number)
    name = chance.choice(("othello", "flag-strike"))
    bots, late = chance.choices(BOTS, _WEIGHTS, k=2), [chance.randrange(25), chance.randrange(25)]
    leads: dict[int, int] = {}

    def watch(frame: Frame) -> None:
        if frame.phase == Phase.PLAYING and not frame.clock_ticks % BEATS_PER_S:
            leads[frame.clock_ticks // BEATS_PER_S] = frame.seats[0].score - frame.seats[1].score

    with tempfile.TemporaryDirectory() as folder:
        source = read_source(bot_match(Path(folder), name, bots, late_ticks=late, watch=watch))
        course = MatchCourse(source)
    assert course.end is not None
    return {"number": number, "arena": name, "won": course.end.chance, "leads": [*leads.items()]}


def _said_by_score(row: dict[str, Any]) -> Iterator[tuple[float, float]]:
    """Yield chances by score and clock, as pages compute them, and who won."""
    rules = load_arena(row["arena"]).match
    for second, lead in row["leads"]:
        if _FIRST_S <= second < rules.duration_s:
            spread = rules.lead_volatility * math.sqrt(rules.duration_s - second)
            chance = NormalDist().cdf(lead / spread)
            yield from ((chance, row["won"]), (1 - chance, 1 - row["won"]))


def _from_forks(curve: Odds, which: slice) -> tuple[MomentOdds, ...]:
    """Return the moments of a curve with the odds that follow from some of its forks."""
    return odds.pooled(
        replace(one, margins=one.margins[which]) if one.key else one for one in curve.moments
    )


def _stretch(swing: Swing) -> tuple[int, int, float]:
    return swing.before.beat, swing.after.beat, swing.change


class _Here:
    """Plays forks in this process."""

    def submit(
        self, function: Callable[[ChanceJob], tuple[float, ...] | Phrase], job: ChanceJob, /
    ) -> "Future[tuple[float, ...] | Phrase]":
        done: Future[tuple[float, ...] | Phrase] = Future()
        done.set_result(function(job))
        return done


def _match(
    folder: Path, number: int, seconds: float
) -> tuple[ForkSource, tuple[str, str], random.Random]:
    """Play a match whose game, opening, bots and delays follow from its number."""
    chance = random.Random(number)
    name, settings = chance.choice(_GAMES)
    left, right = chance.choices(BOTS, _WEIGHTS, k=2)
    late = [chance.randrange(100), chance.randrange(100)]
    rules = {"match": {"duration_s": seconds, "countdown_s": 0.2}}
    path = bot_match(
        folder,
        name,
        (left, right),
        {**settings, **rules},
        match_id=f"match-{number:04d}",
        late_ticks=late,
    )
    return read_source(path), (left, right), chance


def _tell_odds(rows: list[dict[str, Any]]) -> int:
    said: list[tuple[float, float]] = []
    for row in rows:
        for one in row["asked"]:
            chance = odds.chance(one["margins"])
            said += [(chance, row["won"]), (1 - chance, 1 - row["won"])]
    return _tell(rows, said)


def _tell(rows: list[dict[str, Any]], said: list[tuple[float, float]]) -> int:
    print(f"{len(rows)} matches, {len(said) // 2} moments")
    for middle in (0.5, 0.6, 0.7, 0.8, 0.9, 0.975):
        chosen = [won for chance, won in said if abs(chance - middle) <= _BIN]
        if chosen:
            share = sum(chosen) / len(chosen)
            print(f"said {100 * middle:.0f} ± 5 %: {len(chosen)}, won {100 * share:.0f} %")
    brier = sum((chance - won) ** 2 for chance, won in said) / len(said)
    print(f"Brier score {brier:.3f} (0.25: nothing is known)")
    chosen = [won for chance, won in said if abs(chance - 0.7) <= _BIN]
    return int(not chosen or not 0.6 <= sum(chosen) / len(chosen) <= 0.8)


def _tell_swings(rows: list[dict[str, Any]]) -> int:
    found = of = 0
    parts = []
    for row in rows:
        chosen = [one for one in row["highlights"] if abs(one[2]) >= _LEAST]
        parts.append(sum(last - first for first, last, _ in chosen) / row["playing"])
        for first, last, change in row["largest"]:
            if abs(change) >= _LEAST:
                of += 1
                found += any(a < last and first < b for a, b, _ in chosen)
    print(
        f"{len(rows)} matches: highlights contain {found} of {of} of the largest swings "
        f"({100 * found / max(1, of):.0f} %) "
        f"in {100 * sum(parts) / len(parts):.0f} % of the playing time"
    )
    return int(found < 0.8 * of)


if __name__ == "__main__":
    sys.exit(main())
