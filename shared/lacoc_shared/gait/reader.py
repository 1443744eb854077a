"""Makes a gait from the cells of a gait file, and lists every mistake in them."""

import math
import re
from collections import Counter
from collections.abc import Iterable, Sequence
from typing import NoReturn

from lacoc_shared.gait.cells import (
    LEG_LABELS,
    MAX_KEYS,
    MAX_POSTURES_PER_KEY,
    RANGE_DEG,
    Row,
    angle_of,
    leg_labels,
    number_of,
    quoted,
    shown,
)
from lacoc_shared.gait.legend import KEY, contradiction, find_legend, trimmed, without_zeros
from lacoc_shared.gait.tables import (
    JOINTS_PER_LEG,
    LocomotionTable,
    Posture,
    PostureTable,
    leg_and_level,
)
from lacoc_shared.mistakes import FileRefused, Mistake
from lacoc_shared.words import Phrase, say

Legs = Sequence[str] | int | None
"""The robot's legs: their labels, their number, or None for any robot."""
Range = float | Sequence[tuple[float, float]]
"""Range of the angles [deg]: one bound for both directions of every joint, or (lowest, highest)
for each joint id."""

MAX_MISTAKES = 1000
"""Reading stops at this many mistakes: a file that is no gait has thousands, and a court reads
files between its beats."""

_RADIANS = 3.2
"""If the largest angle of a table is at most this [deg], the angles were perhaps meant in radians:
half a turn."""

_POSTURES_HEADER = re.compile(r"num of postures?", re.IGNORECASE)

POSTURES_HEADER = say("gait.posture-header")
ANY_HEADER = say("gait.header")


def read_cells(
    rows: Iterable[Row],
    file: str,
    *,
    legs: Legs = None,
    range_deg: Range = RANGE_DEG,
    headers: Phrase = ANY_HEADER,
    notes: list[Phrase] | None = None,
) -> PostureTable | LocomotionTable:
    """Make a gait from the cells of a gait file; the first row shows of which kind.

    Args:
        rows: the rows in order; blank rows, and empty cells at the end of a row, are skipped.
        file: the file's name, for error messages.
        legs: the legs of the robot that the gait must fit; None: any robot with 4, 6 or 8 legs.
        range_deg: the range of the angles.
        headers: the expected first row, for the message if the first row is neither of the two
            headers.
        notes: list that remarks are appended to: not mistakes, but perhaps not intended.

    Raises:
        FileRefused: with every mistake, or the first `MAX_MISTAKES`.
    """
    reader = _TableReader(file, legs, range_deg, headers)
    table = reader.read(rows)
    if notes is not None:
        notes += reader.notes
        if 0 < (largest := _largest_deg(table)) <= _RADIANS:
            notes.append(say("gait.radians", file=file, largest=round(largest, 2)))
    return table


def _largest_deg(table: PostureTable | LocomotionTable) -> float:
    """Return the largest angle of a gait [deg], without regard to its sign; 0 if it has none."""
    postures = (
        table.postures.values()
        if isinstance(table, PostureTable)
        else (posture for sequence in table.sequences for posture in sequence)
    )
    return math.degrees(max((abs(one) for posture in postures for one in posture), default=0.0))


class _TableReader:
    """Reads the cells of one gait file, and collects the mistakes in them."""

    def __init__(self, file: str, legs: Legs, range_deg: Range, headers: Phrase) -> None:
        self._file = file
        self._mistakes: list[Mistake] = []
        self._labels = None if legs is None or isinstance(legs, int) else tuple(legs)
        self._legs = legs if legs is None or isinstance(legs, int) else len(legs)
        self._range_deg = range_deg
        self._headers = headers
        self.notes: list[Phrase] = []

    def read(self, rows: Iterable[Row]) -> PostureTable | LocomotionTable:
        filled = [Row(row.number, trimmed(row.cells)) for row in rows]
        filled = [row for row in filled if row.cells]
        table: PostureTable | LocomotionTable | None = None
        if not filled:
            self._add(found=say("gait.empty"), expected=say("gait.table"))
        elif len(filled[0].cells) == 1 and number_of(filled[0].cells[0]) is not None:
            table = self._locomotion(filled)
        elif _POSTURES_HEADER.fullmatch(filled[0].cells[0]) or any(
            KEY.fullmatch(row.cells[0]) for row in filled
        ):
            table = self._postures(filled)
        else:
            self._missing_header(filled[0])
        if self._mistakes or table is None:
            self._refuse()
        return table

    def _refuse(self) -> NoReturn:
        raise FileRefused(sorted(self._mistakes, key=lambda m: (m.row or 0, m.column or 0)))

    def _add(
        self,
        found: Phrase | str,
        expected: Phrase,
        row: Row | None = None,
        column: int | None = None,
        joint: int | None = None,
        leg: str | None = None,
    ) -> None:
        self._mistakes.append(
            Mistake(
                file=self._file,
                row=row.number if row else None,
                column=column,
                joint=joint,
                leg=leg,
                found=found,
                expected=expected,
            )
        )
        if len(self._mistakes) == MAX_MISTAKES:
            self._refuse()

    def _missing_header(self, row: Row) -> None:
        self._add(
            row=row,
            column=1,
            found=shown(row.cells[0]),
            expected=self._headers,
        )

    def _postures(self, rows: list[Row]) -> PostureTable:
        """Read postures (level A): their number, a row for each, and perhaps a legend."""
        body = list(rows)
        announced = None
        if _POSTURES_HEADER.fullmatch(rows[0].cells[0]):
            header = body.pop(0)
            announced = self._count(header, 2, MAX_KEYS, say("gait.number-of-postures"))
        else:
            self._missing_header(rows[0])
            if not KEY.fullmatch(rows[0].cells[0]):
                body.pop(0)
        body, legend, below = find_legend(body)
        filled = [row for row in body if without_zeros(row.cells)]
        if announced == len(filled):
            body = filled  # the other rows are empty rows of a mirrored sheet
        if announced is not None and announced != len(body):
            self._add(
                row=rows[0],
                column=2,
                found=say("gait.fewer-postures", said=announced, found=len(body)),
                expected=say("gait.rows-announced"),
            )
        joints = self._joints(body, first=1)
        labels = self._labels_of(joints // JOINTS_PER_LEG)
        contradictions = (contradiction(self._file, row, labels) for row in legend)
        self.notes += [note for note in contradictions if note]
        for row in below:
            cell = shown(row.cells[0])
            self.notes.append(say("gait.below-legend", file=self._file, row=row.number, cell=cell))
        postures: dict[int, Posture] = {}
        row_of: dict[int, int] = {}
        for row in body:
            posture = self._angles(row, 1, joints)
            key = KEY.fullmatch(row.cells[0])
            if key is None:
                self._add(
                    row=row,
                    column=1,
                    found=shown(row.cells[0]),
                    expected=say("gait.key-name"),
                )
            elif (digit := int(key[1])) in postures:
                self._add(
                    row=row,
                    column=1,
                    found=say("gait.key-again", cell=quoted(row.cells[0]), row=row_of[digit]),
                    expected=say("gait.key-once"),
                )
            else:
                postures[digit] = posture
                row_of[digit] = row.number
        return PostureTable(postures)

    def _locomotion(self, rows: list[Row]) -> LocomotionTable:
        """Read locomotion (level B): the number of keys, then for each a count and its postures."""
        header, *body = rows
        keys = self._count(header, 1, MAX_KEYS, say("gait.number-of-keys"))
        groups: list[tuple[Row | None, list[Row]]] = []
        for row in body:
            if len(row.cells) == 1:
                groups.append((row, []))
            elif groups:
                groups[-1][1].append(row)
            else:
                self._add(
                    row=row,
                    found=say("gait.cells", count=len(row.cells)),
                    expected=say("gait.count-of-key-0"),
                )
                groups.append((None, [row]))
        if keys is not None and keys != len(groups):
            self._add(
                row=header,
                column=1,
                found=say("gait.fewer-keys", said=keys, found=len(groups)),
                expected=say("gait.keys-announced"),
            )
        joints = self._joints([row for _, postures in groups for row in postures], first=0)
        sequences = []
        for digit, (count, postures) in enumerate(groups):
            if count is not None:
                what = say("gait.postures-of-key", key=digit)
                announced = self._count(count, 1, MAX_POSTURES_PER_KEY, what)
                if announced is not None and announced != len(postures):
                    self._add(
                        row=count,
                        column=1,
                        found=say("gait.fewer-rows", said=announced, found=len(postures)),
                        expected=say("gait.rows-of-key", key=digit),
                    )
            sequences.append(tuple(self._angles(row, 0, joints) for row in postures))
        return LocomotionTable(tuple(sequences))

    def _count(self, row: Row, column: int, highest: int, what: Phrase) -> int | None:
        """Read a whole number from 1 to `highest` in a cell; None if the number is wrong.

        Columns are counted from 1. A mistake is noted if the number is wrong, or if a cell after
        this column is neither empty nor 0.
        """
        cell = row.cells[column - 1] if len(row.cells) >= column else ""
        if without_zeros(row.cells[column:]):
            self._add(
                row=row,
                column=column + 1,
                found=shown(row.cells[column]),
                expected=say("gait.nothing-after", what=what),
            )
        value = number_of(cell)
        if value is None or not 1 <= value <= highest or not value.is_integer():
            expected = say("gait.whole-number", what=what, most=highest)
            self._add(row=row, column=column, found=shown(cell), expected=expected)
            return None
        return int(value)

    def _joints(self, rows: Sequence[Row], first: int) -> int:
        """Return how many angles each row of the file should have.

        If a robot is given, return the robot's number of joints. But if no row has so many angles,
        and some rows fit another robot, the file is for another robot: note this as one mistake.
        Then, and if no robot is given, return the number of angles that fits 4, 6 or 8 legs and is
        most common in the file.
        """
        counts = Counter(len(row.cells) - first for row in rows)
        known = {legs * JOINTS_PER_LEG for legs in LEG_LABELS}
        usual = [joints for joints, _ in counts.most_common() if joints in known]
        if self._legs is None:
            return usual[0] if usual else 6 * JOINTS_PER_LEG
        needed = self._legs * JOINTS_PER_LEG
        if needed in counts or not usual:
            return needed
        self._add(
            row=rows[0],
            found=say("gait.for-legs", count=usual[0], legs=usual[0] // JOINTS_PER_LEG),
            expected=say("gait.angles-a-row", count=needed, legs=self._legs),
        )
        return usual[0]

    def _angles(self, row: Row, first: int, joints: int) -> Posture:
        """Read the angles [rad] of a row from cell index `first` on; a wrong cell becomes 0."""
        cells = row.cells[first:]
        legs = joints // JOINTS_PER_LEG
        angles = say("gait.angles-of-legs", count=joints, each=JOINTS_PER_LEG, legs=legs)
        beside = [i for i in range(joints, len(cells)) if cells[i] and number_of(cells[i]) is None]
        if beside:
            self._add(
                row=row,
                column=first + beside[0] + 1,
                found=shown(cells[beside[0]]),
                expected=say("gait.nothing-after", what=angles),
            )
        elif len(cells) != joints:
            self._add(row=row, found=say("gait.angles", count=len(cells)), expected=angles)
        return tuple(
            self._angle(row, first + joint + 1, joint, joints)
            for joint in range(min(joints, len(cells)))
        )

    def _angle(self, row: Row, column: int, joint: int, joints: int) -> float:
        cell = row.cells[column - 1]
        value = number_of(cell)
        low, high = self._limits_deg(joint, joints)
        if value is not None and low <= value <= high:
            return angle_of(value)
        legs = joints // JOINTS_PER_LEG
        labels = self._labels_of(legs)
        self._add(
            row=row,
            column=column,
            joint=joint,
            leg=labels[leg_and_level(joint, legs)[0]],
            found=shown(cell),
            expected=say("gait.angle", low=low, high=high),
        )
        return 0.0

    def _labels_of(self, legs: int) -> Sequence[str]:
        return self._labels if self._labels and self._legs == legs else leg_labels(legs)

    def _limits_deg(self, joint: int, joints: int) -> tuple[float, float]:
        if isinstance(self._range_deg, int | float):
            return -self._range_deg, self._range_deg
        if len(self._range_deg) == joints:
            return self._range_deg[joint]
        return -RANGE_DEG, RANGE_DEG  # the gait of another robot; this mistake is already noted
