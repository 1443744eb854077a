"""Chooses the second picture: a swing at another court than the one on air. Pure."""

from collections.abc import Sequence

from lacoc_client.web.director.moments import LiveMoment
from lacoc_client.web.director.plan import LEAST_S

ASIDE_SHARE = 0.12
"""The second picture shows the best moments: this share of all."""
ASIDE_WHYS = ("swing", "lead")
"""Only these moments are worth it. When a match begins or ends, there is nothing to see at once."""
_STAYS_S = 2.5
"""So long after its moment the second picture stays [s]."""


class Aside:
    """Says which court is in the second picture.

    The second picture shows a moment for which no cut is worth it or allowed. It comes with the
    moment and goes soon after, and never shows the court on air. Going on to the next moment is no
    cut, so it needs none of the few cuts of a minute. Each court stays at least two seconds, if it
    does not vanish or come on air.
    """

    def __init__(self) -> None:
        self._moment: LiveMoment | None = None
        self._since_s = 0.0

    def look(
        self, shown_s: float, on_air: str, there: Sequence[str], best: Sequence[LiveMoment]
    ) -> LiveMoment | None:
        """Choose the moment in the second picture.

        Args:
            shown_s: the time that is shown; it never goes back [s].
            on_air: the court on air.
            there: the courts that can be shown.
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
        """Return whether the second picture leaves a moment for another one."""
        if now.court == next_.court:
            return next_.at_s > now.at_s
        has_been = now.at_s <= shown_s or now.points < next_.points
        return has_been and shown_s >= self._since_s + LEAST_S
