"""A gait as a table of the page /design: rows of angles in degrees, sorted by key."""

from itertools import groupby
from typing import Annotated, Literal

import msgspec

from lacoc_robots.library import GAIT_NAMES
from lacoc_shared.gait.cells import MAX_KEYS, MAX_POSTURES_PER_KEY, Row, degrees_of, number_text
from lacoc_shared.gait.reader import read_cells
from lacoc_shared.gait.tables import JOINTS_PER_LEG, Level, LocomotionTable, Posture, PostureTable
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

_Digit = Annotated[int, msgspec.Meta(ge=0, lt=MAX_KEYS)]
_Index = Annotated[int, msgspec.Meta(ge=0, lt=MAX_POSTURES_PER_KEY)]
_MOST_LEGS = 32
"""Most legs of a table that a page may send. The time to check a table grows with the number of
legs, so without a limit one small message could make a whole class wait for minutes."""


class FileRow(msgspec.Struct, frozen=True, kw_only=True):
    """One posture (row) of a table on the page."""

    key: _Digit
    posture: _Index = 0
    """Index in the key's sequence; 0 in a table of postures."""
    angles_deg: Annotated[tuple[float, ...], msgspec.Meta(max_length=_MOST_LEGS * JOINTS_PER_LEG)]
    """Angle of each joint [deg], by joint id; (joints,)."""


class FileTable(msgspec.Struct, frozen=True, kw_only=True):
    """The table of a gait file, as the page has it."""

    kind: Literal["postures", "locomotion"]
    legs: Annotated[int, msgspec.Meta(ge=1, le=_MOST_LEGS)]
    rows: Annotated[tuple[FileRow, ...], msgspec.Meta(max_length=MAX_KEYS * MAX_POSTURES_PER_KEY)]

    @property
    def file_name(self) -> str:
        """The usual name of a text file of this kind of table, as "Loco-data.txt" (rules 2)."""
        return GAIT_NAMES[Level.POSTURE if self.kind == "postures" else Level.LOCOMOTION]


def page_table(gait: PostureTable | LocomotionTable) -> FileTable:
    """Make the table of a page from a gait, in the order of its keys."""
    legs = gait.joints // JOINTS_PER_LEG
    if isinstance(gait, PostureTable):
        rows = tuple(_row(key, 0, angles) for key, angles in sorted(gait.postures.items()))
        return FileTable(kind="postures", legs=legs, rows=rows)
    rows = tuple(
        _row(key, index, angles)
        for key, sequence in enumerate(gait.sequences)
        for index, angles in enumerate(sequence)
    )
    return FileTable(kind="locomotion", legs=legs, rows=rows)


def gait_of(table: FileTable, name: str) -> PostureTable | LocomotionTable:
    """Make a gait from the table of a page.

    Args:
        table: the table.
        name: name of the table's file, for messages.

    Raises:
        FileRefused: with every mistake; its row and column are counted as in a file.
        UserError: if a locomotion table has no row of a key below its highest key.
    """
    cells = _posture_cells(table) if table.kind == "postures" else _locomotion_cells(table)
    rows = [Row(number, row) for number, row in enumerate(cells, start=1)]
    return read_cells(rows, name, legs=table.legs)


def _row(key: int, index: int, angles: Posture) -> FileRow:
    return FileRow(key=key, posture=index, angles_deg=tuple(map(degrees_of, angles)))


def _posture_cells(table: FileTable) -> list[list[str]]:
    header = ["Num of Posture", str(len(table.rows))]
    return [header, *([f"{row.key} Key", *_texts(row)] for row in table.rows)]


def _locomotion_cells(table: FileTable) -> list[list[str]]:
    rows = sorted(table.rows, key=lambda row: (row.key, row.posture))
    keys = {key: list(group) for key, group in groupby(rows, key=lambda row: row.key)}
    missing = sorted({*range(max(keys, default=0) + 1)} - keys.keys())
    if missing:
        raise UserError(say("design.missing-key", key=missing[0]))
    cells = [[str(len(keys))]]
    for group in keys.values():
        cells += [[str(len(group))], *map(_texts, group)]
    return cells


def _texts(row: FileRow) -> list[str]:
    return [number_text(angle) for angle in row.angles_deg]
