"""The cells of a gait file, by row and column, as the workshop's figures 4-1 and 4-2 show them.

Text files and workbooks hold the same table: both are written from the cells made here, and
`reader` reads both once they are split into cells. Files have degrees, LACOC has radians.
"""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass

from lacoc_shared.gait.tables import (
    JOINTS_PER_LEG,
    LEVEL_NAMES,
    LocomotionTable,
    PostureTable,
    leg_and_level,
)
from lacoc_shared.mistakes import printable
from lacoc_shared.words import Phrase, say

RANGE_DEG = 150.0
"""Range in which a joint may move: -150 to +150 degrees (workshop 3-1)."""
MAX_KEYS = 10
"""Most digit keys in a file: [0] to [9]."""
MAX_POSTURES_PER_KEY = 100

LEG_LABELS: dict[int, tuple[str, ...]] = {
    4: ("R,F", "R,B", "L,B", "L,F"),
    6: ("R,F", "R,C", "R,B", "L,B", "L,C", "L,F"),
    8: ("R,F", "R,FC", "R,BC", "R,B", "L,B", "L,BC", "L,FC", "L,F"),
}
"""The usual labels of a robot's legs, by their number. A gait file shows the number of legs by its
number of columns."""

# Maps full-width forms (typed with a Japanese input method) to ASCII, the ideographic space and
# no-break spaces (copied from web pages) to a space, the minus sign U+2212 to a hyphen. U+FF0D
# is one of the full-width forms.
_SPACES = "\u3000\u00a0\u2007\u202f"
_NARROW = {0xFF01 + i: 0x21 + i for i in range(94)} | {ord(c): " " for c in _SPACES} | {0x2212: "-"}
# Characters that count as a minus: dashes and the long vowel mark; and those that count as a
# decimal point. A Japanese input method types the mark, "。" and "、" for the keys - . and comma.
_MINUS = "\u2010\u2011\u2012\u2013\u2014\u2015\u30fc\uff70"
_POINTS = ",\u3001\u3002\uff61\uff64"
_SIGN, _POINT = f"[+{_MINUS}-]?", f"[.{_POINTS}]"
_NUMBER = re.compile(rf"{_SIGN}(\d+({_POINT}\d*)?|{_POINT}\d+)([eE]{_SIGN}\d+)?", re.ASCII)
_PLAIN = str.maketrans(_MINUS + _POINTS, "-" * len(_MINUS) + "." * len(_POINTS))


@dataclass(frozen=True, slots=True)
class Row:
    """One row of a gait file: its number, counted from 1, and its cells."""

    number: int
    cells: list[str]


def posture_cells(table: PostureTable, legs: Sequence[str]) -> list[list[str | float]]:
    """Return the cells of a file of postures (level A): how many, each posture [deg], a legend.

    Raises:
        ValueError: if the table is not for a robot with these legs.
    """
    _require_fit(table, legs)
    joints = range(table.joints)
    cells: list[list[str | float]] = [["Num of Posture", float(len(table.postures))]]
    for digit, posture in sorted(table.postures.items()):
        cells.append([f"{digit} Key", *map(degrees_of, posture)])
    cells.append(["ID of Joint", *map(float, joints)])
    cells.append(["Position", *(legs[leg_and_level(joint, len(legs))[0]] for joint in joints)])
    cells.append([""])
    for name in LEVEL_NAMES:
        cells[-1] += [name] + [""] * (len(legs) - 1)
    return cells


def locomotion_cells(table: LocomotionTable, legs: Sequence[str]) -> list[list[str | float]]:
    """Return the cells of a file of locomotion (level B): number of keys, postures of each [deg].

    Raises:
        ValueError: if the table is not for a robot with these legs.
    """
    _require_fit(table, legs)
    cells: list[list[str | float]] = [[float(len(table.sequences))]]
    for sequence in table.sequences:
        cells.append([float(len(sequence))])
        cells.extend([*map(degrees_of, posture)] for posture in sequence)
    return cells


def leg_labels(legs: int) -> tuple[str, ...]:
    """Return the usual labels of a robot's legs, for use without a robot file.

    They go clockwise from the right front.

    If the robot does not have 4, 6 or 8 legs, the labels are numbers from 0.
    """
    return LEG_LABELS.get(legs) or tuple(map(str, range(legs)))


def degrees_of(angle_rad: float) -> float:
    """Return the shortest number of degrees from which exactly this angle is read.

    For an angle that came from a file there always is such a number. For another angle, return the
    nearest number.
    """
    near = math.degrees(angle_rad)
    for digits in range(1, 16):
        value = float(f"{near:.{digits}g}")
        if angle_of(value) == angle_rad:
            return value + 0.0  # never "-0"
    # Converting to radians and back rounds several times, so the number may lie just beside.
    beside = (near + steps * math.ulp(near) for steps in (0, 1, -1, 2, -2, 3, -3))
    same = [value for value in beside if angle_of(value) == angle_rad]
    return min(same, key=lambda value: len(number_text(value)), default=near)


def number_text(value: float) -> str:
    """Write a number as short as possible without loss: "45", "-22.5"."""
    return repr(float(value)).removesuffix(".0")


def narrow(text: str) -> str:
    """Replace full-width characters, special spaces and the minus sign U+2212 by ASCII."""
    return text.translate(_NARROW)


def number_of(cell: str) -> float | None:
    """Read the number in a cell; None if it is not a number.

    It may have a decimal point or comma, or what counts as one, and a degree sign behind it. Pages
    take the same signs (client/web/src/core/design/table.ts).
    """
    number = cell.removesuffix("°").rstrip()
    return float(number.translate(_PLAIN)) if _NUMBER.fullmatch(number) else None


def shown(cell: str) -> Phrase | str:
    """Return the text of a cell for an error message: short, and safe to print."""
    if not cell:
        return say("gait.nothing")
    return quoted(cell)


def quoted(cell: str) -> str:
    """Return a non-empty cell for a message: a number as it is, other text in quotation marks."""
    text = printable(cell)
    return text if number_of(cell) is not None else f'"{text}"'


def angle_of(value_deg: float) -> float:
    """Convert an angle from degrees to radians, as a file's angles are read."""
    return math.radians(value_deg) + 0.0  # turns -0.0 into 0.0


def _require_fit(table: PostureTable | LocomotionTable, legs: Sequence[str]) -> None:
    if table.joints != len(legs) * JOINTS_PER_LEG:
        raise ValueError(f"a table of {table.joints} joints is not for {len(legs)} legs")
