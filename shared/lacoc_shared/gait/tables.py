"""Gaits: the postures that each digit key commands.

Angles are in radians, in the order of the joint ids of rules 1: id = leg + legs *
level, with the legs clockwise from the right front and the levels root, 1st, 2nd.
`text` and `workbook` read the files.
"""

from enum import IntEnum

import msgspec

Posture = tuple[float, ...]
"""(joints,) angles [rad], by joint id."""

JOINTS_PER_LEG = 3
LEVEL_NAMES = ("Root", "1st", "2nd")
"""Names of the three joints of a leg, from the body outward (workshop Fig. 4-1)."""


class Level(IntEnum):
    """The two levels of control: what a digit key commands."""

    POSTURE = 0
    """(A) A digit commands one posture."""
    LOCOMOTION = 1
    """(B) A digit commands a sequence of postures."""


class PostureTable(msgspec.Struct, frozen=True):
    """The content of a file of postures (Loco-data): one for each digit key (level A)."""

    postures: dict[int, Posture]
    """Digit -> angles [rad]; 1 to 10 entries, all of one length."""

    @property
    def joints(self) -> int:
        """Number of joints of the robot that this table is for."""
        return len(next(iter(self.postures.values())))


class LocomotionTable(msgspec.Struct, frozen=True):
    """The content of a file of locomotion (LocoTra-data): a sequence of postures for each key.

    The keys are the digits from 0 on, at level B.
    """

    sequences: tuple[tuple[Posture, ...], ...]
    """Index = digit; 1 to 10 sequences of 1 to 100 postures."""

    @property
    def joints(self) -> int:
        """Number of joints of the robot that this table is for."""
        return len(self.sequences[0][0])


class Gait(msgspec.Struct, frozen=True):
    """The gait of a robot: what the keys of its seat do, as one table or both."""

    postures: PostureTable | None = None
    locomotion: LocomotionTable | None = None

    @property
    def joints(self) -> int:
        """Number of joints of the robot that this gait is for.

        Raises:
            ValueError: if the gait is empty, or its two tables are for different robots.
        """
        counts = {t.joints for t in (self.postures, self.locomotion) if t is not None}
        if len(counts) != 1:
            raise ValueError(f"a gait needs tables for one robot, found joint counts {counts}")
        return counts.pop()

    def keys(self, level: Level) -> tuple[int, ...]:
        """Return the digits that do something at a level, in ascending order."""
        if level is Level.POSTURE:
            return tuple(sorted(self.postures.postures)) if self.postures else ()
        return tuple(range(len(self.locomotion.sequences))) if self.locomotion else ()

    def sequence(self, level: Level, digit: int) -> tuple[Posture, ...] | None:
        """Return the postures of a key, one at level A; None if the gait has no such key."""
        if level is Level.POSTURE:
            posture = self.postures.postures.get(digit) if self.postures else None
            return None if posture is None else (posture,)
        if self.locomotion is None or not 0 <= digit < len(self.locomotion.sequences):
            return None
        return self.locomotion.sequences[digit]


SAMPLE_KEYS: tuple[tuple[int, ...], ...] = ((0,), (8, 7, 6, 5), (1, 2, 3, 4), (5, 6, 7, 8))
"""The digits of the postures of each key in workshop Fig. 4-2: [0] stand, [1] turn left, [2]
forward, [3] turn right."""


def to_locomotion(table: PostureTable, keys: tuple[tuple[int, ...], ...]) -> LocomotionTable:
    """Join postures (level A) into the sequences of a locomotion table (level B).

    Args:
        table: the postures.
        keys: for each digit from 0 on, the digits of the postures of its sequence.

    Raises:
        KeyError: if a digit is not in the table.
    """
    return LocomotionTable(
        tuple(tuple(table.postures[digit] for digit in sequence) for sequence in keys)
    )


def to_postures(table: LocomotionTable) -> PostureTable:
    """Make a posture table of a locomotion table: its different postures, in order of first use.

    Raises:
        ValueError: if there are more than ten different postures.
    """
    different = list(dict.fromkeys(p for sequence in table.sequences for p in sequence))
    if len(different) > 10:
        raise ValueError(f"{len(different)} different postures, but there are only ten digit keys")
    return PostureTable(dict(enumerate(different)))


def leg_and_level(joint: int, legs: int) -> tuple[int, int]:
    """Split a joint id, leg + legs * level, into leg and level (Root 0, 1st 1, 2nd 2)."""
    return joint % legs, joint // legs
