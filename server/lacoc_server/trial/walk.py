"""The measurements of a trial, tick by tick."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from lacoc_shared.gait.tables import Level
from lacoc_shared.seat import BEATS_PER_S
from lacoc_shared.words import Phrase

Floats = npt.NDArray[np.float64]
Bools = npt.NDArray[np.bool_]


class Press(NamedTuple):
    """A key of a trial, and the tick in which it is pressed."""

    tick: int
    level: Level
    digit: int


class Span(NamedTuple):
    """The ticks of a measurement: from `first` up to, but without, `end`."""

    first: int
    end: int
    cycles: int
    """Whole cycles of the key's sequence in the span; 0: the span has none, or physics stopped."""

    @property
    def ticks(self) -> int:
        """Number of ticks of the measurement."""
        return self.end - self.first

    @property
    def seconds(self) -> float:
        """Length of the measurement [s]."""
        return self.ticks / BEATS_PER_S


@dataclass(frozen=True, repr=False)  # that of a dataclass prints whole arrays
class Sensed:
    """The measurements of one tick.

    They are of its last physics step, unless a field says that it is a mean over all steps.
    """

    load_n: Floats
    """(legs,) normal force between each shank and the floor, mean over the steps [N]."""
    other_load_n: float
    """Normal force between all other parts and the floor, mean over the steps [N]."""
    power_w: float
    """Power of the motors into the joints [W], mean over the steps; braking does not count."""
    contact_w_m: Floats
    """(legs, 2) centre of each shank's contact in the plane of the floor, mean over the steps with
    their forces as weights; 0 without contact."""
    grip_n: Floats
    """(legs,) normal force between each shank and the floor, in the last step [N]."""
    slip_m_s: Floats
    """(legs,) speed of each shank along the floor where it touches; 0 without contact."""
    centre_w_m: Floats
    """(2,) centre of mass in the plane of the floor."""
    tip_m: Floats
    """(legs,) height of the lowest point of each shank above the floor."""


@dataclass(frozen=True, repr=False)
class Walk:
    """The measurements of a trial, tick by tick; entry k of an array was measured after tick k."""

    legs: tuple[str, ...]
    """Labels of the legs, in leg order."""
    weight_n: float
    """Weight of the robot [N]."""
    span: Span
    """Ticks over which the figures are computed."""
    starts: tuple[int, ...]
    """Ticks in which a cycle of the last key's sequence begins."""
    posture: npt.NDArray[np.int64]
    """(ticks,) index of the target posture in the key's sequence."""
    body_w: Floats
    """(ticks, 7) position [m] and orientation (quaternion w, x, y, z) of the body."""
    angles_rad: Floats
    """(ticks, joints) joint angles that were reached, by joint id."""
    commanded_rad: Floats
    """(ticks, joints) commanded joint angles, by joint id."""
    load_n: Floats
    """(ticks, legs) normal force between each shank and the floor, mean over a tick's steps."""
    down: Bools
    """(ticks, legs) whether each foot is down (`feet.feet_down`)."""
    other_load_n: Floats
    """(ticks,) normal force between all other parts and the floor, mean over a tick's steps."""
    power_w: Floats
    """(ticks,) power that the motors put into the joints, mean over a tick's steps."""
    contact_w_m: Floats
    """(ticks, legs, 2) centre of each shank's contact with the floor, as in `Sensed`."""
    grip_n: Floats
    """(ticks, legs) normal force between each shank and the floor, at the tick's last step."""
    slip_m_s: Floats
    """(ticks, legs) speed of each shank along the floor where it touches; 0 without contact."""
    centre_w_m: Floats
    """(ticks, 2) centre of mass in the plane of the floor."""
    tip_m: Floats
    """(ticks, legs) height of the lowest point of each shank above the floor."""
    digests: tuple[bytes, ...]
    """State hash after each tick, as in the frames of a match."""
    fault: Phrase | None = None
    """Why physics stopped before the end of the trial; None: physics did not stop."""
