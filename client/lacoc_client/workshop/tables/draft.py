"""The newest table of a student, with everything that is needed to let a robot walk with it."""

from collections.abc import Mapping
from typing import NamedTuple

import msgspec

from lacoc_client.workshop.design.files import sent_gait
from lacoc_client.workshop.design.table import FileRow, FileTable, Kind, file_cells, file_name_of
from lacoc_client.workshop.tables.entries import PLACE, SHAPE, Entry, RobotEntry, json_entry
from lacoc_robots.seat_files import USUAL_NAMES, SeatFiles, with_level_b
from lacoc_shared.gait.cells import number_text
from lacoc_shared.gait.tables import JOINTS_PER_LEG
from lacoc_shared.messages import SentFile
from lacoc_shared.mistakes import FileRefused, UserError

UNFINISHED = "unfinished-"
"""Begins the name of the file of a table with an empty cell or a mistake."""
_KINDS: dict[str, Kind] = {"p": "postures", "l": "locomotion"}


class Draft(msgspec.Struct, frozen=True, kw_only=True):
    """A table with an angle in each cell, with its keys and its robot."""

    table: FileTable
    sequences: tuple[tuple[int, ...], ...] | None = None
    robot: SentFile | None = None
    """The robot file; None: the workshop's robot."""

    def files(self) -> SeatFiles:
        """Return the files with which the draft can play: robot, postures and locomotion.

        There is no locomotion file if keys use postures that the table does not have.

        Raises:
            FileRefused: with every mistake of the table.
            UserError: if a locomotion table has no row of a key below its highest key.
        """
        gait = sent_gait(self.table)
        if self.table.kind == "locomotion":
            return SeatFiles(self.robot, None, gait)
        files = SeatFiles(self.robot, gait)
        try:
            return with_level_b(files, self.sequences)
        except UserError:
            return files


def draft_of(entries: Mapping[str, Entry]) -> Draft | None:
    """Return a document's table, keys and robot.

    None: it has no rows, a cell has no angle, or it has more rows than a `FileTable` may have.
    """
    table = _table(entries)
    if table is None:
        return None
    return Draft(table=table, sequences=_sequences(entries, table), robot=_robot_in(entries))


def files_of(entries: Mapping[str, Entry]) -> dict[str, bytes]:
    """Return the gait and robot files that a document stands for, by their usual names.

    A table with an empty cell or a mistake becomes a text file of its angles, under a name that
    says so; a cell without an angle is empty in it.
    """
    draft = draft_of(entries)
    try:
        files = None if draft is None else draft.files()
    except (FileRefused, UserError):
        files = None
    named = dict(zip(USUAL_NAMES, files or (_robot_in(entries), None, None), strict=True))
    found = {name: file.data for name, file in named.items() if file is not None}
    table = _cells_in(entries)
    if files is None and table.rows:
        rows = [(row.key, [_text(cell) for cell in row.cells]) for row in table.rows]
        lines = ["\t".join(cells) for cells in file_cells(table.kind, rows)]
        found[UNFINISHED + file_name_of(table.kind)] = "".join(f"{one}\n" for one in lines).encode()
    return found


class _RowOfCells(NamedTuple):
    key: int
    cells: list[Entry | None]


class _TableCells(NamedTuple):
    """The rows of a document's table, with whatever is in their cells."""

    kind: Kind
    legs: int
    rows: list[_RowOfCells]


def _cells_in(entries: Mapping[str, Entry]) -> _TableCells:
    shape = str(entries.get("shape", ""))
    found = SHAPE.fullmatch(shape)
    if found is None:
        return _TableCells("postures", 0, [])
    kind, legs = _KINDS[found[1]], int(found[2])
    places = sorted(
        (int(place[4]), float(place[5].replace("_", ".")), place[0])
        for place in map(PLACE.fullmatch, entries)
        if place is not None and place[1] == shape and place[6] is None
    )
    joints = range(JOINTS_PER_LEG * legs)
    rows = [
        _RowOfCells(key, [entries.get(f"{name}/{joint}") for joint in joints])
        for key, _, name in places
    ]
    return _TableCells(kind, legs, rows)


def _text(cell: Entry | None) -> str:
    return number_text(cell) if isinstance(cell, float) else ""


def _table(entries: Mapping[str, Entry]) -> FileTable | None:
    kind, legs, cells = _cells_in(entries)
    rows = []
    for row in cells:
        angles = tuple(cell for cell in row.cells if isinstance(cell, float))
        if len(angles) < len(row.cells):
            return None
        rows.append(FileRow(key=row.key, angles_deg=angles))
    if not rows:
        return None
    numbered = _numbered(rows) if kind == "locomotion" else tuple(rows)
    table = FileTable(kind=kind, legs=legs, rows=numbered)
    try:
        # Nobody could decode a table beyond its limits, also not the class at its next start.
        return msgspec.convert(msgspec.to_builtins(table), FileTable)
    except msgspec.ValidationError:
        return None


def _numbered(rows: list[FileRow]) -> tuple[FileRow, ...]:
    """Number keys and postures anew, without gaps.

    There are gaps if one page has removed keys while another one added some.
    """
    keys = sorted({row.key for row in rows})
    counts = dict.fromkeys(keys, 0)
    numbered = []
    for row in rows:
        numbered.append(
            msgspec.structs.replace(row, key=keys.index(row.key), posture=counts[row.key])
        )
        counts[row.key] += 1
    return tuple(numbered)


def _sequences(
    entries: Mapping[str, Entry], table: FileTable
) -> tuple[tuple[int, ...], ...] | None:
    """Return the digits of each key of level B; None: the table has them, or nobody chose any.

    A key without postures, or with one that the table lacks, gets only the table's first posture.
    """
    keys = entries.get("keys")
    if table.kind == "locomotion" or not isinstance(keys, str):
        return None
    known = {row.key for row in table.rows}
    found = []
    for digits in keys.split(","):
        sequence = tuple(int(digit) for digit in digits if digit in "0123456789")
        fits = sequence and known.issuperset(sequence)
        found.append(sequence if fits else (table.rows[0].key,))
    return tuple(found)


def _robot_in(entries: Mapping[str, Entry]) -> SentFile | None:
    robot = json_entry(str(entries.get("robot", "")), RobotEntry)
    return None if robot is None else SentFile(robot.name, robot.text.encode())
