"""The times in which no game is called: a pause, or a break before a stage or its final; pure."""

import msgspec

from lacoc_server.contest.league.contest import Contest
from lacoc_server.contest.league.timetable.foreseen import Foreseen
from lacoc_server.contest.league.timetable.schedule import not_before_ms, playable
from lacoc_shared.words import Phrase

_FOREVER_MS = 1 << 62


class Break(msgspec.Struct, frozen=True, kw_only=True):
    """A time in which no game is called; it may be over already."""

    until_ms: int
    """Its end, in milliseconds since 1970, UTC; 0: it lasts until the organiser ends it."""
    fixture: Phrase | None = None
    """Name of the match after the break: "Semi-final 1"; None: no match is known to follow."""
    who: tuple[Phrase, Phrase] | None = None
    """The left and the right side of the match after the break, as far as they are known."""


def newest_break(contest: Contest, coming: tuple[Foreseen, ...]) -> Break | None:
    """Return the break that is on now, or else the newest one.

    It follows from the facts alone, so its end may be past: whoever shows it compares its end with
    the clock. None: there was none, somebody ended it, or the contest is over.

    Args:
        contest: the contest.
        coming: its matches that are still to come, from `foreseen`. Of those that may be played
            when the break ends, the first one follows it.
    """
    if contest.over:
        return None
    until_ms = contest.day.until_ms
    ready = [] if contest.day.paused else playable(contest)
    begins = {match.pairing.id: not_before_ms(contest, match, _FOREVER_MS) for match in ready}
    if begins and not contest.running:
        until_ms = min(begins.values())
    if not contest.day.paused and not until_ms:
        return None
    first = min(coming, key=lambda one: begins.get(one.pairing.id, _FOREVER_MS), default=None)
    return Break(
        until_ms=0 if contest.day.paused else until_ms,
        fixture=first.fixture if first else None,
        who=first.who if first else None,
    )
