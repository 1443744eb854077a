"""Decides whether a moment is worth one of the few cuts that a minute may have. Pure."""

import math
from collections.abc import Callable, Sequence

from lacoc_client.web.director.moments import LiveMoment

CUTS_MOST = 4
"""Most cuts in any minute."""
MINUTE_S = 60.0
_SPARE_S = 0.01  # sums of times are not exact
LEAST_S = 2.0
"""Least time between two cuts [s]."""

_RANKS = (0.03, 0.05, 0.1, 0.2)
"""While 1, 2, 3 or 4 cuts of the minute are left, only the best moments are worth a cut: these
shares of all moments."""
_NEARLY = 0.9
"""A cut costs this part of the value of the worst moment that is still worth a cut."""
_LOOKED_AT = 0.15
"""Only the best moments have any value: this share of all."""
_KNOWN_LEAST = 20
"""While fewer moments than this are known, `_AT_FIRST` is used instead of them."""
_AT_FIRST = 6.0
"""While too few moments are known: the assumed points of the worst of the best 10 % of moments."""
_MOST = 8
"""How many coming moments are compared at most."""


def cuts_left(cuts: Sequence[float], at_s: float) -> int:
    """Return how many more cuts are allowed in the minute that ends at a time.

    Args:
        cuts: the times of earlier cuts [s].
        at_s: the time [s].
    """
    return CUTS_MOST - sum(at_s - one <= MINUTE_S + _SPARE_S for one in cuts)


def may_cut(cuts: Sequence[float], at_s: float) -> bool:
    """Return whether another cut may be made now; for the arguments see `cuts_left`."""
    return cuts_left(cuts, at_s) > 0 and not (cuts and at_s - cuts[-1] < LEAST_S)


def worth(points: float) -> float:
    """Return how much it is worth to show a moment of so many points: the cube of the points."""
    return points**3


class Prices:
    """Says what moments are worth and what cuts cost, from all moments of the last minutes.

    Args:
        known: the moments of the last minutes at all courts.
    """

    def __init__(self, known: Sequence[LiveMoment]) -> None:
        self._sorted = sorted((one.points for one in known), reverse=True)
        self._least = self.least(_LOOKED_AT)
        self._costs = [_NEARLY * worth(self.least(share)) for share in _RANKS]

    def value(self, moment: LiveMoment) -> float:
        """Return what it is worth to show a moment; 0 for all but the best moments."""
        return worth(moment.points) if moment.points >= self._least else 0.0

    def cost(self, left: int) -> float:
        """Return what a cut costs while `left` cuts of the minute are left, 1 to `CUTS_MOST`."""
        return self._costs[left - 1]

    def least(self, share: float) -> float:
        """Return the points of the worst moment in the best `share` (0 to 1) of all moments."""
        if len(self._sorted) < _KNOWN_LEAST:
            return _AT_FIRST * math.sqrt(0.1 / share)
        return self._sorted[max(0, int(len(self._sorted) * share) - 1)]


def is_worth_it(
    on_air: str,
    moment: LiveMoment,
    coming: Sequence[LiveMoment],
    cuts: Sequence[float],
    prices: Prices,
    locked: Callable[[str, float], bool],
) -> bool:
    """Return whether to cut to a moment now; else it is better to save the cut for a later moment.

    Args:
        on_air: the court on air.
        moment: a moment that begins now, at a court that is not on air.
        coming: all other moments that are known and not over, at any court.
        cuts: the times of earlier cuts [s].
        prices: what moments and cuts are worth.
        locked: returns whether a cut away from a court is forbidden at a time.
    """
    gain = prices.value(moment)
    if not gain:
        return False
    best = sorted(coming, key=lambda one: (-prices.value(one), one.at_s))[:_MOST]
    ahead = sorted(one for one in best if prices.value(one))

    def way(index: int, court: str, cuts: tuple[float, ...]) -> float:
        """Return the largest gain from moment `ahead[index]` on, with `court` on air before it.

        The gain is the worth of all moments that are shown, less the costs of the cuts to them.
        """
        if index == len(ahead):
            return 0.0
        one = ahead[index]
        if one.court == court:
            return prices.value(one) + way(index + 1, court, cuts)
        stay = way(index + 1, court, cuts)
        gain = prices.value(one) - prices.cost(max(1, cuts_left(cuts, one.at_s)))
        if gain <= 0 or not may_cut(cuts, one.at_s) or locked(court, one.at_s):
            return stay
        return max(stay, gain + way(index + 1, one.court, (*cuts, one.at_s)))

    made = tuple(cuts)
    go = gain - prices.cost(max(1, cuts_left(cuts, moment.at_s)))
    go += way(0, moment.court, (*made, moment.at_s))
    return go > way(0, on_air, made)
