"""The drive: it turns the newest key into commanded angles, tick by tick (rules 3).

It is pure and exact. It knows only commanded angles, never measured ones, so its results can be
checked with pencil and paper. A `Drive` is made from a seat's robot and gait and never changes.
Each key and each tick makes a new `DriveState` from the one before.
"""

from typing import Literal

import msgspec

from lacoc_robots.robot import RobotSpec
from lacoc_shared.gait.motion import toward
from lacoc_shared.gait.tables import Gait, Level, Posture
from lacoc_shared.seat import BEAT_US

_MOST_KEPT = 1024
"""Most results of `tick` that a drive keeps in its cache (less than 1 MB)."""


class DriveState(msgspec.Struct, frozen=True):
    """State of a drive between two ticks."""

    level: Level
    digit: int
    """Digit of the newest key; 0 if the robot stands without one."""
    posture: int
    """Index of the target posture in the digit's sequence."""
    ticks: int
    """With advance "reached": ticks in a row at the target, up to the number that is needed. With
    advance "time": ticks since the sequence began.
    """
    angles: Posture
    """(joints,) commanded angles [rad], by joint id."""
    stands: bool = False
    """True if the robot stands without a pressed key: it keeps the first posture of key 0."""


class Drive:
    """Turns a seat's keys into commanded angles.

    Args:
        gait: gait of the seat's robot.
        start: (joints,) start posture [rad]; the robot stands in it at a level without a key 0.
        ang_min_rad_s: AngMin, the speed of every commanded angle [rad/s].
        advance: when a sequence goes on: when its posture is "reached", or by "time".
        hold_us: with "reached", how long a reached posture is held; with "time", how long each
            posture is commanded [us].
        repeat: whether a sequence begins again after its last posture.
    """

    def __init__(
        self,
        gait: Gait,
        start: Posture,
        ang_min_rad_s: float,
        advance: Literal["reached", "time"],
        hold_us: int,
        repeat: bool,
    ) -> None:
        self._gait = gait
        self._start = start
        self._step_rad = ang_min_rad_s * BEAT_US / 1_000_000
        self._by_time = advance == "time"
        self._hold_us = hold_us
        self._rest_ticks = 1 - (-hold_us // BEAT_US)  # 1 + ceil(hold / 20 ms)
        self._repeat = repeat
        self._following: dict[DriveState, DriveState] = {}
        """Cache of `tick`: for each state that has occurred, the state after it."""

    def begin(self, level: Level) -> DriveState:
        """Return the state of a robot that stands at a level.

        It begins in the start posture. Ticks then move it to the first posture of key 0.
        """
        return DriveState(level, 0, 0, 0, self._start, stands=True)

    def stand(self, state: DriveState) -> DriveState:
        """Return the state from which the robot moves to the first posture of key 0 (rules 3).

        The level does not change. If the robot stands already, `state` itself is returned.
        """
        if state.stands:
            return state
        return DriveState(state.level, 0, 0, 0, state.angles, stands=True)

    def has(self, level: Level, digit: int) -> bool:
        """Return whether the gait has postures for a digit at a level."""
        return self._gait.sequence(level, digit) is not None

    def press(self, state: DriveState, level: Level, digit: int) -> DriveState:
        """Return the state after a digit was pressed; its sequence begins in the next `tick`.

        If the sequence was running already, with `repeat` nothing changes; without `repeat` the
        sequence starts again.
        """
        was_pressed = (level, digit) == (state.level, state.digit) and not state.stands
        if self._repeat and was_pressed:
            return state
        return DriveState(level, digit, 0, 0, state.angles)

    def tick(self, state: DriveState) -> DriveState:
        """Return the state after one tick of 20 ms."""
        # A gait repeats itself, so nearly every state has come before.
        following = self._following.get(state)
        if following is None:
            if len(self._following) >= _MOST_KEPT:
                self._following.clear()
            following = self._following[state] = self._tick(state)
        return following

    def _tick(self, state: DriveState) -> DriveState:
        sequence = self._gait.sequence(state.level, state.digit) or (self._start,)
        if state.stands:
            sequence = sequence[:1]
        posture, ticks = state.posture, state.ticks
        if self._by_time:
            posture = self._index(ticks * BEAT_US // self._hold_us, len(sequence))
        elif ticks >= self._rest_ticks:
            following = self._index(posture + 1, len(sequence))
            if following != posture:
                posture, ticks = following, 0
        angles = toward(state.angles, sequence[posture], self._step_rad)
        if self._by_time:
            ticks += 1
        elif angles is sequence[posture]:
            ticks = min(ticks + 1, self._rest_ticks)
        return DriveState(state.level, state.digit, posture, ticks, angles, state.stands)

    def _index(self, count: int, length: int) -> int:
        return count % length if self._repeat else min(count, length - 1)


def make_drive(robot: RobotSpec, gait: Gait, repeat: bool) -> Drive:
    """Make the drive of a robot with a gait; `repeat` as in `Drive`."""
    return Drive(
        gait, robot.start_posture, robot.ang_min_rad_s, robot.advance, robot.hold_us, repeat
    )
