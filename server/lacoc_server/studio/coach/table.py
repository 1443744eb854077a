"""A key's sequence as cells with whole degrees, as the file has them.

A sequence may have the same posture more than once. In a Loco-data file each posture is a row, and
changing the row changes it everywhere. So a table has one row for each different posture.
"""

import math
from typing import NamedTuple

from lacoc_shared.gait.tables import Posture

Angles = tuple[int, ...]
"""All rows of a table, one after another [deg]."""


class Cell(NamedTuple):
    """A cell of the table."""

    row: int
    joint: int


class KeyTable(NamedTuple):
    """The different postures of a key, and how the key runs through them."""

    rows: tuple[Posture, ...]
    """Different postures in order of first use [rad]."""
    order: tuple[int, ...]
    """Index of the row for each posture of the sequence."""

    @classmethod
    def of(cls, sequence: tuple[Posture, ...]) -> "KeyTable":
        """Make a table of a key's sequence."""
        rows = tuple(dict.fromkeys(sequence))
        return cls(rows, tuple(rows.index(posture) for posture in sequence))

    @property
    def joints(self) -> int:
        """Number of joints of the robot."""
        return len(self.rows[0])

    @property
    def angles_deg(self) -> Angles:
        """All angles, rounded to whole degrees."""
        return tuple(round(math.degrees(angle)) for row in self.rows for angle in row)

    def cell(self, index: int) -> Cell:
        """Return the cell of the angle with this index."""
        return Cell(*divmod(index, self.joints))

    def sequence(self, angles_deg: Angles) -> tuple[Posture, ...]:
        """Return the sequence with new angles [rad]; an angle that did not change stays exact."""
        joints = self.joints
        rows = []
        for index, row in enumerate(self.rows):
            part = angles_deg[index * joints : (index + 1) * joints]
            rows.append(
                tuple(
                    old if round(math.degrees(old)) == new else math.radians(new)
                    for old, new in zip(row, part, strict=True)
                )
            )
        return tuple(rows[index] for index in self.order)

    def changed(self, before: Angles, after: Angles) -> list[int]:
        """Return the indices of the angles that differ between two versions of this table."""
        return [i for i, (a, b) in enumerate(zip(before, after, strict=True)) if a != b]
