"""The purpose of a key: to go forward, or to turn."""

from enum import StrEnum

from lacoc_server.trial.figures import Figures
from lacoc_server.trial.moves import move_of
from lacoc_server.trial.walk import Press
from lacoc_shared.gait.tables import Level


class Goal(StrEnum):
    """What the robot should do while the key is pressed."""

    FORWARD = "forward"
    RIGHT = "right"
    """Turn to the right on the spot."""
    LEFT = "left"


_MEANT = {1: Goal.LEFT, 2: Goal.FORWARD, 3: Goal.RIGHT}
"""The goals of the sample's keys, by digit (workshop Fig. 4-2)."""
_DOES = {"turn-left": Goal.LEFT, "turn-right": Goal.RIGHT}


def goal_of(press: Press, figures: Figures) -> Goal:
    """Return what a key is probably meant to do.

    The workshop's keys of level B have fixed goals. Any other key is meant to turn if the robot
    turns with it, else to go forward.
    """
    if press.level is Level.LOCOMOTION and press.digit in _MEANT:
        return _MEANT[press.digit]
    return _DOES.get(move_of(figures), Goal.FORWARD)
