"""Saves postures into a workbook that a person works with: only the table's own cells change.

Other sheets, colours, widths, pictures, and formulas beside the table stay. Formulas in the table
become the numbers that the page shows. Values that other formulas have stored are removed where
they may be old, so that every program calculates them anew.
"""

import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from xml.sax.saxutils import escape

from openpyxl.formula.translate import Translator
from openpyxl.utils import get_column_letter, range_boundaries

from lacoc_client.design.book_parts import BookParts
from lacoc_client.design.sheet_xml import Cell, Content, NotEditable, Place, SheetXml
from lacoc_shared.gait.cells import Row, angle_of, degrees_of, number_of, number_text
from lacoc_shared.gait.legend import KEY, find_legend, trimmed
from lacoc_shared.gait.sheets import INPUT_SHEET, MIRROR_SHEET
from lacoc_shared.gait.tables import JOINTS_PER_LEG, PostureTable
from lacoc_shared.gait.workbook import read_workbook, sheet_rows
from lacoc_shared.mistakes import FileRefused, UserError
from lacoc_shared.words import say

_RANGES = re.compile(
    r'(<(?:\w+:)?(?:dataValidation|conditionalFormatting)\b[^>]*\ssqref=")([^"]*)"'
)
_MERGED = re.compile(r'(<(?:\w+:)?mergeCell\b[^>]*\sref=")([^"]*)"')
_SIZE = re.compile(r'(<(?:\w+:)?dimension\b[^>]*\sref=")([^"]*)"')
_TABLES = re.compile(rb"<(?:\w+:)?tablePart\b")
_LONG_FORMULAS = ("array", "dataTable")


def edit_workbook(data: bytes, name: str, table: PostureTable) -> bytes:
    """Return a workbook with other postures.

    Args:
        data: the .xlsx file as it is now.
        name: its name, for messages.
        table: the postures that it is to have.

    Raises:
        FileRefused: if the file is no workbook with postures.
        UserError: if it can't have these postures without losing something else.
    """
    title, rows = sheet_rows(data, name)
    layout = _layout(rows, name, table)
    try:
        edited = _Edit(BookParts(data), title, layout).result() or data
        right = edited == data or read_workbook(edited, name) == table
    except (NotEditable, FileRefused):
        right = False
    except Exception:  # a broken workbook may raise any exception
        right = False
    if not right:
        raise UserError(say("design.cannot-edit", name=name))
    return edited


def formulas_in(data: bytes, name: str) -> int:
    """Count the cells of a workbook's table whose numbers are results of formulas.

    Args:
        data: an .xlsx file that can be read as postures.
        name: its name, for messages.
    """
    title, rows = sheet_rows(data, name)
    postures = {row.number for row in rows if KEY.fullmatch(row.cells[0].strip())}
    book = BookParts(data)
    try:
        cells = SheetXml(book.part(book.sheets[title])).cells()
    except NotEditable:
        return 0
    return sum(cell.formula is not None and cell.place[0] in postures for cell in cells)


@dataclass(frozen=True)
class _Layout:
    """Where the cells of a sheet's table are, and what they are to have."""

    texts: Mapping[Place, str]
    """What the cells have now, as text."""
    columns: int
    """Columns of the table."""
    bottom: int
    """Row of the last posture now."""
    legend: tuple[int, int]
    """First row of the legend, and the row after it."""
    down: int
    """Rows by which the legend moves down."""
    wanted: Mapping[Place, str | float | None]
    """Text, number or nothing of each cell of the table."""


def _layout(rows: Sequence[Row], name: str, table: PostureTable) -> _Layout:
    """Find where each posture goes.

    Raises:
        UserError: if the postures do not fit into the sheet.
    """
    filled = [Row(row.number, trimmed(row.cells)) for row in rows]
    filled = [row for row in filled if row.cells]
    if not filled:
        raise UserError(say("design.cannot-edit", name=name))
    header, *others = filled
    body, legend, _ = find_legend(others)
    row_of = {int(found[1]): row for row in body if (found := KEY.fullmatch(row.cells[0]))}
    _check_robot(row_of.values(), name, table)
    first = legend[0].number if legend else 0
    stop = first
    while stop in {row.number for row in legend}:  # words further below are a person's own
        stop += 1
    end = first or filled[-1].number + len(table.postures) + 1
    used = {row.number for row in filled}
    free = [number for number in range(header.number + 1, end) if number not in used]
    free += [row.number for key, row in row_of.items() if key not in table.postures]
    down = max(0, len(table.postures.keys() - row_of.keys()) - len(free))
    if used & {*range(stop, stop + down)}:
        raise UserError(say("design.no-room", name=name, rows=down, row=first))
    free += range(first, first + down)
    place_of = {key: row.number for key, row in row_of.items() if key in table.postures}
    _place_new(place_of, table, free)
    wanted: dict[Place, str | float | None] = {}
    for key, row in row_of.items():
        if key not in table.postures:
            wanted |= {(row.number, column): None for column in range(1, table.joints + 2)}
    for key, number in place_of.items():
        if key not in row_of:
            wanted[number, 1] = f"{key} Key"
        for column, angle in enumerate(table.postures[key], start=2):
            wanted[number, column] = degrees_of(angle)
    if number_of([*header.cells, ""][1]) != len(table.postures):
        wanted[header.number, 2] = float(len(table.postures))
    return _Layout(
        texts={
            (row.number, column): cell
            for row in filled
            for column, cell in enumerate(row.cells, start=1)
            if cell
        },
        columns=table.joints + 1,
        bottom=max((row.number for row in row_of.values()), default=header.number),
        legend=(first, stop),
        down=down,
        wanted=wanted,
    )


def _check_robot(rows: Iterable[Row], name: str, table: PostureTable) -> None:
    """Check that the sheet has the columns of the table's robot.

    Raises:
        UserError: if it is for another number of legs.
    """
    counts = Counter(len(row.cells) - 1 for row in rows).most_common(1)
    joints = counts[0][0] if counts else table.joints
    if joints != table.joints and joints % JOINTS_PER_LEG == 0:
        legs, wanted = joints // JOINTS_PER_LEG, table.joints // JOINTS_PER_LEG
        raise UserError(say("design.other-robot", name=name, legs=legs, wanted=wanted))


def _place_new(place_of: dict[int, int], table: PostureTable, free: list[int]) -> None:
    """Give each posture without a row a free one, in the order of the keys where that is possible.

    Args:
        place_of: row of each posture; the new ones are added.
        table: the postures.
        free: rows that can be used; those that are taken are removed.
    """
    for key in sorted(table.postures.keys() - place_of.keys()):
        row = min(free, key=lambda row: (_disorder(place_of, key, row), row))
        free.remove(row)
        place_of[key] = row


def _disorder(place_of: Mapping[int, int], key: int, row: int) -> int:
    """Count the postures that a key in this row would be out of order with."""
    return sum((other < key) != (place < row) for other, place in place_of.items())


class _Edit:
    """One change of a workbook.

    Args:
        book: the workbook.
        title: title of the sheet with the table.
        layout: what its cells are to have.
    """

    def __init__(self, book: BookParts, title: str, layout: _Layout) -> None:
        self._book = book
        self._title = title
        self._layout = layout
        self._sheets = {name: SheetXml(book.part(part)) for name, part in book.sheets.items()}
        self._sheet = self._sheets[title]
        self._cells = {cell.place: cell for cell in self._sheet.cells()}
        self._new_texts: dict[Place, str] = {}

    def result(self) -> bytes | None:
        """Return the changed workbook; None if nothing changes.

        Raises:
            NotEditable: if something in it can't be kept.
        """
        contents = self._contents()
        if not contents:
            return None
        structure = any(
            isinstance(self._layout.wanted.get(place), str | None) for place in contents
        )
        if structure and _TABLES.search(self._book.part(self._book.sheets[self._title])):
            raise NotEditable("it has a table with a name and headings")
        had_formulas = [place for place in contents if self._formula(place)]
        contents |= self._unshared(contents)
        edits = {self._title: contents}
        has_formulas = self._forget_values(edits)
        changed = {
            self._book.sheets[name]: self._sheets[name].edited(cells)
            for name, cells in edits.items()
            if cells
        }
        part = self._book.sheets[self._title]
        changed[part] = self._with_ranges(changed[part])
        return self._book.packed(changed, formulas=has_formulas, chain=bool(had_formulas))

    def _formula(self, place: Place) -> bool:
        cell = self._cells.get(place)
        return cell is not None and cell.formula is not None

    def _contents(self) -> dict[Place, Content]:
        """Return the new contents of the table's cells, and of the legend if it moves."""
        layout = self._layout
        contents: dict[Place, Content] = {}
        changes = {place: wanted for place, wanted in layout.wanted.items() if self._differs(place)}
        if not changes:
            return {}
        new_rows = {row for (row, _), wanted in layout.wanted.items() if isinstance(wanted, str)}
        for place, wanted in layout.wanted.items():
            is_formula = self._formula(place) and isinstance(wanted, float)
            if place in changes or place[0] in new_rows or is_formula:
                contents[place] = self._content(place, wanted)
        first, stop = layout.legend
        for row in range(first, stop) if layout.down else ():
            for column in range(1, layout.columns + 1):
                self._move(contents, (row, column), (row + layout.down, column))
        return contents

    def _move(self, contents: dict[Place, Content], old: Place, new: Place) -> None:
        cell = self._cells.get(old)
        if cell is not None and cell.formula is not None:
            raise NotEditable("a heading is a formula")
        contents[new] = Content(style="") if cell is None else self._sheet.copy(cell)
        self._new_texts[new] = self._layout.texts.get(old, "")

    def _differs(self, place: Place) -> bool:
        wanted, now = self._layout.wanted[place], self._layout.texts.get(place, "")
        if isinstance(wanted, float):
            number = number_of(now)
            return number is None or angle_of(number) != angle_of(wanted)
        return (wanted or "") != now

    def _content(self, place: Place, wanted: str | float | None) -> Content:
        row, column = place
        style = None
        if row > self._layout.bottom:  # a new row looks like the last one
            above = self._cells.get((self._layout.bottom, column))
            style = above.attributes.get("s", "") if above else ""
        if wanted is None:
            self._new_texts[place] = ""
            return Content(style=style)
        text = number_text(wanted) if isinstance(wanted, float) else wanted
        self._new_texts[place] = text
        made = self._sheet.number if isinstance(wanted, float) else self._sheet.text
        return made(text)._replace(style=style)

    def _unshared(self, contents: Mapping[Place, Content]) -> dict[Place, Content]:
        """Give cells their own formulas whose shared formula stands in a cell that changes.

        Raises:
            NotEditable: if a changed cell is part of a formula over several cells.
        """
        masters: dict[str, Cell] = {}
        touched: set[str] = set()
        for place, cell in self._cells.items():
            if cell.formula is None:
                continue
            attributes = cell.formula.attributes
            if attributes.get("t") in _LONG_FORMULAS and _covers(attributes.get("ref"), contents):
                raise NotEditable("a formula fills several cells")
            if attributes.get("t") == "shared":
                if cell.formula.text:
                    masters[attributes.get("si", "")] = cell
                if place in contents:
                    touched.add(attributes.get("si", ""))
        own: dict[Place, Content] = {}
        for place, cell in self._cells.items():
            formula = cell.formula
            if formula is None or formula.attributes.get("t") != "shared" or place in contents:
                continue
            master = masters.get(formula.attributes.get("si", ""))
            if formula.attributes.get("si") in touched and master and master.formula:
                text = _translated(master.formula.text, master.place, place)
                own[place] = self._with_formula(cell, text)
        return own

    def _with_formula(self, cell: Cell, text: str) -> Content:
        p = self._sheet.prefix
        return Content(f"<{p}f>{escape(text)}</{p}f>", style=cell.attributes.get("s", ""))

    def _forget_values(self, edits: dict[str, dict[Place, Content]]) -> bool:
        """Remove stored values of formulas that may depend on the table; return if there are any.

        The sheet that shows the table's cells gets its new values instead, because programs that
        do not calculate read it.
        """
        depend = self._dependent()
        for name, sheet in self._sheets.items():
            if name not in depend:
                continue
            cells = edits.setdefault(name, {})
            mirror = name == MIRROR_SHEET and self._title == INPUT_SHEET
            for cell in sheet.cells():
                if cell.formula is None or cell.place in cells:
                    continue
                if mirror and self._mirrors(cell):
                    if cell.place in self._new_texts:
                        cells[cell.place] = _with_value(sheet, cell, self._new_texts[cell.place])
                else:
                    cells[cell.place] = _with_value(sheet, cell, "")
        return bool(depend)

    def _mirrors(self, cell: Cell) -> bool:
        """Return whether a cell's stored value is that of the same cell of the table."""
        there = self._layout.texts.get(cell.place, "")
        if number_of(there) is not None:
            return number_of(cell.value) == number_of(there)
        return cell.value == there

    def _dependent(self) -> set[str]:
        """Return the titles of sheets with formulas that may depend on the table."""
        formulas = {
            name: [cell.formula.text for cell in sheet.cells() if cell.formula]
            for name, sheet in self._sheets.items()
        }
        names = self._book.defined_names()
        tokens = {self._title.replace("'", "''"), "INDIRECT("}
        depend: set[str] = {self._title} if formulas[self._title] else set()
        while True:
            before = len(tokens)
            tokens |= {name for name, text in names.items() if _has(text, tokens)}
            depend |= {
                name for name, texts in formulas.items() if any(_has(one, tokens) for one in texts)
            }
            tokens |= {name.replace("'", "''") for name in depend}
            if len(tokens) == before:
                return depend

    def _with_ranges(self, xml: bytes) -> bytes:
        """Return a sheet whose ranges reach to the new last row of the table."""
        layout, text = self._layout, xml.decode()
        last = max(
            (row for row, _ in layout.wanted if layout.wanted[row, 2] is not None), default=0
        )
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


def _has(text: str, tokens: set[str]) -> bool:
    return any(token in text for token in tokens)


def _translated(formula: str, origin: Place, place: Place) -> str:
    (row, column), (own_row, own_column) = origin, place
    translator = Translator(f"={formula}", f"{get_column_letter(column)}{row}")
    text: str = translator.translate_formula(f"{get_column_letter(own_column)}{own_row}")
    return text.removeprefix("=")


def _with_value(sheet: SheetXml, cell: Cell, value: str) -> Content:
    """Return a cell with its formula and this stored value; "": none."""
    assert cell.formula is not None
    p, kind = sheet.prefix, ""
    inner = sheet.raw(cell.formula.start, cell.formula.end)
    if value:
        kind = "" if number_of(value) is not None else "str"
        inner += f"<{p}v>{escape(value)}</{p}v>"
    return Content(inner, kind, cell.attributes.get("s", ""))


def _covers(reference: str | None, contents: Mapping[Place, Content]) -> bool:
    if not reference:
        return False
    left, top, right, bottom = range_boundaries(reference)
    inside = [p for p in contents if top <= p[0] <= bottom and left <= p[1] <= right]
    return bool(inside) and (left, top) != (right, bottom)


def _longer(one: str, layout: _Layout, last: int) -> str:
    """Let a range that ends with the table's last row reach to another row."""
    left, top, right, bottom = range_boundaries(one)
    if bottom != layout.bottom or top >= bottom or right > layout.columns:
        return one
    return f"{get_column_letter(left)}{top}:{get_column_letter(right)}{last}"


def _moved(reference: str, layout: _Layout) -> str:
    """Move a range that lies in the legend."""
    left, top, right, bottom = range_boundaries(reference)
    first, stop = layout.legend
    if not (first <= top and bottom < stop and right <= layout.columns):
        return reference
    top, bottom = top + layout.down, bottom + layout.down
    return f"{get_column_letter(left)}{top}:{get_column_letter(right)}{bottom}"


def _grown(reference: str, rows: int) -> str:
    left, top, right, bottom = range_boundaries(reference)
    return f"{get_column_letter(left)}{top}:{get_column_letter(right)}{bottom + rows}"
