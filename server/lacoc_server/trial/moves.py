"""Says in a word what a key of a gait does, from a short trial of it."""

import math

from lacoc_server.trial.course import SETTLE_TICKS, Course
from lacoc_server.trial.figures import Figures, measure
from lacoc_server.trial.walk import Press
from lacoc_shared.gait.tables import Gait, Level

_SECONDS = 5.0
"""How long each key is tried [s]: some cycles of a usual gait."""
_LEAST_MM_S, _LEAST_DEG_S = 2.0, 1.5
"""A robot that is slower in both stands."""
_TIPPED = 0.8
"""As in `trial.reasons.explain`: it leans by more than 37 degrees."""
_REACH_MM = 120.0
"""Feet about this far from the middle tell whether a robot rather turns or rather walks."""


def try_key(course: Course, gait: Gait, digit: int) -> str:
    """Let a robot walk with a key of level B.

    Args:
        course: a floor with the robot.
        gait: its gait.
        digit: the key.

    Returns:
        What the key does, a name of `move.*`; "" if physics stopped.
    """
    walk = course.walk(gait, [Press(SETTLE_TICKS, Level.LOCOMOTION, digit)], _SECONDS)
    return move_of(measure(walk)) if walk.fault is None else ""


def move_of(figures: Figures) -> str:
    """Return the name of `move.*` for a walk: what it mostly does."""
    if figures.upright < _TIPPED:
        return "tip-over"
    forward, left, turn = figures.speed_mm_s, figures.lateral_mm_s, figures.drift_deg_s
    straight = math.hypot(forward, left)
    if straight < _LEAST_MM_S and abs(turn) < _LEAST_DEG_S:
        return "stand"
    if math.radians(abs(turn)) * _REACH_MM > straight:
        return "turn-left" if turn > 0 else "turn-right"
    if abs(forward) >= abs(left):
        return "forward" if forward > 0 else "back"
    return "left" if left > 0 else "right"
