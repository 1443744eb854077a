"""Where a foot goes when the cells of its leg change: the truth of a prediction."""

import math
from collections.abc import Sequence
from typing import Literal

from lacoc_robots.leg import LegSpec

FootWay = Literal["forward", "back", "up", "down", "out", "in", "still"]

_STILL_M = 0.001
"""A foot that moves less than this stays where it is."""
_ALSO = 0.6
"""A direction counts as right if the foot moves there by this part of its largest motion."""


def foot_ways(
    leg: LegSpec, before_deg: Sequence[float], after_deg: Sequence[float]
) -> tuple[FootWay, ...]:
    """Say where the foot of a leg goes, seen from the body.

    Args:
        leg: the leg.
        before_deg: (3,) angles of root, 1st and 2nd joint before the change.
        after_deg: (3,) angles after it.

    Returns:
        All directions that are right answers, the strongest first. "out" is away from the body's
        middle line. At an angle of 45 degrees two directions are right.
    """
    start = leg.points(*map(math.radians, before_deg))[-1]
    end = leg.points(*map(math.radians, after_deg))[-1]
    out_m, ahead_m, up_m = leg.side * (end.x - start.x), end.y - start.y, end.z - start.z
    if math.hypot(out_m, ahead_m, up_m) < _STILL_M:
        return ("still",)
    moves: list[tuple[float, FootWay]] = [
        (abs(ahead_m), "forward" if ahead_m > 0 else "back"),
        (abs(up_m), "up" if up_m > 0 else "down"),
        (abs(out_m), "out" if out_m > 0 else "in"),
    ]
    moves.sort(key=lambda move: -move[0])
    return tuple(way for by_m, way in moves if by_m >= _ALSO * moves[0][0])
