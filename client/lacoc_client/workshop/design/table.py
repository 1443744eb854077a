"""A gait as a table of the page /design: rows of angles in degrees, sorted by key."""

from collections.abc import Sequence
from itertools import groupby
from typing import Annotated, Literal

import msgspec

from lacoc_robots.library import GAIT_NAMES
from lacoc_shared.gait.cells import MAX_KEYS, MAX_POSTURES_PER_KEY, Row, degrees_of, number_text
from lacoc_shared.gait.reader import read_cells
from lacoc_shared.gait.tables import JOINTS_PER_LEG, Level, LocomotionTable, Posture, PostureTable
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

Kind = Literal["postures", "locomotion"]
"""Kind of a table: postures (level A) or locomotion (level B)."""
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

    kind: Kind
    legs: Annotated[int, msgspec.Meta(ge=1, le=_MOST_LEGS)]
    rows: Annotated[tuple[FileRow, ...], msgspec.Meta(max_length=MAX_KEYS * MAX_POSTURES_PER_KEY)]

    @property
    def file_name(self) -> str:
        """The usual name of a text file of this kind of table, as "Loco-data.txt" (rules 2)."""
        return file_name_of(self.kind)


def file_name_of(kind: Kind) -> str:
    """Return the usual name of a text file of this kind of table, as "Loco-data.txt" (rules 2)."""
    return GAIT_NAMES[Level.POSTURE if kind == "postures" else Level.LOCOMOTION]


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
    if table.kind == "locomotion":
        keys = {row.key for row in table.rows}
        missing = sorted({*range(max(keys, default=0) + 1)} - keys)
        if missing:
            raise UserError(say("design.missing-key", key=missing[0]))
        ordered = sorted(table.rows, key=lambda row: (row.key, row.posture))
    else:
        ordered = list(table.rows)
    cells = file_cells(table.kind, [(row.key, _texts(row)) for row in ordered])
    rows = [Row(number, row) for number, row in enumerate(cells, start=1)]
    return read_cells(rows, name, legs=table.legs)


def file_cells(kind: Kind, rows: Sequence[tuple[int, list[str]]]) -> list[list[str]]:
    """Return the cells of a gait file without a legend.

    Args:
        kind: the kind of the table.
        rows: the key and the cells of each row, in order; rows of one key stand together.
    """
    if kind == "postures":
        header = ["Num of Posture", str(len(rows))]
        return [header, *([f"{key} Key", *cells] for key, cells in rows)]
    keys = [[cells for _, cells in group] for _, group in groupby(rows, key=lambda row: row[0])]
    found = [[str(len(keys))]]
    for group in keys:
        found += [[str(len(group))], *group]
    return found


def _row(key: int, index: int, angles: Posture) -> FileRow:
    return FileRow(key=key, posture=index, angles_deg=tuple(map(degrees_of, angles)))


def _texts(row: FileRow) -> list[str]:
    return [number_text(angle) for angle in row.angles_deg]
