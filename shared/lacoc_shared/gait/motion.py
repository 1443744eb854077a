"""Motion of commanded angles from one posture to another (docs/rules.md 3)."""

from lacoc_shared.gait.tables import Posture

_ROUNDING = 1 + 1e-9
"""Tolerance for rounding, so that 24 degrees at 2.4 degrees a tick take exactly 10 ticks."""


def toward(angles: Posture, target: Posture, step_rad: float) -> Posture:
    """Move each commanded angle toward its target by at most one step.

    Once all angles have arrived, `target` itself is returned.

    Args:
        angles: (joints,) commanded angles [rad].
        target: (joints,) angles to reach [rad].
        step_rad: largest change of an angle in one tick [rad].
    """
    if angles == target:
        return target
    reach = step_rad * _ROUNDING
    moved = tuple(
        [
            angle + step_rad
            if (gap := goal - angle) > reach
            else angle - step_rad
            if gap < -reach
            else goal
            for angle, goal in zip(angles, target, strict=True)
        ]
    )
    return target if moved == target else moved
