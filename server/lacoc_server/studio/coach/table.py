"""The table of a key's sequence: the rows of its gait file, with whole degrees in the cells.

In a Loco-data file each posture is a row with a digit. A sequence may use the same digit more than
once; a change of the row then changes all these postures. In a LocoTra-data file each posture of a
sequence is a row of its own, also if two rows are equal by chance.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

from lacoc_shared.gait.tables import Posture

Angles = tuple[int, ...]
"""The angles of all rows of a table, one row after another [deg]."""


class Cell(NamedTuple):
    """A cell of the table."""

    row: int
    joint: int


class KeyTable(NamedTuple):
    """The rows that a key uses, and the order in which its sequence uses them."""

    rows: tuple[Posture, ...]
    """Posture of each row [rad], in the order in which the sequence first uses them."""
    order: tuple[int, ...]
    """Index of the row for each posture of the sequence."""

    @classmethod
    def of(cls, sequence: tuple[Posture, ...], digits: Sequence[int] | None = None) -> "KeyTable":
        """Make a table of a key's sequence.

        Args:
            sequence: the postures [rad].
            digits: digits of the postures in a Loco-data file; None: each posture is its own row.
        """
        names = range(len(sequence)) if digits is None else digits
        rows = dict(zip(names, sequence, strict=True))
        places = {name: row for row, name in enumerate(rows)}
        return cls(tuple(rows.values()), tuple(places[name] for name in names))

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
        """Return the sequence with new angles [rad]; angles that did not change are not rounded."""
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


def differing(before: Angles, after: Angles) -> list[int]:
    """Return the indices of the angles that differ between two versions of a table."""
    return [i for i, (a, b) in enumerate(zip(before, after, strict=True)) if a != b]
