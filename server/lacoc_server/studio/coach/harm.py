"""Finds the figures of a walk that a new table makes worse, so that the coach counts them too."""

import math
from typing import NamedTuple

from lacoc_server.studio.coach.goal import goal_score
from lacoc_server.trial.figures import Figures
from lacoc_server.trial.reasons.goal import Goal

STRAIGHT_DEG_S = 3.0
"""A robot that turns at most this fast goes straight (docs/studio.md 3)."""
_WALKS_SCORE = 15.0
"""Below this score a robot does not yet walk; then only the figure of the goal is compared."""


class ShownFigure(NamedTuple):
    """A figure of a walk that pages show, and how much it counts if a new table makes it worse."""

    name: str
    more: int
    """1: larger values are better; -1: smaller values are better."""
    step: float
    """Largest loss that is ignored, because the shown digits hardly change."""
    cost: float
    """Points of the score that a loss of 1 costs."""


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
    """Return the names of the figures that became clearly worse: by more than their `step`."""
    return tuple(one.name for one, loss in _losses(before, after, goal) if loss > one.step)


def harm(before: Figures, after: Figures, goal: Goal, *, everything: bool) -> float:
    """Return the cost of the figures that became worse, in points of the score; 0 if none did.

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
