"""Gait files that are text: postures (Loco-data.txt) and locomotion (LocoTra-data*.txt)."""

import codecs
import re
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from lacoc_shared.gait.cells import (
    RANGE_DEG,
    Row,
    locomotion_cells,
    narrow,
    number_text,
    posture_cells,
)
from lacoc_shared.gait.reader import Legs, Range, read_cells
from lacoc_shared.gait.tables import LocomotionTable, PostureTable
from lacoc_shared.mistakes import FileRefused, Mistake
from lacoc_shared.words import Phrase, say

MAX_BYTES = 32 * 1024
_MAX_ROWS = 1200  # a gait has at most 1011, and there may be lines of remarks

_BOMS = (
    (codecs.BOM_UTF8, "utf-8"),
    (codecs.BOM_UTF16_LE, "utf-16-le"),
    (codecs.BOM_UTF16_BE, "utf-16-be"),
)
_PATH_BEGIN = b"time_s"
"""Beginning of the header row of Pos-data.txt (rules 2)."""
LINE_END = re.compile(r"\r\n|\r|\n")
# Cells of a row without tabs: labels with spaces, quoted cells, and words between spaces.
_SPACED_CELL = re.compile(
    r"(?i:^\s*(?:num of postures?|id of joint|\d+ *key))(?!\S)|\"(?:[^\"]|\"\")*\"|\S+"
)


def read_gait(
    data: bytes,
    name: str,
    *,
    legs: Legs = None,
    range_deg: Range = RANGE_DEG,
    notes: list[Phrase] | None = None,
) -> PostureTable | LocomotionTable:
    """Read a gait file that is text: postures (Loco-data) or locomotion (LocoTra-data).

    The first cell of the file shows which of the two it is.

    Args:
        data: the file, at most 32 KiB, in UTF-8, UTF-16 or Shift-JIS.
        name: the file's name, for error messages.
        legs: the robot that the gait must fit: the labels of its legs in order, or their number.
            None: any robot with 4, 6 or 8 legs.
        range_deg: range of the angles: one bound for all, or (lowest, highest) of each joint.
        notes: list that remarks are appended to: not mistakes, but perhaps not intended.

    Raises:
        FileRefused: with every mistake in the file; nothing is clamped or skipped.
    """
    # Checked first: Pos-data lies in the same folder, and soon exceeds the size limit of gaits.
    if data.startswith(_PATH_BEGIN):
        raise _refused(name, say("gait.path"), say("gait.gait"))
    lines = LINE_END.split(narrow(decoded(data, name).text))
    filled = [(number, line) for number, line in enumerate(lines, start=1) if line.strip()]
    if len(filled) > _MAX_ROWS:
        found = say("gait.rows", count=len(filled))
        raise _refused(name, found, say("gait.most-rows", most=_MAX_ROWS))
    rows = [Row(number, line_cells(line)) for number, line in filled]
    try:
        return read_cells(rows, name, legs=legs, range_deg=range_deg, notes=notes)
    except FileRefused:
        if _is_csv(line for _, line in filled):
            raise _refused(name, say("gait.csv"), say("gait.tabs")) from None
        raise


def write_gait(table: PostureTable | LocomotionTable, legs: Sequence[str]) -> bytes:
    """Write a gait file that is text: UTF-8, tabs between cells, a line feed after each row.

    Args:
        table: the gait; angles in radians, written as the shortest exact degrees.
        legs: labels of the robot's legs, for the legend of Loco-data.

    Raises:
        ValueError: if the table is not for a robot with these legs.
    """
    cells = (
        posture_cells(table, legs)
        if isinstance(table, PostureTable)
        else locomotion_cells(table, legs)
    )
    lines = (
        "\t".join(cell if isinstance(cell, str) else number_text(cell) for cell in row)
        for row in cells
    )
    return "".join(f"{line.rstrip()}\n" for line in lines).encode()


class Decoded(NamedTuple):
    """A decoded text, and how it is encoded in its file."""

    text: str
    encoding: str
    bom: bytes
    """The byte order mark at the beginning of the file; b"": there is none."""


def decoded(data: bytes, name: str, most_bytes: int = MAX_BYTES) -> Decoded:
    """Decode a file: by its BOM, else UTF-16 if it has NULs, else strict UTF-8, else cp932.

    Raises:
        FileRefused: if it is too large, or no text in any of these encodings.
    """
    if len(data) > most_bytes:
        most_kib = say("gait.most-kib", most=most_bytes // 1024)
        raise _refused(name, say("gait.bytes", count=len(data)), most_kib)
    for bom, encoding in _BOMS:
        if data.startswith(bom):
            return Decoded(_decoded(data[len(bom) :], encoding, name), encoding, bom)
    if b"\0" in data:
        # In UTF-16 every other byte of a table is NUL: the high bytes of digits and tabs.
        little = data[1::2].count(0) >= data[0::2].count(0)
        encoding = "utf-16-le" if little else "utf-16-be"
        return Decoded(_decoded(data, encoding, name), encoding, b"")
    try:
        return Decoded(data.decode("utf-8"), "utf-8", b"")
    except UnicodeDecodeError:
        return Decoded(_decoded(data, "cp932", name), "cp932", b"")


def _decoded(data: bytes, encoding: str, name: str) -> str:
    try:
        text = data.decode(encoding)
    except UnicodeDecodeError as error:
        start = error.start
    else:
        if "\0" not in text:
            return text
        start = len(text.partition("\0")[0].encode(encoding))  # pictures and records have NULs
    found = say("gait.no-text-byte", number=start + 1, byte=f"0x{data[start]:02x}")
    raise _refused(name, found, say("gait.encodings"))


def line_cells(line: str) -> list[str]:
    """Split a line into its cells: at tabs, or at spaces if it has no tab."""
    cells = line.split("\t") if "\t" in line else _SPACED_CELL.findall(line)
    return [_unquoted(cell.strip()) for cell in cells]


def _is_csv(lines: Iterable[str]) -> bool:
    """Return whether lines are CSV, in which commas or semicolons separate the cells.

    None of them has a tab then, and at least one has more commas and semicolons than it would have
    cells if spaces separated them: such a cell can have one decimal comma.
    """
    lines = list(lines)
    return not any("\t" in line for line in lines) and any(
        line.count(",") + line.count(";") > len(line_cells(line)) for line in lines
    )


def _unquoted(cell: str) -> str:
    if len(cell) >= 2 and cell[0] == cell[-1] == '"':
        return cell[1:-1].replace('""', '"')
    return cell


def _refused(name: str, found: Phrase, expected: Phrase) -> FileRefused:
    return FileRefused([Mistake(file=name, found=found, expected=expected)])
