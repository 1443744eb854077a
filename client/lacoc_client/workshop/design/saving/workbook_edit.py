"""Saves postures into a student's workbook; only the table changes, and what depends on it.

Other sheets, colours, widths, pictures, and formulas beside the table stay. Formulas in the table
become the numbers that the page shows. A formula that may depend on the table loses its stored
result, so that every program calculates it again.
"""

import re
from collections.abc import Mapping
from xml.sax.saxutils import escape

from openpyxl.formula.translate import Translator
from openpyxl.utils import get_column_letter, range_boundaries

from lacoc_client.workshop.design.saving.book_parts import BookParts
from lacoc_client.workshop.design.saving.sheet_ranges import with_ranges
from lacoc_client.workshop.design.saving.sheet_xml import (
    Content,
    NotEditable,
    Place,
    SheetXml,
    XmlCell,
)
from lacoc_client.workshop.design.saving.workbook_layout import Layout, find_layout
from lacoc_shared.gait.cells import angle_of, number_of, number_text
from lacoc_shared.gait.legend import KEY
from lacoc_shared.gait.tables import PostureTable
from lacoc_shared.gait.workbook import INPUT_SHEET, MIRROR_SHEET
from lacoc_shared.gait.workbook.apart import read_sheet_apart
from lacoc_shared.gait.workbook.file import read_workbook, sheet_rows
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

_TABLES = re.compile(rb"<(?:\w+:)?tablePart\b")
_LONG_FORMULAS = ("array", "dataTable")


def edit_workbook(data: bytes, name: str, table: PostureTable) -> bytes:
    """Return the bytes of a workbook after a table has replaced its postures.

    Args:
        data: the .xlsx file as it is now.
        name: name of the file, for messages.
        table: the new postures.

    Raises:
        FileRefused: if the file is no workbook with postures.
        UserError: if the postures can't be saved without losing something else in the file.
    """
    sheet = read_sheet_apart(data, name)
    layout = find_layout(sheet_rows(sheet), name, table)
    try:
        edited = _Edit(BookParts(data), sheet.title, layout).result() or data
        right = edited == data or read_workbook(edited, name) == table
    except Exception:  # NotEditable, or any other exception if the workbook is broken
        right = False
    if not right:
        raise UserError(say("design.cannot-edit", name=name))
    return edited


def formulas_in(data: bytes, name: str, joints: int) -> int:
    """Count the angles in a workbook's table of postures that are formulas.

    Args:
        data: an .xlsx file that can be read as postures.
        name: name of the file, for messages.
        joints: number of angles in each posture.
    """
    sheet = read_sheet_apart(data, name)
    postures = {row.number for row in sheet_rows(sheet) if KEY.fullmatch(row.cells[0].strip())}
    try:
        book = BookParts(data)
        cells = SheetXml(book.part(book.sheets[sheet.title])).cells()
    except Exception:  # the workbook can be read, but not edited in place
        return 0
    angles = {(row, column) for row in postures for column in range(2, joints + 2)}
    return sum(cell.formula is not None and cell.place in angles for cell in cells)


class _Edit:
    """One change of a workbook: new postures in its table.

    Args:
        book: the workbook.
        title: title of the sheet with the table.
        layout: where the table's cells are, and their new contents.
    """

    def __init__(self, book: BookParts, title: str, layout: Layout) -> None:
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
            NotEditable: if something in the workbook can't be kept.
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
        changed[part] = with_ranges(changed[part], self._layout)
        return self._book.packed(changed, formulas=has_formulas, chain=bool(had_formulas))

    def _formula(self, place: Place) -> bool:
        cell = self._cells.get(place)
        return cell is not None and cell.formula is not None

    def _contents(self) -> dict[Place, Content]:
        """Return the new contents of the table's cells, and of the legend's cells if it moves."""
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
        """Give each cell that shares a formula with a changed cell a formula of its own.

        Return the new contents of these cells by their places.

        Raises:
            NotEditable: if a changed cell is part of a formula over several cells.
        """
        masters: dict[str, XmlCell] = {}
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

    def _with_formula(self, cell: XmlCell, text: str) -> Content:
        p = self._sheet.prefix
        return Content(f"<{p}f>{escape(text)}</{p}f>", style=cell.attributes.get("s", ""))

    def _forget_values(self, edits: dict[str, dict[Place, Content]]) -> bool:
        """Remove stored results of formulas that may depend on the table.

        In the table's rows they stay: they are names, the number of postures, or empty texts beside
        the table, and without them the file can't be read. The mirror sheet, which shows the
        table's cells by formulas, gets the new numbers as stored results, because programs that
        can't calculate read them.

        Returns:
            Whether there are formulas that may depend on the table.
        """
        depend = self._dependent()
        for name, sheet in self._sheets.items():
            if name not in depend:
                continue
            cells = edits.setdefault(name, {})
            mirror = name == MIRROR_SHEET and self._title == INPUT_SHEET
            for cell in sheet.cells():
                is_read = name == self._title and cell.place[0] in self._layout.rows
                if cell.formula is None or cell.place in cells or is_read:
                    continue
                if mirror and self._mirrors(cell):
                    if cell.place in self._new_texts:
                        cells[cell.place] = _with_value(sheet, cell, self._new_texts[cell.place])
                else:
                    cells[cell.place] = _with_value(sheet, cell, "")
        return bool(depend)

    def _mirrors(self, cell: XmlCell) -> bool:
        """Return whether a cell shows the same value as the table's cell at the same address."""
        there = self._layout.texts.get(cell.place, "")
        if number_of(there) is not None:
            return number_of(cell.value) == number_of(there)
        return cell.value == there

    def _dependent(self) -> set[str]:
        """Return the titles of the sheets whose formulas may depend on the table."""
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


def _has(text: str, tokens: set[str]) -> bool:
    return any(token in text for token in tokens)


def _translated(formula: str, origin: Place, place: Place) -> str:
    (row, column), (own_row, own_column) = origin, place
    translator = Translator(f"={formula}", f"{get_column_letter(column)}{row}")
    text: str = translator.translate_formula(f"{get_column_letter(own_column)}{own_row}")
    return text.removeprefix("=")


def _with_value(sheet: SheetXml, cell: XmlCell, value: str) -> Content:
    """Return the content of a cell with its formula, and `value` as the formula's stored result.

    "": no stored result.
    """
    assert cell.formula is not None
    p, kind = sheet.prefix, ""
    inner = sheet.raw(cell.formula.start, cell.formula.end)
    if value:
        number = number_of(value)
        kind = "" if number is not None and value == number_text(number) else "str"
        inner += f"<{p}v>{escape(value)}</{p}v>"
    return Content(inner, kind, cell.attributes.get("s", ""))


def _covers(reference: str | None, contents: Mapping[Place, Content]) -> bool:
    if not reference:
        return False
    left, top, right, bottom = range_boundaries(reference)
    inside = [p for p in contents if top <= p[0] <= bottom and left <= p[1] <= right]
    return bool(inside) and (left, top) != (right, bottom)
