"""Chooses what the second picture shows: a swing at another court than the one on air. Pure."""

from collections.abc import Sequence

from lacoc_client.web.director.moments import LiveMoment
from lacoc_client.web.director.plan import LEAST_S

ASIDE_SHARE = 0.12
"""Share of all moments that are good enough for the second picture: the best ones."""
ASIDE_WHYS = ("swing", "lead")
"""Only moments of these kinds are shown: when a match begins or ends, there is nothing to see at
once."""
_STAYS_S = 2.5
"""The second picture stays for this time after its moment [s]."""


class Aside:
    """Chooses the court that the second picture shows.

    The second picture shows moments for which a cut is not worth it or not allowed. It appears up
    to a second before the moment, disappears soon after it, and never shows the court on air. A
    change to the next moment is no cut, so it does not use up one of the few cuts of a minute. Each
    court stays at least two seconds, unless it vanishes or comes on air.
    """

    def __init__(self) -> None:
        self._moment: LiveMoment | None = None
        self._since_s = 0.0

    def look(
        self, shown_s: float, on_air: str, there: Sequence[str], best: Sequence[LiveMoment]
    ) -> LiveMoment | None:
        """Choose the moment that the second picture shows now.

        Args:
            shown_s: the time that is shown; it never goes back [s].
            on_air: the court on air.
            there: names of the courts that can be shown.
            best: the best moments that begin now, at any of these courts.

        Returns:
            The moment; None: there is no second picture now.
        """
        now = self._moment
        if now is not None:
            is_past = shown_s > now.at_s + _STAYS_S and shown_s >= self._since_s + LEAST_S
            if is_past or now.court == on_air or now.court not in there:
                now = None
        others = [one for one in best if one.court != on_air]
        next_ = max(others, key=lambda one: (one.points, -one.at_s), default=None)
        if next_ is not None and (now is None or self._goes_on(shown_s, now, next_)):
            if now is None or now.court != next_.court:
                self._since_s = shown_s
            now = next_
        self._moment = now
        return now

    def _goes_on(self, shown_s: float, now: LiveMoment, next_: LiveMoment) -> bool:
        """Return whether the second picture should change from the moment `now` to `next_`."""
        if now.court == next_.court:
            return next_.at_s > now.at_s
        has_been = now.at_s <= shown_s or now.points < next_.points
        return has_been and shown_s >= self._since_s + LEAST_S
