"""Scores how well a robot walks or turns, depending on what its key is for."""

from lacoc_server.trial.figures import Figures
from lacoc_server.trial.reasons.goal import Goal

_BELLY, _UPRIGHT = 0.02, 0.9
"""A robot counts as fallen if parts other than feet are on the floor for more than `_BELLY` of the
ticks, or if `upright` is below `_UPRIGHT`."""
_TURN_MM_S_PER_DEG_S = 3.0
"""A turn of 20 deg/s is worth as much as a walk of 60 mm/s."""
_DRIFT_FREE_DEG_S = 3.0


def goal_value(figures: Figures, goal: Goal) -> float:
    """Return the figure that a goal is about: forward speed [mm/s], or turning [deg/s]."""
    if goal is Goal.FORWARD:
        return figures.speed_mm_s
    return figures.drift_deg_s if goal is Goal.LEFT else -figures.drift_deg_s


def goal_score(figures: Figures, goal: Goal) -> float:
    """Return the score of a walk, in points: one for each mm/s.

    The score is negative if the robot rests on its body or tips over. It is also negative if no
    cycle was completed, because physics stopped or the key's sequence never begins again.

    Args:
        figures: figures of the walk.
        goal: what the key is for.
    """
    fallen = max(0.0, _UPRIGHT - figures.upright) + max(0.0, figures.belly_share - _BELLY)
    if fallen or not figures.cycles:
        return -100.0 * (fallen or 1.0)
    if goal is Goal.FORWARD:
        drift_deg_s = max(0.0, abs(figures.drift_deg_s) - _DRIFT_FREE_DEG_S)
        return (
            figures.speed_mm_s - abs(figures.lateral_mm_s) / 2 - _TURN_MM_S_PER_DEG_S * drift_deg_s
        )
    turn_deg_s = figures.drift_deg_s if goal is Goal.LEFT else -figures.drift_deg_s
    along_mm_s = abs(figures.speed_mm_s) + abs(figures.lateral_mm_s)
    return _TURN_MM_S_PER_DEG_S * turn_deg_s - along_mm_s / 2
