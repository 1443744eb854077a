"""The look of a workbook of postures: its sheets, their colours, and checks of what is typed."""

from collections.abc import Sequence

from xlsxwriter import Workbook
from xlsxwriter.format import Format
from xlsxwriter.utility import xl_col_to_name
from xlsxwriter.worksheet import Worksheet

from lacoc_shared.gait.cells import MAX_KEYS, RANGE_DEG, number_text
from lacoc_shared.gait.workbook import INPUT_SHEET, MIRROR_SHEET

_LEGEND_ROWS = 3
_MIRRORED_ROWS = 1 + MAX_KEYS + _LEGEND_ROWS + 6  # a full table with some blank rows

_LEVEL_COLOURS = (("#DEEAF6", "#9DC3E6"), ("#E5F2DC", "#A9D18E"), ("#FCECDF", "#F4B183"))
"""Colours for the columns of the root, 1st and 2nd joints: behind the angles, and in the legend."""
_LABEL_COLOUR, _EDGE_COLOUR, _WRONG_COLOUR = "#E7E6E6", "#BFBFBF", "#FF7C80"
_MIRROR_COLOUR = "#595959"  # grey: not for editing


def add_sheets(book: Workbook, cells: Sequence[Sequence[str | float]], legs: int) -> None:
    """Add two sheets to a workbook: one to edit, and one whose formulas show the first one's cells.

    Args:
        book: the workbook.
        cells: the cells of workshop Fig. 4-1: a header row, the postures, three legend rows.
        legs: number of legs; Root, 1st and 2nd joints have a column for each leg.
    """
    book.formats[0].set_font_name("Arial")  # every system has it, or a font of the same widths
    book.formats[0].set_font_size(10)
    edited = book.add_worksheet(INPUT_SHEET)
    mirror = book.add_worksheet(MIRROR_SHEET)
    _write_edited(book, edited, cells, legs)
    edited.set_tab_color(_LEVEL_COLOURS[1][1])
    _write_mirror(book, mirror, cells, columns=len(cells[1]))
    for sheet in (edited, mirror):
        sheet.set_column(0, 0, 15.5)
        sheet.set_column(1, len(cells[1]) - 1, 5.6)
        sheet.freeze_panes(1, 1)
        sheet.set_landscape()
        sheet.set_paper(9)  # A4
        sheet.fit_to_pages(1, 1)
        sheet.set_footer("&L&F&R&A")


def _write_edited(
    book: Workbook, sheet: Worksheet, cells: Sequence[Sequence[str | float]], legs: int
) -> None:
    legend = len(cells) - _LEGEND_ROWS
    columns = len(cells[1])
    label = _format(book, bg_color=_LABEL_COLOUR, bold=True)
    number = _format(book, align="center", bold=True)
    for row, values in enumerate(cells):
        sheet.write(row, 0, values[0], label)
        if row == 0:
            sheet.write(row, 1, values[1], number)
            continue
        for column in range(1, columns):
            level, leg = divmod(column - 1, legs)
            light, dark = _LEVEL_COLOURS[level]
            look = {"align": "center", "left": 2 if leg == 0 else 1}
            if row >= legend:
                look |= {"bg_color": dark, "bold": True}
            else:
                look |= {"bg_color": light}
            value = values[column] if column < len(values) else ""
            sheet.write(row, column, value, _format(book, **look))
    _add_help(book, sheet, last_posture=legend - 1, last_column=columns - 1)


def _add_help(book: Workbook, sheet: Worksheet, last_posture: int, last_column: int) -> None:
    """Let spreadsheet programs reject wrong numbers that are typed, and colour those pasted."""
    limit = number_text(RANGE_DEG)
    angles = (1, 1, last_posture, last_column)
    sheet.data_validation(
        *angles,
        {
            "validate": "decimal",
            "criteria": "between",
            "minimum": -RANGE_DEG,
            "maximum": RANGE_DEG,
            "ignore_blank": False,
            "error_title": "Angle",
            "error_message": f"An angle is a number from -{limit} to {limit} degrees.",
        },
    )
    sheet.conditional_format(
        *angles,
        {
            "type": "formula",
            "criteria": f"=IF(ISNUMBER(B2),ABS(B2)>{limit},TRUE)",
            "format": book.add_format({"bg_color": _WRONG_COLOUR}),
        },
    )
    sheet.data_validation(
        0,
        1,
        0,
        1,
        {
            "validate": "integer",
            "criteria": "between",
            "minimum": 1,
            "maximum": MAX_KEYS,
            "ignore_blank": False,
            "input_title": "Number of postures",
            "input_message": "How many rows with a key stand below. After inserting or "
            "deleting one, change this number.",
            "error_title": "Number of postures",
            "error_message": f"A whole number from 1 to {MAX_KEYS}.",
        },
    )


def _write_mirror(
    book: Workbook, sheet: Worksheet, cells: Sequence[Sequence[str | float]], columns: int
) -> None:
    label = book.add_format({"font_color": _MIRROR_COLOUR})
    centred = book.add_format({"font_color": _MIRROR_COLOUR, "align": "center"})
    # The formula finds a cell by its position, so inserting, deleting and moving rows in the
    # edited sheet breaks nothing. An empty cell stays empty; a plain reference would show 0.
    area = f"'{INPUT_SHEET}'!$A:${xl_col_to_name(columns - 1)}"
    cell = f"INDEX({area},ROW(),COLUMN())"
    for row in range(_MIRRORED_ROWS):
        values = cells[row] if row < len(cells) else ()
        for column in range(columns):
            value = values[column] if column < len(values) else ""
            if isinstance(value, float) and value.is_integer():
                value = int(value)  # 45, as spreadsheet programs write it, not 45.0
            look = centred if column else label
            sheet.write_formula(row, column, f'=IF({cell}="","",{cell})', look, value)
    sheet.protect()  # no password: it only prevents editing the wrong sheet by mistake


def _format(book: Workbook, **look: object) -> Format:
    return book.add_format({"border": 1, "border_color": _EDGE_COLOUR} | look)
