"""Chooses the court that is on air. Pure: from the same matches it makes the same cuts."""

from bisect import bisect_left
from collections import deque
from collections.abc import Mapping, Sequence
from typing import Literal, NamedTuple

from lacoc_client.web.director.aside import ASIDE_SHARE, ASIDE_WHYS, Aside
from lacoc_client.web.director.courts import CourtNow
from lacoc_client.web.director.moments import LiveMoment, Track
from lacoc_client.web.director.moments import Why as Moving
from lacoc_client.web.director.plan import CUTS_MOST, Prices, cuts_left, is_worth_it, may_cut, worth

AHEAD_S = 20.0
"""Everything is shown this much later than it is played [s], so the director knows what comes."""
RESULT_S = 6.0
"""A result stays on air at least for this time [s]."""
_EARLY_S = 1.0
"""A cut is made this long before its moment, if the moment is known in time [s]."""
_LATE_S = 0.5
"""A moment that happened longer ago than this is no reason for a cut [s]."""
_EMPTY_MOST_S = 20.0
"""If the court on air has had no play for this long, even the last cut of the minute is used to
show a court with play [s]."""
_KNOWN_S = 180.0
"""Moments and cuts are valued by comparison with the moments of this many last seconds [s]."""

Why = Moving | Literal["first", "played", "gone"]
"""Why a court is on air: the kind of a moment, or

first: nothing was on air before. played: at the court shown before nothing is played, and here a
match is played. gone: the court shown before has vanished.
"""


class OnAir(NamedTuple):
    """The court that is on air, since when, and why."""

    court: str
    why: Why
    since_s: float
    """When it came on air, in the time that is shown [s]."""


class Director:
    """Chooses which court is on air, from a look at all courts several times a second.

    All courts are shown `ahead_s` later than they are played. So the director knows what comes, and
    can cut to a moment before it happens. It never cuts away from the last 30 s of a close match
    nor from a fresh result, unless the court has vanished. It never cuts more than four times in
    any minute. A second picture shows the best moments at other courts.

    Args:
        ahead_s: how much later everything is shown than it is played [s].
    """

    def __init__(self, ahead_s: float = AHEAD_S) -> None:
        self._ahead_s = ahead_s
        self._shot: OnAir | None = None
        self._looks: deque[tuple[float, Mapping[str, CourtNow]]] = deque()
        """All looks with their times, from the look that is shown now to the newest."""
        self._tracks: dict[str, Track] = {}
        self._moments: deque[LiveMoment] = deque()
        """The moments of the last minutes, also those that are not shown yet, in the order of
        time."""
        self._cuts: deque[float] = deque(maxlen=CUTS_MOST)
        self._aside = Aside()
        self.aside: LiveMoment | None = None
        """The moment that the second picture shows; None: there is no second picture now."""
        self._empty: tuple[str, str, float] = ("", "", 0.0)
        """The court on air, its match, and since when nothing has been played there [s]."""

    def look(self, now_s: float, courts: Sequence[CourtNow]) -> OnAir | None:
        """Note how all matches stand now, and choose the court on air.

        Args:
            now_s: the time, by a clock that never goes back [s].
            courts: every court that can be shown; a court that is missing has vanished.

        Returns: The court on air. It is chosen for the time that pages show, `ahead_s` ago (in the
        first `ahead_s` seconds: for the first look), and the choice knows what has happened since.
        None: there was no court at the shown time or before.
        """
        self._see(now_s, courts)
        shown_s = now_s - self._ahead_s
        while len(self._looks) > 1 and self._looks[1][0] <= shown_s:
            self._looks.popleft()
        shown = self._looks[0][1]
        if self._shot is None:
            if shown:
                self._shot = OnAir(self._richest(shown_s, shown), "first", shown_s)
            return self._shot
        self._note_empty(shown_s, shown.get(self._shot.court))
        due = [
            one
            for one in self._coming(shown_s)
            if one.at_s <= shown_s + _EARLY_S and one.court in shown
        ]
        if may_cut(self._cuts, shown_s):
            next_ = self._next(shown_s, shown, self._shot, due)
            if next_ is not None:
                self._shot = next_
                self._cuts.append(shown_s)
        self.aside = self._aside.look(shown_s, self._shot.court, [*shown], self._best(due))
        return self._shot

    def _see(self, now_s: float, courts: Sequence[CourtNow]) -> None:
        self._looks.append((now_s, {one.name: one for one in courts}))
        self._tracks = {one.name: self._tracks.get(one.name) or Track(one) for one in courts}
        for one in courts:
            self._moments.extend(self._tracks[one.name].see(now_s, one))
        while self._moments and self._moments[0].at_s < now_s - _KNOWN_S:
            self._moments.popleft()

    def _coming(self, shown_s: float) -> list[LiveMoment]:
        """Return the moments at all courts that are not over at the time `shown_s` [s]."""
        return [one for one in self._moments if one.at_s >= shown_s - _LATE_S]

    def _next(
        self, shown_s: float, shown: Mapping[str, CourtNow], shot: OnAir, due: Sequence[LiveMoment]
    ) -> OnAir | None:
        """Return the court to cut to now, for a moment or because it has play; None: do not cut."""
        now = shown.get(shot.court)
        if now is None:
            return OnAir(self._richest(shown_s, shown), "gone", shown_s) if shown else None
        if now.is_closing:
            return None
        empty_s = shown_s - self._empty[2]
        if now.is_over and empty_s < RESULT_S:
            return None
        moment = self._moment(shown_s, shot.court, due)
        if moment is not None:
            return OnAir(moment.court, moment.why, shown_s)
        richest = self._richest(shown_s, shown)
        if now.is_played or not shown[richest].is_played:
            return None
        if cuts_left(self._cuts, shown_s) > 1 or empty_s > _EMPTY_MOST_S:
            return OnAir(richest, "played", shown_s)
        return None

    def _note_empty(self, shown_s: float, now: CourtNow | None) -> None:
        """Note since when no match has been played at the court on air."""
        if now is not None and (now.is_played or self._empty[:2] != (now.name, now.match)):
            self._empty = (now.name, now.match, shown_s)

    def _moment(self, shown_s: float, on_air: str, due: Sequence[LiveMoment]) -> LiveMoment | None:
        """Return the moment, at another court than `on_air`, that is worth a cut now, if any."""
        others = [one for one in due if one.court != on_air]
        if not others:
            return None
        prices = Prices(self._moments)
        best = max(others, key=lambda one: (one.points, -one.at_s))
        later = [one for one in self._coming(shown_s) if one != best]
        return best if is_worth_it(on_air, best, later, self._cuts, prices, self._locked) else None

    def _best(self, due: Sequence[LiveMoment]) -> list[LiveMoment]:
        """Return those of the moments in `due` that are good enough for the second picture."""
        if not due:
            return []
        least = Prices(self._moments).least(ASIDE_SHARE)
        return [one for one in due if one.points >= least and one.why in ASIDE_WHYS]

    def _locked(self, court: str, at_s: float) -> bool:
        """Return whether the director must not cut away from a court at a time.

        It must not during the last 30 s of a close match, nor while a result is fresh.
        """
        now = self._at(court, at_s)
        if now is None or not now.is_over:
            return now is not None and now.is_closing
        before = self._at(court, at_s - RESULT_S)
        return before is not None and before.is_played

    def _at(self, court: str, at_s: float) -> CourtNow | None:
        """Return how a court stood at a time: as the first look at or after this time saw it."""
        index = bisect_left(self._looks, at_s, key=lambda look: look[0])
        return self._looks[min(index, len(self._looks) - 1)][1].get(court)

    def _richest(self, shown_s: float, shown: Mapping[str, CourtNow]) -> str:
        """Return the court to show: one with play, and with the largest moments soon.

        Of equal ones it is the one with the highest stake, then the first.
        """
        soon = dict.fromkeys(shown, 0.0)
        for one in self._moments:
            if one.court in soon and one.at_s >= shown_s - _LATE_S:
                soon[one.court] += worth(one.points)
        return max(shown, key=lambda name: (shown[name].is_played, soon[name], shown[name].stake))
