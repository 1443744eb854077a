"""Changes cells in the XML of a worksheet; all bytes outside the changed rows stay as they are.

A library that reads a workbook and writes it again loses the parts that it can't handle: pictures,
charts, and additions of newer programs. So a parser finds where rows and cells stand in the XML,
and only the rows with changed cells are written anew.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple
from xml.parsers import expat
from xml.sax.saxutils import escape

from openpyxl.utils import get_column_letter
from openpyxl.utils.cell import coordinate_to_tuple

Place = tuple[int, int]
"""Row and column, counted from 1."""

_TAG = re.compile(rb"<(?:\"[^\"]*\"|'[^']*'|[^\"'>])*>")
_ATTRIBUTE = r'\s{}=(?:"[^"]*"|\'[^\']*\')'
_NO_UTF_8 = re.compile(
    rb"""^(\xff\xfe|\xfe\xff|<\?xml[^>]*encoding=["'](?!utf-8))""", re.IGNORECASE
)


class NotEditable(Exception):
    """A part of the workbook can't be changed without the loss of something."""


@dataclass
class Formula:
    """A formula of a cell; `start` and `end` are byte offsets of its element."""

    attributes: Mapping[str, str]
    start: int
    end: int = 0
    text: str = ""


@dataclass
class XmlCell:
    """A cell in the XML; `start`, `inner_start`, `inner_end` and `end` are byte offsets."""

    place: Place
    attributes: Mapping[str, str]
    start: int
    inner_start: int
    inner_end: int = 0
    end: int = 0
    formula: Formula | None = None
    value: str = ""
    """Its stored value, as text: a number, a text, or the index of a shared text."""


@dataclass
class _XmlRow:
    number: int
    start: int
    inner_start: int
    end: int = 0
    cells: list[XmlCell] = field(default_factory=list)


class Content(NamedTuple):
    """The new content of a cell."""

    inner: str = ""
    """XML between the cell's tags; its elements have the prefix `SheetXml.prefix`."""
    kind: str = ""
    """Type of the cell, its attribute `t`; "": a number."""
    style: str | None = None
    """Index of the cell's style, "": none; None: the cell keeps the style that it has."""


class SheetXml:
    """The XML of a worksheet, in which cells can be changed.

    Args:
        data: the file; an earlier check has made sure that it defines no XML entities.

    Raises:
        NotEditable: if the file can't be changed in place.
    """

    def __init__(self, data: bytes) -> None:
        if _NO_UTF_8.match(data):
            raise NotEditable("its text is not UTF-8")
        self._data = data
        self._lines: dict[int, _XmlRow] = {}
        self._data_end = -1
        self.prefix = ""
        """Prefix of the elements' names with its colon, such as "x:"; often ""."""
        try:
            _Indexer(self, data)
        except expat.ExpatError as error:
            raise NotEditable(str(error)) from None
        if self._data_end < 0:
            raise NotEditable("it has no cells")

    def cells(self) -> list[XmlCell]:
        """Return the cells of the worksheet, in the order of the file."""
        return [cell for line in self._lines.values() for cell in line.cells]

    def raw(self, start: int, end: int) -> str:
        """Return a part of the worksheet's XML as it is."""
        return self._data[start:end].decode()

    def number(self, text: str) -> Content:
        """Make the content of a cell with a number."""
        return Content(f"<{self.prefix}v>{text}</{self.prefix}v>")

    def text(self, text: str) -> Content:
        """Make the content of a cell with a text."""
        p = self.prefix
        return Content(f"<{p}is><{p}t>{escape(text)}</{p}t></{p}is>", "inlineStr")

    def copy(self, cell: XmlCell) -> Content:
        """Return the present content of a cell with its style, to put it into another cell."""
        inner = self.raw(cell.inner_start, cell.inner_end)
        return Content(inner, cell.attributes.get("t", ""), cell.attributes.get("s", ""))

    def edited(self, contents: Mapping[Place, Content]) -> bytes:
        """Return the worksheet's XML with new contents of cells; add missing rows and cells."""
        pieces: list[tuple[int, int, bytes]] = []
        rows: dict[int, dict[int, Content]] = {}
        for (row, column), content in contents.items():
            rows.setdefault(row, {})[column] = content
        for row, new in sorted(rows.items()):
            line = self._lines.get(row)
            if line is None:
                place = self._place_of_new(row)
                pieces.append((place, place, self._new_line(row, new)))
            else:
                pieces.append((line.start, line.end, self._changed_line(line, new)))
        changed, end = bytearray(), 0
        for start, stop, piece in sorted(pieces, key=lambda piece: piece[:2]):
            changed += self._data[end:start] + piece
            end = stop
        return bytes(changed + self._data[end:])

    def _place_of_new(self, row: int) -> int:
        below = (line.start for line in self._lines.values() if line.number > row)
        return min(below, default=self._data_end)

    def _new_line(self, row: int, new: Mapping[int, Content]) -> bytes:
        p = self.prefix
        cells = "".join(self._cell((row, column), new[column], "") for column in sorted(new))
        return f'<{p}row r="{row}">{cells}</{p}row>'.encode()

    def _changed_line(self, line: _XmlRow, new: Mapping[int, Content]) -> bytes:
        head = self.raw(line.start, line.inner_start).rstrip(">").rstrip("/")
        head = re.sub(_ATTRIBUTE.format("spans"), "", head)
        texts: dict[int, str] = {}
        end = line.inner_start
        for cell in line.cells:
            column, end = cell.place[1], cell.end
            if column in new:
                style = cell.attributes.get("s", "")
                texts[column] = self._cell(cell.place, new[column], style)
            else:
                texts[column] = self._named(cell)
        for column in new.keys() - texts.keys():
            texts[column] = self._cell((line.number, column), new[column], "")
        rest = self.raw(end, line.end)  # what a newer program has put after the cells
        rest = rest[: rest.rindex("</")] if rest else ""
        cells = "".join(texts[column] for column in sorted(texts))
        return f"{head}>{cells}{rest}</{self.prefix}row>".encode()

    def _cell(self, place: Place, content: Content, style: str) -> str:
        p, (row, column) = self.prefix, place
        style = style if content.style is None else content.style
        attributes = f' r="{get_column_letter(column)}{row}"'
        attributes += f' s="{style}"' if style else ""
        attributes += f' t="{content.kind}"' if content.kind and content.inner else ""
        return (
            f"<{p}c{attributes}>{content.inner}</{p}c>" if content.inner else f"<{p}c{attributes}/>"
        )

    def _named(self, cell: XmlCell) -> str:
        """Return a cell's XML with its address, such as B2, which some programs leave out."""
        raw = self.raw(cell.start, cell.end)
        if "r" in cell.attributes:
            return raw
        row, column = cell.place
        name = f"<{self.prefix}c"
        return raw.replace(name, f'{name} r="{get_column_letter(column)}{row}"', 1)


class _Indexer:
    """Finds the places of rows and cells in a worksheet's XML."""

    def __init__(self, sheet: SheetXml, data: bytes) -> None:
        self._sheet = sheet
        self._data = data
        self._line: _XmlRow | None = None
        self._cell: XmlCell | None = None
        self._in_value = self._in_formula = False
        self._row = 0
        self._column = 0
        self._alone: list[int | None] = []
        """For each open element: the end of its tag if it is of the form <a/>, else None."""
        self._parser = parser = expat.ParserCreate()
        parser.StartElementHandler = self._start
        parser.EndElementHandler = self._end
        parser.CharacterDataHandler = self._text
        parser.Parse(data, True)

    def _tag_end(self) -> int:
        match = _TAG.match(self._data, self._parser.CurrentByteIndex)
        assert match is not None
        return match.end()

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        start, tag_end = self._parser.CurrentByteIndex, self._tag_end()
        self._alone.append(tag_end if self._data[tag_end - 2 : tag_end] == b"/>" else None)
        prefix, colon, local = name.rpartition(":")
        if local == "sheetData":
            self._sheet.prefix = prefix + colon
        elif local == "row" and self._line is None:
            self._row = int(attributes.get("r", self._row + 1))
            self._column = 0
            self._line = _XmlRow(self._row, start, tag_end)
            self._sheet._lines[self._row] = self._line
        elif local == "c" and self._line is not None:
            if "r" in attributes:
                self._column = coordinate_to_tuple(attributes["r"])[1]
            else:
                self._column += 1
            self._cell = XmlCell((self._row, self._column), attributes, start, tag_end)
            self._line.cells.append(self._cell)
        elif self._cell is not None and local == "f":
            self._cell.formula = Formula(attributes, start)
            self._in_formula = True
        elif self._cell is not None and local == "v":
            self._in_value = True

    def _end(self, name: str) -> None:
        # For <a/> the parser's position is already behind the tag.
        alone = self._alone.pop()
        start = self._parser.CurrentByteIndex if alone is None else alone
        end = self._tag_end() if alone is None else alone
        local = name.rpartition(":")[2]
        cell = self._cell
        if local == "sheetData":
            self._sheet._data_end = start if alone is None else -1
        elif local == "row" and self._line is not None:
            self._line.end, self._line = end, None
        elif cell is not None and local == "c":
            cell.end = end
            cell.inner_end = start
            self._cell = None
        elif cell is not None and cell.formula is not None and local == "f":
            cell.formula.end = end
            self._in_formula = False
        elif local == "v":
            self._in_value = False

    def _text(self, text: str) -> None:
        if self._cell is None:
            return
        if self._in_value:
            self._cell.value += text
        elif self._in_formula and self._cell.formula is not None:
            self._cell.formula.text += text
