"""Says which of the figures that a person sees became worse, so that nobody calls it better."""

import math
from typing import NamedTuple

from lacoc_server.studio.coach.goal import goal_score
from lacoc_server.trial.figures import Figures
from lacoc_server.trial.reasons.goal import Goal

STRAIGHT_DEG_S = 3.0
"""A robot that turns at most this fast goes straight (docs/studio.md 3)."""
_WALKS_SCORE = 15.0
"""A table with a lower score has nothing yet that could become worse."""


class ShownFigure(NamedTuple):
    """A figure in sight."""

    name: str
    more: int
    """1: more is better; -1: less is."""
    step: float
    """A smaller difference is not seen."""
    cost: float
    """What a unit is worth, on the scale of the score."""


_ALWAYS = (
    ShownFigure("stable_share", 1, 0.005, 100.0),
    ShownFigure("margin_mm", 1, 0.5, 1.0),
    ShownFigure("belly_share", -1, 0.005, 100.0),
)
# The first is the figure that the goal is about.
_FORWARD = (
    ShownFigure("speed_mm_s", 1, 0.05, 1.0),
    ShownFigure("drift_deg_s", -1, 0.05, 3.0),
    ShownFigure("slip_ratio", -1, 0.005, 50.0),
    *_ALWAYS,
)
_TURN = (ShownFigure("drift_deg_s", 1, 0.05, 3.0), *_ALWAYS)


def worse(before: Figures, after: Figures, goal: Goal) -> tuple[str, ...]:
    """Return the names of the figures that became worse, as they are shown."""
    return tuple(one.name for one, loss in _losses(before, after, goal) if loss > one.step)


def harm(before: Figures, after: Figures, goal: Goal, *, everything: bool) -> float:
    """Return how much became worse, on the scale of the score; 0: nothing that could be seen.

    Args:
        before: figures of a table.
        after: figures of another table.
        goal: what the robot should do.
        everything: whether any shown figure counts, if the robot walked before; else only the
            figure that the goal is about.
    """
    walked = goal_score(before, goal) >= _WALKS_SCORE
    losses = _losses(before, after, goal)
    return sum(
        max(1.0, one.cost * loss)
        for one, loss in (losses if everything and walked else losses[:1])
        if loss > one.step
    )


def _losses(before: Figures, after: Figures, goal: Goal) -> list[tuple[ShownFigure, float]]:
    shown = _FORWARD if goal is Goal.FORWARD else _TURN
    return [
        (one, one.more * (_value(one, before, goal) - _value(one, after, goal))) for one in shown
    ]


def _value(one: ShownFigure, figures: Figures, goal: Goal) -> float:
    value = getattr(figures, one.name)
    if value is None:
        return -math.inf if one.more > 0 else 0.0
    if one.name != "drift_deg_s":
        return float(value)
    if goal is Goal.FORWARD:
        return max(STRAIGHT_DEG_S, abs(float(value)))
    return float(value if goal is Goal.LEFT else -value)
