"""A key's table, and how much its numbers differ between legs that should move alike.

In a gait of two halves each leg does half a cycle later what the leg opposite to it does now: that
is its **partner**. Its **mates** are the legs that do the same at the same time: every second leg,
such as R,F, R,B and L,C.
"""

import math
from collections.abc import Sequence
from functools import cached_property
from typing import NamedTuple

import numpy as np

from lacoc_robots.robot import RobotSpec
from lacoc_server.trial.reasons.goal import Goal
from lacoc_server.trial.steps import steps_of
from lacoc_server.trial.walk import Floats
from lacoc_shared.gait.tables import JOINTS_PER_LEG, LEVEL_NAMES, Level, Posture
from lacoc_shared.studio import CellPlace
from lacoc_shared.words import Phrase, say

SAME_DEG = 6.0
"""Two angles that differ by at most this much [deg] count as equal."""
_MATES = 0.25
"""Weight of differences between mates (legs that do the same at the same time); differences between
partners have the weight 1. Mates often swing by different amounts."""
_OFFSET = np.array([1.0, 0.8, 0.8])
"""Part of a constant difference between mates that is ignored, for Root, 1st and 2nd joints: legs
stand at different angles."""
_OPPOSITE_M = 0.005


class TableCell(NamedTuple):
    """A number of a key's table."""

    posture: int
    level: int
    """Index of the joint in its leg: Root 0, 1st 1, 2nd 2."""
    leg: int


class KeyForm:
    """The table of a key, and how far its numbers differ between legs that should move alike.

    Args:
        robot: the robot.
        angles_deg: (postures, 3, legs) the angles.
        goal: what the key is for.
        digit: digit of the key, to name its cells.
        level: level of the key. A key of level A is a row of the table.
    """

    def __init__(
        self,
        robot: RobotSpec,
        angles_deg: Floats,
        goal: Goal,
        digit: int,
        level: Level = Level.LOCOMOTION,
    ) -> None:
        self.robot = robot
        self.angles_deg = angles_deg
        self.goal = goal
        self.digit = digit
        self.level = level

    @classmethod
    def of(
        cls,
        robot: RobotSpec,
        sequence: Sequence[Posture],
        goal: Goal,
        digit: int,
        level: Level = Level.LOCOMOTION,
    ) -> "KeyForm":
        """Make the table of a sequence of postures [rad]."""
        angles = np.degrees(np.array(sequence, float))
        shape = (len(sequence), JOINTS_PER_LEG, len(robot.legs))
        return cls(robot, angles.reshape(shape), goal, digit, level)

    def changed(self, angles_deg: Floats) -> "KeyForm":
        """Return the table with other angles, kept in the ranges of their joints."""
        low, high = np.array(self.robot.ranges_deg).T.reshape(2, *self.angles_deg.shape[1:])
        kept = np.clip(angles_deg, low, high)
        return KeyForm(self.robot, kept, self.goal, self.digit, self.level)

    @property
    def postures(self) -> int:
        """Number of postures."""
        return len(self.angles_deg)

    @property
    def legs(self) -> int:
        """Number of legs."""
        return len(self.robot.legs)

    @property
    def half(self) -> int:
        """Postures of half a cycle; 0: the table has no halves, or the robot no opposite legs."""
        return self.postures // 2 if self.postures % 2 == 0 and is_mirrored(self.robot) else 0

    @property
    def start_deg(self) -> Floats:
        """(3, legs) the angles in which the robot stands before a key."""
        start: Floats = np.degrees(np.array(self.robot.start_posture))
        return start.reshape(JOINTS_PER_LEG, self.legs)

    @property
    def paired(self) -> tuple[int, ...]:
        """Joints of a leg (0, 1, 2) whose numbers should equal those of partners and mates.

        If the key is for turning, the roots (0) are left out.
        """
        return (0, 1, 2) if self.goal is Goal.FORWARD else (1, 2)

    @cached_property
    def partners_deg(self) -> Floats:
        """(postures, 3, legs) angle of each number's partner: opposite leg, half a cycle later."""
        return np.roll(self.angles_deg, -self.half, axis=0)[:, :, ::-1]

    @cached_property
    def odd_deg(self) -> Floats:
        """(postures, 3, legs) weighted difference of each number from its partner and its mates.

        Differences of at most `SAME_DEG` count as 0.
        """
        odd = np.zeros_like(self.angles_deg)
        levels = list(self.paired)
        if self.half:
            apart = self.angles_deg - self.partners_deg
            odd[:, levels] += _beyond(apart[:, levels]) / 2
        for first in (0, 1):
            mates = self.angles_deg[:, :, first::2]
            apart = mates[:, :, None, :] - mates[:, :, :, None]  # (postures, 3, leg, its mate)
            apart -= _OFFSET[:, None, None] * np.median(apart, axis=0)
            apart = _MATES * _beyond(apart).sum(axis=3) / max(1, mates.shape[2] - 1)
            odd[:, levels, first::2] += apart[:, levels]
        return odd

    @property
    def oddness_deg(self) -> float:
        """The sum of `odd_deg` over the table."""
        return float(self.odd_deg.sum())

    def odd_cell(self, leg: int, level: int | None = None) -> TableCell:
        """Return the cell of a leg, or of its joint `level`, with the largest `odd_deg`."""
        odd = self.odd_deg[:, :, leg]
        if level is not None:
            odd = np.where(np.arange(JOINTS_PER_LEG) == level, odd, -1.0)
        posture, at = np.unravel_index(int(odd.argmax()), odd.shape)
        return TableCell(int(posture), int(at), leg)

    @cached_property
    def thrust_m2(self) -> list[float]:
        """For each leg the area that its foot encircles [m2].

        It is positive if the leg pushes the robot in the direction that the key is for.
        """
        return [
            area * push
            for area, push in zip(
                steps_of(self.robot, self.sequence).swing_m2,
                pushes(self.robot, self.goal),
                strict=True,
            )
        ]

    @property
    def sequence(self) -> tuple[Posture, ...]:
        """The postures of the key's sequence [rad]."""
        rows = np.radians(self.angles_deg).reshape(self.postures, -1)
        return tuple(tuple(map(float, row)) for row in rows)

    def partner(self, cell: TableCell) -> TableCell:
        """Return the cell of a number's partner; if the cycle has no halves, that of a mate."""
        if self.half:
            posture = (cell.posture + self.half) % self.postures
            return TableCell(posture, cell.level, self.legs - 1 - cell.leg)
        return TableCell(cell.posture, cell.level, (cell.leg + 2) % self.legs)

    def degrees(self, cell: TableCell) -> float:
        """Return the angle in a cell [deg]."""
        return float(self.angles_deg[cell])

    def name(self, cell: TableCell) -> Phrase:
        """Make the phrase that names a cell."""
        if self.level is Level.POSTURE:
            leg, level = self.robot.labels[cell.leg], LEVEL_NAMES[cell.level]
            return say("explain.row-cell", row=self.digit, leg=leg, level=level)
        return cell_name(self.robot, self.digit, self.postures, self.place(cell))

    def place(self, cell: TableCell) -> CellPlace:
        """Return the place of a cell in the key's sequence."""
        return CellPlace(posture=cell.posture, joint=cell.leg + self.legs * cell.level)


def cell_name(robot: RobotSpec, digit: int, postures: int, place: CellPlace) -> Phrase:
    """Make the phrase that names a cell of a key's sequence.

    Args:
        robot: the robot.
        digit: digit of the key.
        postures: number of postures of the sequence.
        place: the cell.
    """
    legs = len(robot.legs)
    return say(
        "explain.cell",
        key=digit,
        posture=place.posture + 1,
        postures=postures,
        leg=robot.labels[place.joint % legs],
        level=LEVEL_NAMES[place.joint // legs],
    )


def is_mirrored(robot: RobotSpec) -> bool:
    """Return whether each leg is opposite to the leg with the same index from the end."""
    return len(robot.legs) % 2 == 0 and all(
        math.dist((one.position_m.x, one.position_m.y), (-other.position_m.x, other.position_m.y))
        < _OPPOSITE_M
        for one, other in zip(robot.legs, reversed(robot.legs), strict=True)
    )


def pushes(robot: RobotSpec, goal: Goal) -> list[int]:
    """Return for each leg whether it should push the body forward (1) or backward (-1)."""
    if goal is Goal.FORWARD:
        return [1] * len(robot.legs)
    outer = 1 if goal is Goal.LEFT else -1
    return [leg.side * outer for leg in robot.legs]


def _beyond(apart_deg: Floats) -> Floats:
    return np.maximum(0.0, np.abs(apart_deg) - SAME_DEG)
