"""Reading the cells of a gait file, with every mistake that is in them (rules 2)."""

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
    number_text,
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

Legs = Sequence[str] | int | None
"""The robot's legs: their labels, their number, or None for any robot."""
Range = float | Sequence[tuple[float, float]]
"""Range of the angles [deg]: the same bound both ways for every joint, or (lowest, highest) of
each joint id."""

MAX_MISTAKES = 1000
"""Reading ends there: a file of garbage has thousands, and a court reads files within a beat."""

_POSTURES_HEADER = re.compile(r"num of postures?", re.IGNORECASE)

POSTURES_HEADER = '"Num of Posture" and their number (Loco-data)'
ANY_HEADER = (
    '"Num of Posture" and their number (Loco-data), or the number of keys alone (LocoTra-data)'
)


def read_cells(
    rows: Iterable[Row],
    file: str,
    *,
    legs: Legs = None,
    range_deg: Range = RANGE_DEG,
    headers: str = ANY_HEADER,
    notes: list[str] | None = None,
) -> PostureTable | LocomotionTable:
    """Read a gait; which kind it is shows in the first row.

    Args:
        rows: the rows in order; blank ones and empty cells at a row's end are skipped.
        file: the file's name, for the mistakes.
        legs: the legs of the robot it must fit; None takes any robot of 4, 6 or 8 legs.
        range_deg: the range of the angles.
        headers: what is expected in the first row of a file that has neither header.
        notes: takes what is no mistake, but may not be meant.

    Raises:
        FileRefused: with every mistake, or the first `MAX_MISTAKES`.
    """
    reader = _Reader(file, legs, range_deg, headers)
    table = reader.read(rows)
    if notes is not None:
        notes += reader.notes
    return table


class _Reader:
    """One reading of one file; collects its mistakes."""

    def __init__(self, file: str, legs: Legs, range_deg: Range, headers: str) -> None:
        self._file = file
        self._mistakes: list[Mistake] = []
        self._labels = None if legs is None or isinstance(legs, int) else tuple(legs)
        self._legs = legs if legs is None or isinstance(legs, int) else len(legs)
        self._range_deg = range_deg
        self._headers = headers
        self.notes: list[str] = []

    def read(self, rows: Iterable[Row]) -> PostureTable | LocomotionTable:
        filled = [Row(row.number, trimmed(row.cells)) for row in rows]
        filled = [row for row in filled if row.cells]
        table: PostureTable | LocomotionTable | None = None
        if not filled:
            self._add(found="an empty file", expected="a table of angles")
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
        found: str,
        expected: str,
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
        """Loco-data: the number of postures, a row for each, and legend rows or none."""
        body = list(rows)
        announced = None
        if _POSTURES_HEADER.fullmatch(rows[0].cells[0]):
            header = body.pop(0)
            announced = self._count(header, 2, MAX_KEYS, "the number of postures")
        else:
            self._missing_header(rows[0])
            if not KEY.fullmatch(rows[0].cells[0]):
                body.pop(0)
        body, legend, below = find_legend(body)
        filled = [row for row in body if without_zeros(row.cells)]
        if announced == len(filled):
            body = filled  # the others are empty rows of a sheet that was mirrored
        if announced is not None and announced != len(body):
            self._add(
                row=rows[0],
                column=2,
                found=f"{announced}, but {_counted(len(body), 'posture')} below",
                expected="as many rows as announced",
            )
        joints = self._joints(body, first=1)
        labels = self._labels_of(joints // JOINTS_PER_LEG)
        contradictions = (contradiction(row, labels) for row in legend)
        self.notes += [f"{self._file}, {note}" for note in contradictions if note]
        for row in below:
            self.notes.append(
                f"{self._file}, row {row.number}: {shown(row.cells[0])} stands below the legend "
                "and is not read."
            )
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
                    expected='a key from "0 Key" to "9 Key"',
                )
            elif (digit := int(key[1])) in postures:
                self._add(
                    row=row,
                    column=1,
                    found=f"{shown(row.cells[0])} again (first in row {row_of[digit]})",
                    expected="each key once",
                )
            else:
                postures[digit] = posture
                row_of[digit] = row.number
        return PostureTable(postures)

    def _locomotion(self, rows: list[Row]) -> LocomotionTable:
        """LocoTra-data: the number of keys; for each the number of postures, and a row for each."""
        header, *body = rows
        keys = self._count(header, 1, MAX_KEYS, "the number of keys")
        groups: list[tuple[Row | None, list[Row]]] = []
        for row in body:
            if len(row.cells) == 1:
                groups.append((row, []))
            elif groups:
                groups[-1][1].append(row)
            else:
                self._add(
                    row=row,
                    found=_counted(len(row.cells), "cell"),
                    expected="the number of postures of key [0] alone, before its postures",
                )
                groups.append((None, [row]))
        if keys is not None and keys != len(groups):
            self._add(
                row=header,
                column=1,
                found=f"{keys}, but {_counted(len(groups), 'key')} below",
                expected="as many keys as announced",
            )
        joints = self._joints([row for _, postures in groups for row in postures], first=0)
        sequences = []
        for digit, (count, postures) in enumerate(groups):
            if count is not None:
                what = f"the number of postures of key [{digit}]"
                announced = self._count(count, 1, MAX_POSTURES_PER_KEY, what)
                if announced is not None and announced != len(postures):
                    self._add(
                        row=count,
                        column=1,
                        found=f"{announced}, but {_counted(len(postures), 'row')} of angles below",
                        expected=f"as many rows as announced for key [{digit}]",
                    )
            sequences.append(tuple(self._angles(row, 0, joints) for row in postures))
        return LocomotionTable(tuple(sequences))

    def _count(self, row: Row, column: int, highest: int, what: str) -> int | None:
        """The whole number that ends a row, from 1 to `highest`; None after a mistake."""
        cell = row.cells[column - 1] if len(row.cells) >= column else ""
        if without_zeros(row.cells[column:]):
            self._add(
                row=row,
                column=column + 1,
                found=shown(row.cells[column]),
                expected=f"nothing after {what}",
            )
        value = number_of(cell)
        if value is None or not 1 <= value <= highest or not value.is_integer():
            expected = f"{what}, a whole number from 1 to {highest}"
            self._add(row=row, column=column, found=shown(cell), expected=expected)
            return None
        return int(value)

    def _joints(self, rows: Sequence[Row], first: int) -> int:
        """How many angles a row must have: as the robot needs, or else as the file mostly has."""
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
            found=f"{usual[0]} angles a row: a gait for a robot with "
            f"{usual[0] // JOINTS_PER_LEG} legs",
            expected=f"{needed} angles a row: this robot has {self._legs} legs",
        )
        return usual[0]

    def _angles(self, row: Row, first: int, joints: int) -> Posture:
        """The angles [rad] of a row from the cell with index `first` on; 0 in place of mistakes."""
        cells = row.cells[first:]
        legs = joints // JOINTS_PER_LEG
        angles = f"{joints} angles ({JOINTS_PER_LEG} for each of {legs} legs)"
        beside = [i for i in range(joints, len(cells)) if cells[i] and number_of(cells[i]) is None]
        if beside:
            self._add(
                row=row,
                column=first + beside[0] + 1,
                found=shown(cells[beside[0]]),
                expected=f"nothing after the {angles}",
            )
        elif len(cells) != joints:
            self._add(row=row, found=_counted(len(cells), "angle"), expected=angles)
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
            expected=f"an angle from {number_text(low)} to {number_text(high)} degrees",
        )
        return 0.0

    def _labels_of(self, legs: int) -> Sequence[str]:
        return self._labels if self._labels and self._legs == legs else leg_labels(legs)

    def _limits_deg(self, joint: int, joints: int) -> tuple[float, float]:
        if isinstance(self._range_deg, int | float):
            return -self._range_deg, self._range_deg
        if len(self._range_deg) == joints:
            return self._range_deg[joint]
        return -RANGE_DEG, RANGE_DEG  # another robot's gait, which is a mistake already


def _counted(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
