"""Tables as CSV that is safe to open: a spreadsheet program takes no text in them for a formula."""

import csv
import io
from collections.abc import Iterable, Sequence

_FORMULA = (*"=+-@＝＋－＠", "\t", "\r")
"""Spreadsheet programs calculate a text that begins with one of these; wide signs in Japanese."""


def csv_text(rows: Iterable[Sequence[object]]) -> bytes:
    """Return rows as CSV; a text that looks like a formula gets an apostrophe before it.

    A byte order mark tells Excel that the file is UTF-8.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerows([_harmless(cell) for cell in row] for row in rows)
    return text.getvalue().encode("utf-8-sig")


def _harmless(cell: object) -> object:
    return f"'{cell}" if isinstance(cell, str) and cell.startswith(_FORMULA) else cell
