"""Writes tables as CSV that is safe to open: a spreadsheet program takes no text for a formula."""

import csv
import io
from collections.abc import Iterable, Sequence

_FORMULA = (*"=+-@＝＋－＠", "\t", "\r")
"""Spreadsheet programs calculate a text that begins with one of these signs. In Japanese they also
do so for the full-width signs."""


def csv_text(rows: Iterable[Sequence[object]]) -> bytes:
    """Return rows as CSV; a text that looks like a formula gets an apostrophe before it.

    The text begins with a byte order mark, by which Excel sees that it is UTF-8.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerows([_harmless(cell) for cell in row] for row in rows)
    return text.getvalue().encode("utf-8-sig")


def _harmless(cell: object) -> object:
    return f"'{cell}" if isinstance(cell, str) and cell.startswith(_FORMULA) else cell
