"""Reads the content of the sheet in a Loco-data workbook, with openpyxl.

A workbook is a zip of XML files. It stores texts, formulas and formats once, and cells refer to
them many times. So a small file can need endless memory or time. The known ways to do this are
counted before openpyxl reads the file; against all others the process has limits
(`workbook.apart`).
"""

import io
import re
import warnings
import zipfile
from datetime import date, time, timedelta
from enum import StrEnum
from typing import Any
from xml.parsers import expat

import msgspec

from lacoc_shared.gait.cells import narrow, number_text
from lacoc_shared.gait.workbook import INPUT_SHEET, MIRROR_SHEET
from lacoc_shared.mistakes import FileRefused, Mistake, printable
from lacoc_shared.words import Phrase, say

MAX_BYTES = 1024 * 1024
COMPOUND_FILE = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
"""First bytes of an .xls file, and of a workbook with a password."""

_MAX_UNPACKED_BYTES = 8 * MAX_BYTES  # a sheet of angles needs a hundredth of it
_MAX_PARTS = 200  # files in the zip; a workbook has a dozen
_MAX_ELEMENTS = 50_000  # XML elements in all files together; a table has two thousand
_COSTS = {"xf": 10, "numFmt": 10, "sheet": 1000, "definedName": 10}
"""Elements that openpyxl compares with one another, and the number as which each counts."""
_MAX_ATTRIBUTE = 8192  # characters; Excel writes formats of at most 255
_MAX_FORMULAS = 250_000  # characters of all cells' formulas; our own mirror sheet has 15,000
_MAX_TEXT = 200  # characters of a cell; a message shows fewer, and no angle has so many
_MAX_ROWS, _MAX_COLUMNS = 1000, 100  # the rest is not read; a table has 14 rows, 25 columns
_STRICT = re.compile(rb"http://purl\.oclc\.org/ooxml/(\w+)/")
"""Namespaces of the kind "Strict Open XML" (ISO 29500); openpyxl can only read the older ones."""
_OTHERS = {
    "content.xml": say("gait.opendocument"),
    "word/document.xml": say("gait.word-document"),
    "ppt/presentation.xml": say("gait.presentation"),
    "xl/workbook.bin": say("gait.binary-workbook"),
}
"""Name of a file that only another kind of document has in its zip -> that kind of document."""
_WANTED = say("gait.workbook")


class Odd(StrEnum):
    """What may be odd about a cell that should hold an angle."""

    UNCALCULATED = "uncalculated"
    """The cell has a formula without a stored value."""
    DATE = "date"
    """The cell is shown as a date or a time."""
    PERCENT = "percent"
    """The cell is shown as a percentage."""


class WorkbookSheet(msgspec.Struct, frozen=True):
    """The cells of a workbook's sheet as text, as far as LACOC reads them."""

    title: str
    rows: list[list[str]]
    """The rows in order; the first one is row 1."""
    odd: list[tuple[int, int, Odd]]
    """Row and column of each odd cell, counted from 1."""


def read_sheet(data: bytes, name: str) -> WorkbookSheet:
    """Read the sheet of a workbook that has the gait.

    Args:
        data: the .xlsx file.
        name: the file's name, for error messages.

    Raises:
        FileRefused: if the file is no such workbook, or needs too much memory or time.
    """
    data = _harmless(data, name)
    try:
        with warnings.catch_warnings(action="ignore"):  # openpyxl warns about unknown styles
            return _sheet(data, name)
    except FileRefused:
        raise
    except MemoryError:
        raise refused(name, say("gait.too-costly"), say("gait.table")) from None
    except Exception:  # on a broken workbook openpyxl may raise any exception
        raise refused(name, say("gait.unreadable-workbook"), _WANTED) from None


def refused(name: str, found: Phrase, expected: Phrase) -> FileRefused:
    """Make the error that refuses a whole workbook: what was found in it, and what was expected."""
    return FileRefused([Mistake(file=name, found=found, expected=expected)])


def _harmless(data: bytes, name: str) -> bytes:
    """Check a workbook's zip before it is unpacked, and its XML before openpyxl reads it.

    Returns:
        The workbook, in the form that openpyxl reads.

    Raises:
        FileRefused: if it is not a zip, has a password, or needs too much memory or time.
    """
    if len(data) > MAX_BYTES:
        found = say("gait.more-bytes", most=MAX_BYTES)
        raise refused(name, found, say("gait.workbook-mib", most=MAX_BYTES // 1024**2))
    if data.startswith(COMPOUND_FILE):
        raise refused(name, say("gait.xls"), _WANTED)
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            parts = archive.infolist()
            if sum(part.file_size for part in parts) > _MAX_UNPACKED_BYTES:
                most_mib = _MAX_UNPACKED_BYTES // 1024**2
                found = say("gait.unpacks-large", most=most_mib)
                raise refused(name, found, say("gait.table"))
            if any(part.flag_bits & 1 for part in parts):
                raise refused(name, say("gait.password"), _WANTED)
            packed = {part.compress_type for part in parts}
            for part in parts:
                if (other := _OTHERS.get(part.filename)) is not None:
                    raise refused(name, other, say("gait.as-workbook"))
            if len(parts) > _MAX_PARTS or packed - {zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED}:
                raise refused(name, say("gait.zip"), _WANTED)
            content = {part.filename: archive.read(part) for part in parts}
        counter = _Counter()
        for part_content in content.values():
            counter.look_at(part_content)
    except FileRefused:
        raise
    except _TooMuchError as error:
        raise refused(name, error.found, say("gait.table")) from None
    except Exception:  # for a damaged list of contents zipfile raises more than BadZipFile
        raise refused(name, say("gait.damaged"), _WANTED) from None
    return _transitional(content) if any(map(_STRICT.search, content.values())) else data


def _transitional(content: dict[str, bytes]) -> bytes:
    """Return a workbook with the usual namespaces in place of the strict ones of ISO 29500."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for name, part in content.items():
            archive.writestr(
                name, _STRICT.sub(rb"http://schemas.openxmlformats.org/\1/2006/", part)
            )
    return stream.getvalue()


class _TooMuchError(Exception):
    """Raised when a part of a workbook is too large or forbidden; `found` says which."""

    def __init__(self, found: Phrase) -> None:
        super().__init__()
        self.found = found


class _Counter:
    """Counts the work that a workbook makes for openpyxl: elements, attributes and formulas."""

    def __init__(self) -> None:
        self._elements = _MAX_ELEMENTS
        self._formulas = _MAX_FORMULAS
        self._shared: dict[str, int] = {}
        """Length of each shared formula in this part, by the formula's number."""
        self._formula: str | None = None
        """Number of the shared formula that is being read; "": a formula that is not shared; None:
        no formula."""
        self._length = 0
        """Number of characters of the formula so far."""

    def look_at(self, part: bytes) -> None:
        """Count the work in one XML file of the workbook; if it is invalid, up to the error.

        Raises:
            _TooMuchError: if there is too much of something, or a document type, which can define
                entities.
        """
        self._shared, self._formula, self._length = {}, None, 0
        parser = expat.ParserCreate()
        parser.StartElementHandler = self._begin
        parser.EndElementHandler = self._end
        parser.CharacterDataHandler = self._text
        parser.StartDoctypeDeclHandler = self._doctype
        try:
            parser.Parse(part, True)
        except expat.ExpatError:
            return

    def _begin(self, name: str, attributes: dict[str, str]) -> None:
        name = name.rpartition(":")[2]
        self._elements -= _COSTS.get(name, 1) + len(attributes) // 8
        if self._elements < 0:
            raise _TooMuchError(say("gait.many-elements", most=_MAX_ELEMENTS))
        if any(len(value) > _MAX_ATTRIBUTE for value in attributes.values()):
            raise _TooMuchError(say("gait.too-costly"))
        if name == "f":
            self._formula, self._length = attributes.get("si", ""), 0

    def _text(self, text: str) -> None:
        self._length += len(text)

    def _end(self, name: str) -> None:
        if self._formula is None or name.rpartition(":")[2] != "f":
            return
        if self._formula:  # the first cell has the text, and openpyxl writes it for all others
            self._length = self._shared.setdefault(self._formula, self._length)
        self._formulas -= self._length
        self._formula = None
        if self._formulas < 0:
            raise _TooMuchError(say("gait.long-formulas", most=_MAX_FORMULAS))

    def _doctype(self, *_: Any) -> None:
        raise _TooMuchError(say("gait.entities"))


def _sheet(data: bytes, name: str) -> WorkbookSheet:
    """Read the cells of the sheet that has the gait: values, and formulas without a value."""
    import openpyxl  # only the process that reads needs it

    books = [
        openpyxl.load_workbook(
            io.BytesIO(data), read_only=True, data_only=data_only, keep_links=False
        )
        for data_only in (True, False)
    ]
    title = _title(books[0].sheetnames, name)
    values, formulas = (
        book[title].iter_rows(max_row=_MAX_ROWS, max_col=_MAX_COLUMNS) for book in books
    )
    cells = [
        [(value, formula.value) for value, formula in zip(*pair, strict=True)]
        for pair in zip(values, formulas, strict=True)
    ]
    # Programs store the values of all formulas or of none. An empty value looks like a missing one.
    calculated = any(
        cell.value is not None and str(formula).startswith("=")
        for row in cells
        for cell, formula in row
    )
    rows, odd = [], []
    for number, row in enumerate(cells, start=1):
        rows.append([_text(cell.value, None if calculated else formula) for cell, formula in row])
        odd += [
            (number, column, kind)
            for column, (cell, formula) in enumerate(row, start=1)
            if (kind := _kind(cell, None if calculated else formula)) is not None
        ]
    return WorkbookSheet(title, rows, odd)


def _title(titles: list[str], name: str) -> str:
    """Return the title of the sheet that has the gait.

    Spaces, full-width letters and capitals make no difference.
    """
    plain = {"".join(narrow(title).split()).casefold(): title for title in reversed(titles)}
    wanted = INPUT_SHEET if len(titles) > 1 else MIRROR_SHEET
    for one in (wanted, INPUT_SHEET):
        if (found := plain.get("".join(one.split()).casefold())) is not None:
            return found
    found_titles = say("gait.sheets", sheets=[printable(title) for title in titles[:10]])
    raise refused(name, found_titles, say("gait.sheet", sheet=INPUT_SHEET, other=MIRROR_SHEET))


def _kind(cell: Any, formula: object) -> Odd | None:
    match cell.value:
        case None:
            return None if formula is None else Odd.UNCALCULATED
        case date() | time() | timedelta():
            return Odd.DATE
        case int() | float() if "%" in cell.number_format:
            return Odd.PERCENT
        case _:
            return None


def _text(value: object, formula: object) -> str:
    """Return a cell's value as text; if no value was stored, its formula."""
    match value:
        case None:
            return "" if formula is None else str(formula)[:_MAX_TEXT]
        case bool():
            return str(value).upper()
        case int() | float():
            return number_text(value)
        case _:
            return narrow(str(value)[:_MAX_TEXT])
