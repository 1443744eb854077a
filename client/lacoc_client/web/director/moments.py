"""What is worth seeing at a court, found by comparing two looks at it. Pure."""

from collections.abc import Iterator
from typing import Literal, NamedTuple

from lacoc_client.web.director.courts import CourtNow

LEAD_POINTS = 2.0
"""A swing that changes which seat leads is worth so many points more."""
CLOSING_POINTS = 4.0
"""The beginning of the last 30 s of a close match is worth as much as a swing of so many points."""
_STAKE_POINTS = 4.0
"""The beginning of a match with a stake of 2 is worth as much as a swing of so many points."""

Why = Literal["lead", "swing", "closing", "stake"]
"""The kind of a moment.

lead: another seat leads now. swing: the difference in points changed. closing: the last 30 s of a
close match begin, or a match becomes close in them. stake: a match with more than the usual stake
begins.
"""


class LiveMoment(NamedTuple):
    """A moment of a match that is worth seeing."""

    at_s: float
    court: str
    points: float
    """How good it is, as the points of an equally good swing at a match of the usual stake."""
    why: Why


class Track:
    """Follows the match at one court, and finds the moments in it."""

    def __init__(self, now: CourtNow) -> None:
        self._now = now
        self._leader = _sign(now.ahead)
        """Sign of the last difference in points that was not 0."""

    def see(self, now_s: float, now: CourtNow) -> Iterator[LiveMoment]:
        """Compare how the court stands now with the look before; yield the moments in between.

        Args:
            now_s: the time of the look [s].
            now: the court.
        """
        before, self._now = self._now, now
        if now.match != before.match:
            self._leader = 0
        if not now.is_played:
            return
        if now.stake > 1 and (now.match != before.match or not before.is_played):
            yield LiveMoment(now_s, now.name, _STAKE_POINTS * (now.stake - 1), "stake")
        if now.is_closing and not (before.is_closing and now.match == before.match):
            yield LiveMoment(now_s, now.name, CLOSING_POINTS * now.stake, "closing")
        points = abs(now.ahead - before.ahead)
        leader = _sign(now.ahead)
        is_lead = bool(leader and self._leader and leader != self._leader)
        self._leader = leader or self._leader
        if now.match == before.match and before.is_played and points:
            worth = (points + LEAD_POINTS * is_lead) * now.stake
            yield LiveMoment(now_s, now.name, worth, "lead" if is_lead else "swing")


def _sign(number: float) -> int:
    return (number > 0) - (number < 0)
