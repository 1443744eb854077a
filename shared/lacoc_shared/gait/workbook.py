"""Loco-data.xlsx: postures in a workbook (workshop 4-1 and Fig. 4-1, rules 2).

People edit the sheet "EX (input)". "Loco-data" shows the same cells by formulas; a spreadsheet
program can save it as text. LACOC reads the edited sheet itself.
"""

import io
import warnings
import zipfile
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any
from xml.parsers import expat

import msgspec
import openpyxl
import xlsxwriter
from openpyxl.utils import get_column_letter

from lacoc_shared.gait.cells import RANGE_DEG, Row, narrow, number_text, posture_cells
from lacoc_shared.gait.reader import POSTURES_HEADER, Legs, Range, read_cells
from lacoc_shared.gait.sheets import INPUT_SHEET, MIRROR_SHEET, add_sheets
from lacoc_shared.gait.tables import LocomotionTable, PostureTable
from lacoc_shared.gait.text import read_gait
from lacoc_shared.mistakes import FileRefused, Mistake, UserError, printable
from lacoc_shared.words import Phrase, say

MAX_BYTES = 1024 * 1024

_MAX_UNPACKED_BYTES = 8 * MAX_BYTES  # a sheet of angles needs a hundredth of it
_MAX_PARTS = 200  # files in the zip; a workbook has a dozen
_MAX_ELEMENTS = 50_000  # XML elements in all files together; a table has two thousand
_MAX_ROWS, _MAX_COLUMNS = 1000, 100  # the rest is not read; a table has 14 rows, 25 columns
_ZIP = b"PK\x03\x04"
_COMPOUND_FILE = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"  # .xls, or a workbook with a password
_OTHERS = {
    "content.xml": say("gait.opendocument"),
    "word/document.xml": say("gait.word-document"),
    "ppt/presentation.xml": say("gait.presentation"),
    "xl/workbook.bin": say("gait.binary-workbook"),
}
"""A file in the zip that identifies another kind of document -> the name of that kind."""
_WANTED = say("gait.workbook")


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
        legs: the robot that it must fit; see `text.read_gait`.
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
    return data.startswith((_ZIP, _COMPOUND_FILE))


def read_workbook(
    data: bytes,
    name: str,
    *,
    legs: Legs = None,
    range_deg: Range = RANGE_DEG,
    notes: list[Phrase] | None = None,
) -> PostureTable:
    """Read a Loco-data workbook: the values of its sheet "EX (input)".

    Args:
        data: the .xlsx file, at most 1 MiB. If "Loco-data" is the only sheet, it is read.
        name: the file's name, for error messages.
        legs: the robot that it must fit; see `text.read_gait`.
        range_deg: range of the angles; see `text.read_gait`.
        notes: list that remarks are appended to: not mistakes, but perhaps not intended.

    Raises:
        FileRefused: with every mistake in the file; a mistake in a cell names the cell.
    """
    sheet, rows = sheet_rows(data, name)
    try:
        table = read_cells(
            rows, name, legs=legs, range_deg=range_deg, headers=POSTURES_HEADER, notes=notes
        )
    except FileRefused as error:
        raise FileRefused([_at_cell(mistake, sheet) for mistake in error.mistakes]) from None
    if isinstance(table, LocomotionTable):
        raise _refused(name, say("gait.sequences"), say("gait.workbook-header"))
    return table


def sheet_rows(data: bytes, name: str) -> tuple[str, list[Row]]:
    """Return the title and the rows of the sheet that has the gait.

    Args:
        data: the .xlsx file.
        name: the file's name, for error messages.

    Raises:
        FileRefused: if the file is no such workbook, or needs too much memory or time.
    """
    _require_harmless(data, name)
    try:
        with warnings.catch_warnings(action="ignore"):  # openpyxl warns about unknown styles
            return _sheet(data, name)
    except FileRefused:
        raise
    except Exception:  # on a broken workbook openpyxl may raise any exception
        raise _refused(name, say("gait.unreadable-workbook"), _WANTED) from None


def write_workbook(table: PostureTable, legs: Sequence[str]) -> bytes:
    """Write a Loco-data workbook, ready to edit; spreadsheets keep 15 digits of a number.

    Args:
        table: the postures.
        legs: labels of the robot's legs, for the legend.

    Raises:
        ValueError: if the table is not for a robot with these legs.
    """
    cells = posture_cells(table, legs)
    stream = io.BytesIO()
    with xlsxwriter.Workbook(stream, {"in_memory": True}) as book:
        # The date is fixed, so that the same table always gives the same file.
        book.set_properties({"title": "Loco-data", "created": datetime(2020, 1, 1, tzinfo=UTC)})
        add_sheets(book, cells, len(legs))
    return stream.getvalue()


def _require_harmless(data: bytes, name: str) -> None:
    """Check the zip's list of files before it is unpacked, and the XML before openpyxl reads it.

    Raises:
        FileRefused: if it is not a zip, has a password, or needs too much memory or time.
    """
    if len(data) > MAX_BYTES:
        found = say("gait.more-bytes", most=MAX_BYTES)
        raise _refused(name, found, say("gait.workbook-mib", most=MAX_BYTES // 1024**2))
    if data.startswith(_COMPOUND_FILE):
        raise _refused(name, say("gait.xls"), _WANTED)
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            parts = archive.infolist()
            if sum(part.file_size for part in parts) > _MAX_UNPACKED_BYTES:
                most_mib = _MAX_UNPACKED_BYTES // 1024**2
                found = say("gait.unpacks-large", most=most_mib)
                raise _refused(name, found, say("gait.table"))
            if any(part.flag_bits & 1 for part in parts):
                raise _refused(name, say("gait.password"), _WANTED)
            packed = {part.compress_type for part in parts}
            for part in parts:
                if (other := _OTHERS.get(part.filename)) is not None:
                    raise _refused(name, other, say("gait.as-workbook"))
            if len(parts) > _MAX_PARTS or packed - {zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED}:
                raise _refused(name, say("gait.zip"), _WANTED)
            counter = _ElementCounter()
            for part in parts:
                counter.look_at(archive.read(part))
    except FileRefused:
        raise
    except _TooMuchXmlError as error:
        raise _refused(name, error.found, say("gait.table")) from None
    except Exception:  # for a damaged list of contents zipfile raises more than BadZipFile
        raise _refused(name, say("gait.damaged"), _WANTED) from None


class _TooMuchXmlError(Exception):
    """The XML is not harmless; `found` says what is too large or forbidden in it."""

    def __init__(self, found: Phrase) -> None:
        super().__init__()
        self.found = found


class _ElementCounter:
    """Counts the XML elements of a workbook, because openpyxl makes objects for each."""

    def __init__(self) -> None:
        self._left = _MAX_ELEMENTS

    def look_at(self, part: bytes) -> None:
        """Count the elements of one file; a file that is not valid XML is read up to the error.

        Raises:
            _TooMuchXmlError: if there are too many elements, or entities are defined.
        """
        parser = expat.ParserCreate()
        parser.StartElementHandler = self._element
        parser.StartDoctypeDeclHandler = self._doctype
        try:
            parser.Parse(part, True)
        except expat.ExpatError:
            return

    def _element(self, name: str, attributes: dict[str, str]) -> None:
        self._left -= 1 + len(attributes) // 8
        if self._left < 0:
            raise _TooMuchXmlError(say("gait.many-elements", most=_MAX_ELEMENTS))

    def _doctype(self, *_: Any) -> None:
        raise _TooMuchXmlError(say("gait.entities"))


def _sheet(data: bytes, name: str) -> tuple[str, list[Row]]:
    """Return the name and the rows of the sheet to read."""
    books = [
        openpyxl.load_workbook(
            io.BytesIO(data), read_only=True, data_only=data_only, keep_links=False
        )
        for data_only in (True, False)
    ]
    names = books[0].sheetnames
    sheet = MIRROR_SHEET if names == [MIRROR_SHEET] else INPUT_SHEET
    if sheet not in names:
        found = say("gait.sheets", sheets=[printable(title) for title in names[:10]])
        raise _refused(name, found, say("gait.sheet", sheet=INPUT_SHEET, other=MIRROR_SHEET))
    values, formulas = (
        book[sheet].iter_rows(max_row=_MAX_ROWS, max_col=_MAX_COLUMNS, values_only=True)
        for book in books
    )
    rows = [list(zip(*pair, strict=True)) for pair in zip(values, formulas, strict=True)]
    # Programs store the values of all formulas or of none. An empty value looks like a missing one.
    calculated = any(
        value is not None and str(formula).startswith("=") for row in rows for value, formula in row
    )
    return sheet, [
        Row(number, [_text(value, None if calculated else formula) for value, formula in row])
        for number, row in enumerate(rows, start=1)
    ]


def _text(value: object, formula: object) -> str:
    """Return a cell as text; "uncalculated" and the formula if no value was stored."""
    match value:
        case None:
            return "" if formula is None else f"uncalculated {formula}"
        case bool():
            return str(value).upper()
        case int() | float():
            return number_text(value)
        case _:
            return narrow(str(value))


def _at_cell(mistake: Mistake, sheet: str) -> Mistake:
    if mistake.row is None or mistake.column is None:
        return msgspec.structs.replace(mistake, field=sheet)
    cell = f"{sheet}!{get_column_letter(mistake.column)}{mistake.row}"
    return msgspec.structs.replace(mistake, field=cell)


def _refused(name: str, found: Phrase, expected: Phrase) -> FileRefused:
    return FileRefused([Mistake(file=name, found=found, expected=expected)])
