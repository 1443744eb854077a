"""The drive: from a standing command to commanded angles, tick by tick (rules 3).

Pure and exact: it knows commanded angles only, never measured ones, so a match's
drives can be followed with pencil and paper. What changes is a `DriveState`; a
`Drive` is what a seat's robot and files make of it.
"""

from typing import Literal

import msgspec

from lacoc_shared.gait.motion import toward
from lacoc_shared.gait.tables import Gait, Level, Posture
from lacoc_shared.seat import BEAT_US


class DriveState(msgspec.Struct, frozen=True):
    """What a drive remembers from one tick to the next."""

    level: Level
    digit: int
    """The standing command."""
    posture: int
    """Index of the target posture in the digit's sequence."""
    ticks: int
    """advance "reached": ticks at whose end the target had been reached, in a row; "time": ticks
    since the command."""
    angles: Posture
    """(joints,) commanded angles [rad], by joint id."""
    stands: bool = False
    """Nobody pressed the key: it is the first posture of its sequence, and stays."""


class Drive:
    """How a seat's robot turns keys into commanded angles.

    Args:
        gait: the seat's files.
        start: (joints,) start posture [rad]; also what key 0 means at a level whose file lacks it.
        ang_min_rad_s: AngMin, the speed of every commanded angle [rad/s].
        advance: when a sequence goes on: when its posture is "reached", or by "time".
        hold_us: how long a reached posture is held, or the time of each posture [us].
        repeat: whether sequences repeat while the command stands.
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

    def begin(self, level: Level) -> DriveState:
        """The start posture, from which it stands at a level."""
        return DriveState(level, 0, 0, 0, self._start, stands=True)

    def stand(self, state: DriveState) -> DriveState:
        """Key 0 at the same level, of which only the first posture is taken (decision 15)."""
        if state.stands:
            return state
        return DriveState(state.level, 0, 0, 0, state.angles, stands=True)

    def has(self, level: Level, digit: int) -> bool:
        """Whether a digit does something at a level."""
        return self._gait.sequence(level, digit) is not None

    def press(self, state: DriveState, level: Level, digit: int) -> DriveState:
        """Take a command; its sequence begins with this tick.

        A command is (level, digit): with `repeat`, the one that stands already changes nothing;
        without, it starts its sequence again.
        """
        was_pressed = (level, digit) == (state.level, state.digit) and not state.stands
        if self._repeat and was_pressed:
            return state
        return DriveState(level, digit, 0, 0, state.angles)

    def tick(self, state: DriveState) -> DriveState:
        """Let one tick of 20 ms pass."""
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
