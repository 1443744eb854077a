"""What a key is for: to go forward, or to turn."""

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
"""What the sample's keys are for (workshop Fig. 4-2)."""
_DOES = {"turn-left": Goal.LEFT, "turn-right": Goal.RIGHT}


def goal_of(press: Press, figures: Figures) -> Goal:
    """Return what a key is probably meant to do.

    The keys of the workshop have their meaning. Another key means what it does: it turns, or else
    it should go forward.
    """
    if press.level is Level.LOCOMOTION and press.digit in _MEANT:
        return _MEANT[press.digit]
    return _DOES.get(move_of(figures), Goal.FORWARD)
