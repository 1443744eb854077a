"""Ranges of cells in a worksheet: input checks, colour rules, merged headings, the used area."""

import re

from openpyxl.utils import get_column_letter, range_boundaries

from lacoc_client.workshop.design.saving.workbook_layout import Layout

_RANGES = re.compile(
    r'(<(?:\w+:)?(?:dataValidation|conditionalFormatting)\b[^>]*\ssqref=")([^"]*)"'
)
_MERGED = re.compile(r'(<(?:\w+:)?mergeCell\b[^>]*\sref=")([^"]*)"')
_SIZE = re.compile(r'(<(?:\w+:)?dimension\b[^>]*\sref=")([^"]*)"')


def with_ranges(xml: bytes, layout: Layout) -> bytes:
    """Return a worksheet's XML in which ranges of cells fit the changed table.

    Input checks and colour rules of the table are extended to its new last row. Merged headings in
    the legend move down with it.
    """
    text = xml.decode()
    last = max((row for row, _ in layout.wanted if layout.wanted[row, 2] is not None), default=0)
    added = last - layout.bottom
    if added > 0:

        def longer(found: re.Match[str]) -> str:
            ranges = (_longer(one, layout, last) for one in found[2].split(" "))
            return f'{found[1]}{" ".join(ranges)}"'

        text = _RANGES.sub(longer, text)
        grown = layout.down if layout.legend[0] else added
        text = _SIZE.sub(lambda found: f'{found[1]}{_grown(found[2], grown)}"', text)
    if layout.down:
        text = _MERGED.sub(lambda found: f'{found[1]}{_moved(found[2], layout)}"', text)
    return text.encode()


def _longer(one: str, layout: Layout, last: int) -> str:
    """Extend a range of cells to row `last` if it ends at the table's old last row."""
    left, top, right, bottom = range_boundaries(one)
    if bottom != layout.bottom or top >= bottom or right > layout.columns:
        return one
    return f"{get_column_letter(left)}{top}:{get_column_letter(right)}{last}"


def _moved(reference: str, layout: Layout) -> str:
    """Move a range of cells down, as far as the legend moves, if it lies in the legend."""
    left, top, right, bottom = range_boundaries(reference)
    first, stop = layout.legend
    if not (first <= top and bottom < stop and right <= layout.columns):
        return reference
    top, bottom = top + layout.down, bottom + layout.down
    return f"{get_column_letter(left)}{top}:{get_column_letter(right)}{bottom}"


def _grown(reference: str, rows: int) -> str:
    left, top, right, bottom = range_boundaries(reference)
    return f"{get_column_letter(left)}{top}:{get_column_letter(right)}{bottom + rows}"
