"""Plays 24 matches of both games, and lets the director choose among them in simulated time.

    python -m benchmarks.director

Bots play each match without a network. Then all matches are put on one clock, as an event would
have them: in `spread` each begins within the first three minutes, by chance, and in `at_once` all
begin together. The director looks at all courts ten times a second, as the gateway does. In
`ahead` everything is shown later than it is played, as on the pages; in `not_ahead` it is not.

A swing is a change of the difference in points at a court. Only the largest 10 % count. A swing is
on air if its court is in one of the two pictures at the swing, or at most 0.5 s later; `first`
counts the first picture only. The director has two rules for the first picture: at most four cuts a
minute, and no cut away from a match that is close in its last 30 s. `best` is what the first
picture could reach with a director that knows the future and keeps these rules, by dynamic
programming over all ways to cut.

It ends with 1 if a rule was broken, or if `ahead` had less than 90 % of these swings on air, in
`spread` or `at_once`.
"""

import os
import random
from bisect import bisect_right
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import msgspec
from arguments import arguments
from bot_matches import ARENAS, BOTS, bot_match

from benchmarks.figures import finish
from lacoc_arenas import arena as arenas
from lacoc_client.web.director.courts import LAST_S, CourtNow
from lacoc_client.web.director.director import AHEAD_S, Director
from lacoc_client.web.director.plan import CUTS_MOST, MINUTE_S
from lacoc_shared.messages import Frame
from lacoc_shared.seat import BEAT_S, BEATS_PER_S, Phase

COURTS = 24
LOOK_S = 0.1
LATE_S = 0.5
"""A moment counts as shown if its court is on air at most this long after it."""
AIM = 0.9
_ROBOTS = ("hexapod", "quadruped", "long-legs", "octopod")
_SPREAD_S = 180.0
_NEVER = float("-inf")


class Point(msgspec.Struct, frozen=True, array_like=True):
    """How a match stands from a beat on."""

    beat: int
    phase: int
    clock_ticks: int
    scores: tuple[int, ...]


class Line(msgspec.Struct, frozen=True):
    """A match as a series of scores: it has a point for each change of phase or scores."""

    duration_s: float
    points: tuple[Point, ...]


def play(number: int) -> Line:
    """Play a match, and return its line of scores; the same number gives the same match."""
    name = ARENAS[number % 2]
    pair = number // 2
    points: list[Point] = []

    def watch(frame: Frame) -> None:
        scores = tuple(seat.score for seat in frame.seats)
        now = Point(frame.beat, frame.phase, frame.clock_ticks, scores)
        if not points or (points[-1].phase, points[-1].scores) != (now.phase, now.scores):
            points.append(now)

    bot_match(
        None,
        name,
        (BOTS[pair % 3], BOTS[pair // 3 % 3]),
        match_id=f"{name}-{number:02d}",
        robots=[_ROBOTS[(pair + seat * pair // 6) % len(_ROBOTS)] for seat in range(2)],
        late_ticks=[(11 * number + 5 * seat) % 50 for seat in range(2)],
        teams=("Team 0", "Team 1"),
        watch=watch,
    )
    return Line(arenas.load(name).match.duration_s, tuple(points))


class Moment(NamedTuple):
    """A swing at a court."""

    at_s: float
    court: str
    size: int


class Cut(NamedTuple):
    """A cut: when a picture began to show a court."""

    at_s: float
    court: str
    """Name of the court; "": the picture disappeared."""


class Directed(NamedTuple):
    """What was on air in an event."""

    cuts: list[Cut]
    aside: list[Cut]
    """The cuts of the second picture."""


@dataclass(frozen=True)
class Placed:
    """A match's series of scores, on the clock that all matches of the event share."""

    name: str
    line: Line
    begins_s: float
    _beats: tuple[int, ...]

    @classmethod
    def at(cls, number: int, line: Line, begins_s: float) -> "Placed":
        """Place the line of scores of a match on the clock that all matches share."""
        beats = tuple(one.beat for one in line.points)
        return cls(f"court-{number:02d}", line, begins_s, beats)

    @property
    def ends_s(self) -> float:
        """When the last point of the line is [s]."""
        return self.begins_s + self._beats[-1] * BEAT_S

    def now(self, now_s: float) -> CourtNow:
        """Return what the director sees of this court at a time."""
        beat = round((now_s - self.begins_s) * BEATS_PER_S)
        index = bisect_right(self._beats, beat) - 1
        if index < 0:
            return CourtNow(self.name, "", Phase.LOBBY, None, (0, 0))
        point = self.line.points[index]
        ticks = point.clock_ticks + (beat - point.beat) * (point.phase == Phase.PLAYING)
        left_s = self.line.duration_s - ticks * BEAT_S
        return CourtNow(self.name, self.name, Phase(point.phase), left_s, point.scores)

    def moments(self) -> Iterator[Moment]:
        """Yield all swings of play."""
        for before, after in pairwise(self.line.points):
            size = abs(_ahead(after) - _ahead(before))
            if size and before.phase == Phase.PLAYING:
                yield Moment(self.begins_s + after.beat * BEAT_S, self.name, size)

    def closing(self) -> list[tuple[float, float]]:
        """Return the spans (from, to) [s] in which no cut may leave the match.

        In them the match is close, in its last 30 s.
        """
        found: list[tuple[float, float]] = []
        end_s = self.ends_s
        from_s = end_s - LAST_S - 1.0
        while from_s < end_s:  # finer than a look
            if self.now(from_s).is_closing:
                if found and from_s - found[-1][1] < 2 * BEAT_S:
                    found[-1] = (found[-1][0], from_s)
                else:
                    found.append((from_s, from_s))
            from_s += BEAT_S
        return found


def direct(courts: list[Placed], ahead_s: float) -> Directed:
    """Let the director watch the courts; return the cuts of both pictures, in order of time."""
    director = Director(ahead_s)
    cuts: list[Cut] = []
    aside = [Cut(-ahead_s, "")]
    end_s = max(one.ends_s for one in courts) + ahead_s + 10.0
    for look in range(round(end_s / LOOK_S)):
        now_s = look * LOOK_S
        shot = director.look(now_s, [one.now(now_s) for one in courts])
        assert shot is not None
        if not cuts or cuts[-1].court != shot.court:
            cuts.append(Cut(now_s - ahead_s, shot.court))
        second = director.aside.court if director.aside else ""
        if aside[-1].court != second:
            aside.append(Cut(now_s - ahead_s, second))
    return Directed(cuts, aside)


def on_air(cuts: list[Cut], moment: Moment) -> bool:
    """Return whether a moment's court is on air at the moment, or soon enough after it."""
    first = bisect_right([one.at_s for one in cuts], moment.at_s) - 1
    last = bisect_right([one.at_s for one in cuts], moment.at_s + LATE_S) - 1
    return any(one.court == moment.court for one in cuts[max(0, first) : last + 1])


def tenth(moments: list[Moment]) -> list[Moment]:
    """Return the 10 % with the largest swings, in order of time; of equal swings the earlier."""
    ordered = sorted(moments, key=lambda one: (-one.size, one.at_s, one.court))
    return sorted(ordered[: max(1, round(len(moments) / 10))])


def of_windows(moments: list[Moment], window_s: float) -> list[Moment]:
    """Find the largest swing in each window of time; return the largest of these swings.

    One swing is returned for every ten windows; the swings are in order of time.
    """
    best: dict[int, Moment] = {}
    for one in sorted(moments):
        window = int(one.at_s / window_s)
        if window not in best or best[window].size < one.size:
            best[window] = one
    span_s = max(one.at_s for one in moments) - min(one.at_s for one in moments)
    most = max(1, round(span_s / window_s / 10))
    ordered = sorted(best.values(), key=lambda one: (-one.size, one.at_s, one.court))
    return sorted(ordered[:most])


class _Way(NamedTuple):
    """One choice of cuts up to a moment; `best_possible` keeps choices by the court on air."""

    shown: int
    """How many moments were shown."""
    free_s: float
    """Time until which the court on air must stay on air [s]."""
    cuts: tuple[float, ...]
    """Times of the last four cuts, the oldest first [s]."""


def best_possible(moments: list[Moment], courts: list[Placed]) -> int:
    """Return how many moments a director who knows them all can show while keeping the rules.

    Each cut is made as early as the rules allow: after the court on air has shown its moment, not
    away from a close end, and with at most four cuts in a minute. Later cuts are not tried, because
    whatever is possible after a later cut is possible after an earlier one.
    """
    closing = {one.name: one.closing() for one in courts}
    ways: dict[str, list[_Way]] = {}
    for at_s, court, _ in moments:
        none = (_NEVER,) * CUTS_MOST
        found = [_Way(1, at_s, none)]  # it was on air from the beginning
        for there, kept in ways.items():
            for shown, free_s, cuts in kept:
                if there == court:
                    found.append(_Way(shown + 1, max(free_s, at_s), cuts))
                    continue
                cut_s = max(free_s, cuts[0] + MINUTE_S + LOOK_S)
                for from_s, to_s in closing[there]:
                    if from_s <= cut_s <= to_s:
                        cut_s = to_s + BEAT_S
                if cut_s <= at_s + LATE_S:
                    found.append(_Way(shown + 1, max(cut_s, at_s), (*cuts[1:], cut_s)))
        ways[court] = _undominated([*ways.get(court, []), *found])
    return max(one.shown for kept in ways.values() for one in kept)


def _undominated(ways: list[_Way]) -> list[_Way]:
    """Return the choices of cuts without each one that another equals or betters in everything."""
    kept: list[_Way] = []
    for one in sorted(set(ways), key=lambda way: (-way.shown, way.free_s, way.cuts)):
        if not any(
            other.free_s <= one.free_s
            and all(mine <= its for mine, its in zip(other.cuts, one.cuts, strict=True))
            for other in kept
        ):
            kept.append(one)
    return kept


def measure(courts: list[Placed], ahead_s: float) -> dict[str, Any]:
    """Direct the courts; count what was on air, and how often a rule was broken."""
    cuts, aside = direct(courts, ahead_s)
    times = [one.at_s for one in cuts[1:]]
    by_name = {one.name: one for one in courts}
    wanted = largest(courts)
    return {
        "cuts": len(times),
        "asides": sum(one.court != "" for one in aside),
        "most_a_minute": max(
            (bisect_right(times, at_s + MINUTE_S) - index for index, at_s in enumerate(times)),
            default=0,
        ),
        "left_closing": sum(
            by_name[before.court].now(after.at_s).is_closing for before, after in pairwise(cuts)
        ),
        "shown": sum(on_air(cuts, one) or on_air(aside, one) for one in wanted),
        "first": sum(on_air(cuts, one) for one in wanted),
    }


def largest(courts: list[Placed]) -> list[Moment]:
    """Return the 10 % largest swings of all courts."""
    return tenth(sorted(moment for one in courts for moment in one.moments()))


def told(events: list[list[Placed]], ahead_s: float) -> dict[str, Any]:
    """Direct the courts in some arrangements of the matches.

    Returns:
        The cuts in a minute, and how often the second picture showed a court; the most cuts in any
        minute; the number of cuts away from a close end; and the share of swings that was on air in
        either picture, and in the first one.
    """
    found = [measure(one, ahead_s) for one in events]
    swings = sum(len(largest(one)) for one in events)
    minutes = sum(map(_length_s, events)) / 60
    return {
        "cuts_a_minute": round(sum(one["cuts"] for one in found) / minutes, 2),
        "asides_a_minute": round(sum(one["asides"] for one in found) / minutes, 2),
        "most_a_minute": max(one["most_a_minute"] for one in found),
        "left_closing": sum(one["left_closing"] for one in found),
        "shown": round(sum(one["shown"] for one in found) / swings, 3),
        "first": round(sum(one["first"] for one in found) / swings, 3),
    }


def best(events: list[list[Placed]]) -> float:
    """Return the share of swings that a director who knows the future could show on air."""
    wanted = [largest(one) for one in events]
    shown = sum(best_possible(one, event) for one, event in zip(wanted, events, strict=True))
    return round(shown / sum(map(len, wanted)), 3)


def _length_s(courts: list[Placed]) -> float:
    return max(one.ends_s for one in courts)


def _ahead(point: Point) -> int:
    return point.scores[0] - point.scores[1]


def lines(kept: Path | None) -> list[Line]:
    """Read all matches from a file; without this file, play them and write it."""
    if kept is not None and kept.exists():
        return msgspec.json.decode(kept.read_bytes(), type=list[Line])
    with ProcessPoolExecutor(os.cpu_count()) as pool:
        found = list(pool.map(play, range(COURTS)))
    if kept is not None:
        kept.write_bytes(msgspec.json.encode(found))
    return found


def arranged(played: list[Line], number: int) -> list[Placed]:
    """Put all matches on one clock: with number 0 all begin at once, else at random times."""
    rng = random.Random(1000 + number)
    begins = [rng.uniform(0, _SPREAD_S) if number else 0.0 for _ in played]
    return [Placed.at(index, line, begins[index]) for index, line in enumerate(played)]


def main() -> None:
    """Run the benchmark, print its results, and exit with 1 if an aim is missed."""
    options = arguments(
        __doc__, events=(100, "arrangements by chance"), lines=(Path, "file that keeps the matches")
    )
    played = lines(options.lines)
    spread = [arranged(played, number + 1) for number in range(options.events)]
    found: dict[str, Any] = {}
    for name, events in (("spread", spread), ("at_once", [arranged(played, 0)])):
        found[name] = {
            "swings": sum(len(largest(one)) for one in events),
            "ahead": told(events, AHEAD_S),
            "not_ahead": told(events, 0.0),
            "best": best(events),
        }
    runs = [found[name][way] for name in found for way in ("ahead", "not_ahead")]
    kept = all(one["most_a_minute"] <= CUTS_MOST and not one["left_closing"] for one in runs)
    finish(found, kept and all(one["ahead"]["shown"] >= AIM for one in found.values()))


if __name__ == "__main__":
    main()
