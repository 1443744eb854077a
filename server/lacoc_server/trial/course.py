"""Lets a robot walk alone on an open floor, exactly as it would walk at a court."""

from collections.abc import Sequence
from typing import NamedTuple, Protocol

import numpy as np

from lacoc_arenas import arena as arenas
from lacoc_arenas.arena import Arena
from lacoc_robots.robot import RobotSpec
from lacoc_server.match.drive import Drive, DriveState, make_drive
from lacoc_server.match.physics import Physics
from lacoc_server.trial.feet import feet_down
from lacoc_server.trial.walk import Floats, Press, Sensed, Span, Walk
from lacoc_shared.gait.tables import Gait, Level
from lacoc_shared.messages import Scene
from lacoc_shared.seat import BEATS_PER_S

SETTLE_TICKS = BEATS_PER_S // 2
"""Ticks for which the robot stands before a key is pressed."""
CYCLES = 5
"""Number of cycles that are measured, after the first cycle, in which the robot starts to move."""
NO_CYCLE_S = 6.0
"""How long a key is measured if its sequence never leaves its first posture [s]."""
LONGEST_TICKS = SETTLE_TICKS + 60 * BEATS_PER_S
"""Longest trial with all its keys [ticks]."""

_FIELD = {"game": {"size_m": [20.0, 20.0]}, "match": {"levels": ["B", "A"]}}
"""Settings of the arena "practice" for trials. The field is so large that no trial reaches a wall.
Level B is open, so that robots stand before a key as in a contest."""


def practice_field() -> Arena:
    """Load the arena in which trials take place."""
    return arenas.load("practice", _FIELD)


class SensedPhysics(Physics, Protocol):
    """Physics of one robot that also measures its contact with the floor (see `world.sensed`)."""

    @property
    def weight_n(self) -> float:
        """Weight of the robot [N]."""

    def load(self, saved: bytes) -> None:
        """Continue from a saved state."""

    def pose(self) -> Floats:
        """Return the body's position [m] and quaternion, and joint angles [rad]: (7 + joints,)."""

    def sensed(self) -> Sensed:
        """Return what was measured in the last tick."""


class Course:
    """A floor with one robot, for many trials; each trial begins in the same state.

    Args:
        world: physics with the robot at its start place.
        robot: the robot.
        arena: the field; its settings say at which level the robot stands before the first key,
            and whether sequences repeat.
    """

    def __init__(self, world: SensedPhysics, robot: RobotSpec, arena: Arena) -> None:
        self.robot = robot
        self.arena = arena
        self._world = world
        self._level = arena.match.open_levels[0]
        self._repeat = arena.match.repeat
        self._start = world.save()

    @property
    def scene(self) -> Scene:
        """The robot on its field, for drawing."""
        return self._world.scene

    def walk(
        self,
        gait: Gait,
        presses: Sequence[Press],
        seconds: float | None = None,
        cycles: int = CYCLES,
    ) -> Walk:
        """Let the robot stand, press the keys, and measure how the robot walks.

        Args:
            gait: the robot's gait.
            presses: at least one key, in the order of their ticks; the last key is measured.
            seconds: time from the last press to the end [s]. None: the trial ends after the last
                key's first cycle and `cycles` further ones, or after `NO_CYCLE_S` if the key's
                sequence never leaves its first posture. No trial is longer than `LONGEST_TICKS`.
            cycles: number of whole cycles to measure if `seconds` is None.
        """
        robot = self.robot
        drive = make_drive(robot, gait, self._repeat)
        states, starts, span = plan(drive, self._level, presses, seconds, cycles)
        world = self._world
        world.load(self._start)
        seen: list[Sensed] = []
        poses, digests = [], []
        fault = None
        for state in states:
            failed = world.step([state.angles])
            if failed is not None:
                fault = failed.why
                break
            seen.append(world.sensed())
            poses.append(world.pose())
            digests.append(world.digest)
        done, legs = len(seen), len(robot.legs)
        pose = _stack(poses, 7 + robot.joints)
        load_n = _stack([one.load_n for one in seen], legs)
        return Walk(
            legs=robot.labels,
            weight_n=world.weight_n,
            span=Span(min(span.first, done), min(span.end, done), 0 if fault else span.cycles),
            starts=tuple(start for start in starts if start < done),
            posture=np.array([state.posture for state in states[:done]], np.int64),
            body_w=pose[:, :7],
            angles_rad=pose[:, 7:],
            commanded_rad=_stack([np.array(state.angles) for state in states[:done]], robot.joints),
            load_n=load_n,
            down=feet_down(load_n, world.weight_n),
            other_load_n=np.array([one.other_load_n for one in seen]),
            power_w=np.array([one.power_w for one in seen]),
            contact_w_m=_stack([one.contact_w_m for one in seen], legs, 2),
            grip_n=_stack([one.grip_n for one in seen], legs),
            slip_m_s=_stack([one.slip_m_s for one in seen], legs),
            centre_w_m=_stack([one.centre_w_m for one in seen], 2),
            tip_m=_stack([one.tip_m for one in seen], legs),
            digests=tuple(digests),
            fault=fault,
        )


class Plan(NamedTuple):
    """The commands of a drive in a trial, which do not depend on physics."""

    states: list[DriveState]
    """State of the drive in each tick."""
    starts: list[int]
    """Ticks in which a cycle of the last key begins. The tick after the end of the trial is among
    them if a cycle would begin there."""
    span: Span
    """Ticks to measure: whole cycles after the first, or else all from the last press on."""


def plan(
    drive: Drive, level: Level, presses: Sequence[Press], seconds: float | None, cycles: int
) -> Plan:
    """Run a drive through the keys of a trial, without physics.

    Args:
        drive: the robot's drive.
        level: level at which the robot stands before the first key.
        presses: as in `Course.walk`.
        seconds: as in `Course.walk`.
        cycles: as in `Course.walk`.
    """
    last = presses[-1]
    due = {press.tick: press for press in presses}
    most = LONGEST_TICKS
    if seconds is not None:
        most = min(most, last.tick + round(seconds * BEATS_PER_S))
    state = drive.begin(level)
    states: list[DriveState] = []
    starts: list[int] = []
    repeats = False
    for tick in range(most + 1):
        press = due.get(tick)
        before = state if press is None else drive.press(state, press.level, press.digit)
        state = drive.tick(before)
        if tick == last.tick or (tick > last.tick and state.posture == 0 != before.posture):
            starts.append(tick)
        repeats = repeats or (tick >= last.tick and state.posture != 0)
        waited_s = (tick - last.tick) / BEATS_PER_S
        is_enough = len(starts) == cycles + 2 or (not repeats and waited_s >= NO_CYCLE_S)
        if tick == most or (seconds is None and is_enough):
            break
        states.append(state)
    whole = max(0, len(starts) - 2)
    span = Span(starts[1], starts[-1], whole) if whole else Span(last.tick, len(states), 0)
    return Plan(states, starts, span)


def _stack(rows: Sequence[Floats], *width: int) -> Floats:
    """Stack one row for each tick; `width` is the shape of a row, for the case without ticks."""
    return np.stack(rows) if rows else np.zeros((0, *width))
