"""Reads and writes gait files that are workbooks, and tells them from gait files that are text."""

import io
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path

import msgspec
import xlsxwriter
from xlsxwriter.utility import xl_rowcol_to_cell

from lacoc_shared.gait.cells import RANGE_DEG, Row, posture_cells
from lacoc_shared.gait.legend import KEY
from lacoc_shared.gait.reader import POSTURES_HEADER, Legs, Range, read_cells
from lacoc_shared.gait.tables import LocomotionTable, PostureTable
from lacoc_shared.gait.text import read_gait
from lacoc_shared.gait.workbook.apart import read_sheet_apart
from lacoc_shared.gait.workbook.content import COMPOUND_FILE, MAX_BYTES, Odd, WorkbookSheet, refused
from lacoc_shared.gait.workbook.look import add_sheets
from lacoc_shared.mistakes import FileRefused, Mistake, UserError
from lacoc_shared.words import Phrase, say

_ZIP = b"PK\x03\x04"


def read_gait_file(
    path: Path,
    *,
    legs: Legs = None,
    range_deg: Range = RANGE_DEG,
    notes: list[Phrase] | None = None,
) -> PostureTable | LocomotionTable:
    """Read any gait file, text or workbook; its content shows which, not its name.

    Args:
        path: the file.
        legs: the robot that the gait must fit; see `text.read_gait`.
        range_deg: range of the angles; see `text.read_gait`.
        notes: list that remarks are appended to: not mistakes, but perhaps not intended.

    Raises:
        FileRefused: with every mistake in the file.
        UserError: if the file can't be opened.
    """
    try:
        with path.open("rb") as file:
            data = file.read(MAX_BYTES + 1)
    except OSError as error:
        raise UserError(
            say("command.cannot-read", path=str(path), why=error.strerror or str(error))
        ) from error
    read = read_workbook if is_workbook(data) else read_gait
    return read(data, path.name, legs=legs, range_deg=range_deg, notes=notes)


def is_workbook(data: bytes) -> bool:
    """Return whether a gait file is a workbook and not text; it may be broken or of another kind.

    Args:
        data: the file, or its first bytes.
    """
    return data.startswith((_ZIP, COMPOUND_FILE))


def read_workbook(
    data: bytes,
    name: str,
    *,
    legs: Legs = None,
    range_deg: Range = RANGE_DEG,
    notes: list[Phrase] | None = None,
) -> PostureTable:
    """Read the postures of a workbook: the values of its sheet "EX (input)".

    Args:
        data: the .xlsx file, at most 1 MiB. If "Loco-data" is the only sheet, it is read.
        name: the file's name, for error messages.
        legs: the robot that the gait must fit; see `text.read_gait`.
        range_deg: range of the angles; see `text.read_gait`.
        notes: list that remarks are appended to: not mistakes, but perhaps not intended.

    Raises:
        FileRefused: with every mistake in the file; a mistake in a cell names the cell.
    """
    sheet = read_sheet_apart(data, name)
    odd = {(row, column): kind for row, column, kind in sheet.odd}
    try:
        table = read_cells(
            sheet_rows(sheet),
            name,
            legs=legs,
            range_deg=range_deg,
            headers=POSTURES_HEADER,
            notes=notes,
        )
    except FileRefused as error:
        raise FileRefused([_at_cell(one, sheet.title, odd) for one in error.mistakes]) from None
    if isinstance(table, LocomotionTable):
        raise refused(name, say("gait.sequences"), say("gait.workbook-header"))
    percent = [place for place in odd if odd[place] is Odd.PERCENT and _is_angle(sheet, place)]
    if notes is not None and percent:
        cell = _cell_name(sheet.title, *percent[0])
        found = sheet.rows[percent[0][0] - 1][percent[0][1] - 1]
        notes.append(say("gait.percent-cell", file=name, cell=cell, number=found))
    return table


def sheet_rows(sheet: WorkbookSheet) -> list[Row]:
    """Return the rows of a workbook's sheet, as `reader` takes them."""
    return [Row(number, row) for number, row in enumerate(sheet.rows, start=1)]


def write_workbook(table: PostureTable, legs: Sequence[str]) -> bytes:
    """Write postures as a workbook, ready to edit; spreadsheets keep 15 digits of a number.

    Args:
        table: the postures.
        legs: labels of the robot's legs, for the legend.

    Raises:
        ValueError: if the table is not for a robot with these legs.
    """
    cells = posture_cells(table, legs)
    stream = io.BytesIO()
    texts = {"strings_to_formulas": False, "strings_to_urls": False}  # labels come from anybody
    with xlsxwriter.Workbook(stream, {"in_memory": True, **texts}) as book:
        # The date is fixed, so that the same table always gives the same file.
        book.set_properties({"title": "Loco-data", "created": datetime(2020, 1, 1, tzinfo=UTC)})
        add_sheets(book, cells, len(legs))
    return stream.getvalue()


def _is_angle(sheet: WorkbookSheet, place: tuple[int, int]) -> bool:
    row, column = place
    return column > 1 and KEY.fullmatch(sheet.rows[row - 1][0].strip()) is not None


def _cell_name(title: str, row: int, column: int) -> str:
    return f"{title}!{xl_rowcol_to_cell(row - 1, column - 1)}"


def _at_cell(mistake: Mistake, title: str, odd: Mapping[tuple[int, int], Odd]) -> Mistake:
    """Add to a mistake the name of the workbook's cell, and what is odd about the cell."""
    if mistake.row is None or mistake.column is None:
        return msgspec.structs.replace(mistake, field=title)
    found = mistake.found
    match odd.get((mistake.row, mistake.column)):
        case Odd.UNCALCULATED:
            found = say("gait.uncalculated-cell", formula=found)
        case Odd.DATE:
            found = say("gait.date-cell", date=found)
    cell = _cell_name(title, mistake.row, mistake.column)
    return msgspec.structs.replace(mistake, field=cell, found=found)
