"""Says in a word what a key of a gait does, from a short trial of it."""

import math

from lacoc_server.trial.course import SETTLE_TICKS, Course
from lacoc_server.trial.figures import Figures, measure
from lacoc_server.trial.walk import Press
from lacoc_shared.gait.tables import Gait, Level

_SECONDS = 5.0
"""How long each key is tried [s]: some cycles of a usual gait."""
_LEAST_MM_S, _LEAST_DEG_S = 2.0, 1.5
"""A robot whose speed and turning are both below these [mm/s, deg/s] counts as standing."""
_TIPPED = 0.8
"""A robot has tipped over if its `upright` is below this, as in `trial.reasons.explain`."""
_REACH_MM = 120.0
"""Feet are about this far from the body's middle [mm]. If turning moves them faster than the robot
walks, the key is named a turn."""


def try_key(course: Course, gait: Gait, digit: int) -> str:
    """Let a robot walk with a key of level B.

    Args:
        course: a floor with the robot.
        gait: its gait.
        digit: the key.

    Returns:
        What the key does, as a name of the texts `move.*`; "" if physics stopped.
    """
    walk = course.walk(gait, [Press(SETTLE_TICKS, Level.LOCOMOTION, digit)], _SECONDS)
    return move_of(measure(walk)) if walk.fault is None else ""


def move_of(figures: Figures) -> str:
    """Return the main motion of a walk, such as "forward" or "stand" (texts `move.*`)."""
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
