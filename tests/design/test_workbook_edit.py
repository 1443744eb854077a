"""Tests that postures are saved into a workbook, and only the cells of the table change."""

import io
import math
import re
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import openpyxl
import pytest
import xlsxwriter
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from openpyxl.comments import Comment
from openpyxl.formatting.rule import CellIsRule
from openpyxl.styles import PatternFill
from openpyxl.worksheet.datavalidation import DataValidation

from lacoc_client.workshop.design.saving.workbook_edit import edit_workbook, formulas_in
from lacoc_robots.library import sample_gait_files
from lacoc_shared.gait.cells import leg_labels, posture_cells
from lacoc_shared.gait.tables import PostureTable
from lacoc_shared.gait.text import read_gait
from lacoc_shared.gait.workbook import INPUT_SHEET, MIRROR_SHEET
from lacoc_shared.gait.workbook.file import read_workbook, write_workbook
from lacoc_shared.mistakes import UserError

CALC = Path(__file__).parents[1] / "gait" / "files" / "calc.xlsx"
"""The workshop's table, saved by LibreOffice."""
PURPLE = "FF7030A0"
NO_VALUE = re.compile("<v ?/>|<v></v>")
"""The empty result of a formula, as written by a program that can't calculate."""


def sample() -> PostureTable:
    file = sample_gait_files("hexapod").postures
    assert file is not None
    table = read_gait(file.data, file.name)
    assert isinstance(table, PostureTable)
    return table


def saved(book: openpyxl.Workbook) -> bytes:
    stream = io.BytesIO()
    book.save(stream)
    return stream.getvalue()


def ours() -> bytes:
    """Return a workbook that this project writes, with stored results of its formulas."""
    return write_workbook(sample(), leg_labels(6))


def own() -> bytes:
    """Return a workbook with a student's own colours, comments, formulas, rules and sheets."""
    book = openpyxl.load_workbook(io.BytesIO(ours()))
    sheet = book[INPUT_SHEET]
    sheet["C5"].fill = PatternFill("solid", fgColor=PURPLE)
    sheet["C5"].comment = Comment("look at the middle leg", "Kim")
    sheet["A20"] = "sum of key 0"
    sheet["B20"] = "=SUM(B2:S2)"
    sheet["W30"] = "far away"
    sheet.column_dimensions["C"].width = 21
    sheet.merge_cells("B13:G13")
    rule = CellIsRule("greaterThan", ["40"], fill=PatternFill("solid", bgColor=PURPLE))
    sheet.conditional_formatting.add("B2:S10", rule)
    other = book.create_sheet("My notes")
    other["A1"] = "keep me"
    other["A2"] = f"='{INPUT_SHEET}'!B2*2"
    other["A3"] = 3.5
    other.add_data_validation(DataValidation("whole", sqref="A3:A9"))
    book.create_sheet("Alone")["A1"] = "=1+1"
    return saved(book)


def files() -> dict[str, bytes]:
    return {"calc": CALC.read_bytes(), "ours": ours(), "own": own()}


FILES = files()


def everything(data: bytes) -> dict[str, Any]:
    """Return a workbook's cells with formats and comments, its column widths and row heights."""
    book = openpyxl.load_workbook(io.BytesIO(data))
    found: dict[str, Any] = {"sheets": book.sheetnames}
    for sheet in book:
        found[f"{sheet.title} widths"] = {
            key: one.width for key, one in sheet.column_dimensions.items()
        }
        found[f"{sheet.title} heights"] = {k: v.height for k, v in sheet.row_dimensions.items()}
        for row in sheet.iter_rows():
            for cell in row:
                comment = cell.comment and cell.comment.text
                look = (cell.fill.fgColor.rgb, cell.font.b, cell.alignment.horizontal or "general")
                look += (cell.border.left.style or "", cell.border.top.style or "")
                found[f"{sheet.title}!{cell.coordinate}"] = (cell.value, look, comment)
    return found


def differing(before: bytes, after: bytes) -> set[str]:
    """Return the names of all things that differ between two workbooks."""
    one, other = everything(before), everything(after)
    return {name for name in one.keys() | other.keys() if one.get(name) != other.get(name)}


def values(data: bytes, sheet: str) -> dict[str, Any]:
    """Return a sheet's stored values by cell address; no formula is calculated."""
    rows = openpyxl.load_workbook(io.BytesIO(data), data_only=True)[sheet].iter_rows()
    return {cell.coordinate: cell.value for row in rows for cell in row}


def with_angle(table: PostureTable, key: int, joint: int, angle_deg: float) -> PostureTable:
    angles = list(table.postures[key])
    angles[joint] = math.radians(angle_deg)
    return PostureTable({**table.postures, key: tuple(angles)})


@pytest.mark.parametrize("name", FILES)
def test_an_unchanged_table_gives_the_same_bytes(name: str) -> None:
    """A workbook that already has the table is returned byte for byte."""
    assert edit_workbook(FILES[name], "x.xlsx", sample()) is FILES[name]


@pytest.mark.parametrize("name", FILES)
def test_one_number_changes_one_cell(name: str) -> None:
    """If one angle differs, only its cell changes; other cells, formats and comments stay."""
    wanted = with_angle(sample(), 3, 7, -12.5)
    after = edit_workbook(FILES[name], "x.xlsx", wanted)
    assert read_workbook(after, "x.xlsx") == wanted
    assert differing(FILES[name], after) == {f"{INPUT_SHEET}!I5"}
    untouched = {"xl/styles.xml", "docProps/core.xml"}
    with zipfile.ZipFile(io.BytesIO(FILES[name])) as one, zipfile.ZipFile(io.BytesIO(after)) as two:
        assert one.namelist() == two.namelist()
        assert all(one.read(part) == two.read(part) for part in untouched)


def test_the_mirror_shows_the_new_numbers() -> None:
    """The mirror sheet, a copy by formulas, stores the new angle; Excel recalculates formulas."""
    after = edit_workbook(ours(), "x.xlsx", with_angle(sample(), 0, 0, 33))
    assert values(after, MIRROR_SHEET)["B2"] == 33
    assert values(after, MIRROR_SHEET)["C2"] == values(ours(), MIRROR_SHEET)["C2"]
    with zipfile.ZipFile(io.BytesIO(after)) as archive:
        assert b'fullCalcOnLoad="1"' in archive.read("xl/workbook.xml")


def test_the_mirror_shows_a_text_like_a_number() -> None:
    """A label that a person reads as a number, but Excel does not, is a text in the mirror too."""
    before = write_workbook(sample(), ("45°", *leg_labels(6)[1:]))
    table = PostureTable({**sample().postures, 9: sample().postures[1]})
    assert values(edit_workbook(before, "x.xlsx", table), MIRROR_SHEET)["B13"] == "45°"


def test_old_results_of_formulas_are_forgotten() -> None:
    """A formula that reads the table loses its stored result; any other formula keeps it."""
    calculated = _replaced(own(), lambda text: NO_VALUE.sub("<v>7</v>", text))
    assert values(calculated, "My notes")["A2"] == 7
    after = edit_workbook(calculated, "x.xlsx", with_angle(sample(), 0, 0, 33))
    assert values(after, "My notes")["A2"] is None
    assert values(after, INPUT_SHEET)["B20"] is None
    assert values(after, "Alone")["A1"] == 7


@pytest.mark.parametrize("name", FILES)
def test_a_posture_is_added_below_the_others(name: str) -> None:
    """A new key gets a row with the last row's format; the legend below moves down unchanged."""
    table = sample()
    wanted = PostureTable({**table.postures, 9: table.postures[1]})
    before, after = FILES[name], edit_workbook(FILES[name], "x.xlsx", wanted)
    assert read_workbook(after, "x.xlsx") == wanted
    one, two = everything(before), everything(after)
    assert two[f"{INPUT_SHEET}!A11"][0] == "9 Key"
    assert two[f"{INPUT_SHEET}!B1"][0] == 10
    for column in "ABCGHMNS":
        assert two[f"{INPUT_SHEET}!{column}11"][1] == one[f"{INPUT_SHEET}!{column}10"][1]
        for row in (11, 12, 13):
            assert two[f"{INPUT_SHEET}!{column}{row + 1}"] == one[f"{INPUT_SHEET}!{column}{row}"]
    changed = {name for name in differing(before, after) if not name.endswith("heights")}
    rows = {f"{INPUT_SHEET}!{c}{r}" for c in "ABCDEFGHIJKLMNOPQRS" for r in (11, 12, 13, 14)}
    assert changed <= rows | {f"{INPUT_SHEET}!B1"}


def test_what_belongs_to_rows_grows_with_them() -> None:
    """After a posture is added, input checks and colour rules cover its row; merged cells move."""
    table = sample()
    after = edit_workbook(own(), "x.xlsx", PostureTable({**table.postures, 9: table.postures[1]}))
    sheet = openpyxl.load_workbook(io.BytesIO(after))[INPUT_SHEET]
    assert {str(one.sqref) for one in sheet.conditional_formatting} == {"B2:S11"}
    assert "B2:S11" in {str(one.sqref) for one in sheet.data_validations.dataValidation}
    assert [str(one) for one in sheet.merged_cells.ranges] == ["B14:G14"]
    assert sheet["W30"].value == "far away"
    assert values(after, INPUT_SHEET)["A20"] == "sum of key 0"


def test_a_row_that_went_is_used_again() -> None:
    """A removed posture leaves an empty row, and the next new posture is written into this row."""
    table = sample()
    fewer = PostureTable({key: row for key, row in table.postures.items() if key != 8})
    without = edit_workbook(own(), "x.xlsx", fewer)
    assert read_workbook(without, "x.xlsx") == fewer
    assert {name.partition("!")[2][1:] for name in differing(own(), without)} == {"1", "10"}
    again = PostureTable({**fewer.postures, 9: table.postures[2]})
    after = edit_workbook(without, "x.xlsx", again)
    assert read_workbook(after, "x.xlsx") == again
    assert everything(after)[f"{INPUT_SHEET}!A10"][0] == "9 Key"


def test_formulas_in_the_table_become_their_numbers() -> None:
    """When an angle is changed, a formula in the table becomes the number that it showed."""
    book = openpyxl.load_workbook(CALC)
    book[INPUT_SHEET]["E2"] = "=-B2"
    formula = _replaced(saved(book), lambda text: NO_VALUE.sub("<v>-45</v>", text))
    assert formulas_in(formula, "x.xlsx", 18) == 1
    assert edit_workbook(formula, "x.xlsx", sample()) is formula
    after = edit_workbook(formula, "x.xlsx", with_angle(sample(), 0, 0, 33))
    assert everything(after)[f"{INPUT_SHEET}!E2"][0] == -45
    assert formulas_in(after, "x.xlsx", 18) == 0


@pytest.mark.parametrize(
    ("place", "formula", "value"),
    [
        ("V2", '=IF(B2&gt;90,"!"," ")', " "),
        ("A2", '="0 Key"', "0 Key"),
        ("B1", "=COUNTA(A2:A10)", "9"),
    ],
)
def test_a_formula_that_is_no_angle_stays(place: str, formula: str, value: str) -> None:
    """A formula beside the table, or for the count or a name of a key, never becomes a number."""
    book = openpyxl.load_workbook(CALC)
    book[INPUT_SHEET][place] = formula
    cell = re.compile(rf'<c r="{place}"([^>]*)>(<f>.*?</f>)<v ?/?>(</v>)?')
    shown = rf'<c r="{place}" t="str"\1>\2<v>{value}</v>'
    data = _replaced(saved(book), lambda text: cell.sub(shown, text))
    assert read_workbook(data, "x.xlsx") == sample()
    assert formulas_in(data, "x.xlsx", 18) == 0
    after = edit_workbook(data, "x.xlsx", with_angle(sample(), 0, 0, 33))
    assert read_workbook(after, "x.xlsx") == with_angle(sample(), 0, 0, 33)
    assert everything(after)[f"{INPUT_SHEET}!{place}"] == everything(data)[f"{INPUT_SHEET}!{place}"]


def test_pictures_and_charts_stay_byte_for_byte() -> None:
    """Charts and sparklines stay byte for byte when one posture changes and another is added."""
    stream = io.BytesIO()
    with xlsxwriter.Workbook(stream) as made:
        cells = posture_cells(sample(), leg_labels(6))
        sheet = made.add_worksheet(INPUT_SHEET)
        for number, row in enumerate(cells):
            sheet.write_row(number, 0, row)
        chart = made.add_chart({"type": "line"})
        chart.add_series({"values": f"='{INPUT_SHEET}'!$B$2:$S$2"})
        sheet.insert_chart("V2", chart)
        sheet.add_sparkline("V20", {"range": f"'{INPUT_SHEET}'!B2:S2"})
    before = stream.getvalue()
    wanted = with_angle(sample(), 3, 7, -12.5)
    after = edit_workbook(before, "x.xlsx", PostureTable({**wanted.postures, 9: (0.5,) * 18}))
    with zipfile.ZipFile(io.BytesIO(before)) as one, zipfile.ZipFile(io.BytesIO(after)) as two:
        assert "xl/charts/chart1.xml" in one.namelist()
        differ = {part for part in one.namelist() if one.read(part) != two.read(part)}
        assert differ == {"xl/worksheets/sheet1.xml"}
        sheet_xml = two.read("xl/worksheets/sheet1.xml")
        assert sheet_xml.endswith(
            one.read("xl/worksheets/sheet1.xml").partition(b"</sheetData>")[2]
        )


def test_the_order_of_calculation_goes_with_a_formula() -> None:
    """When a formula becomes a number, Excel's list of formulas (calcChain.xml) is removed."""
    book = openpyxl.load_workbook(CALC)
    book[INPUT_SHEET]["E2"] = "=-B2"
    parts = {}
    data = _replaced(saved(book), lambda text: NO_VALUE.sub("<v>-45</v>", text))
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        parts = {part: archive.read(part) for part in archive.namelist()}
    parts["xl/calcChain.xml"] = b'<calcChain xmlns="http://schemas.openxmlformats.org/'
    parts["xl/calcChain.xml"] += b'spreadsheetml/2006/main"><c r="E2" i="1"/></calcChain>'
    for part, end, more in (
        (
            "xl/_rels/workbook.xml.rels",
            b"</Relationships>",
            b'<Relationship Id="rId99" Type="http://schemas.openxmlformats.org/officeDocument/2006/'
            b'relationships/calcChain" Target="calcChain.xml"/>',
        ),
        (
            "[Content_Types].xml",
            b"</Types>",
            b'<Override PartName="/xl/calcChain.xml" ContentType="application/vnd.openxmlformats-'
            b'officedocument.spreadsheetml.calcChain+xml"/>',
        ),
    ):
        parts[part] = parts[part].replace(end, more + end)
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for part, content in parts.items():
            archive.writestr(part, content)
    after = edit_workbook(stream.getvalue(), "x.xlsx", with_angle(sample(), 0, 0, 33))
    with zipfile.ZipFile(io.BytesIO(after)) as archive:
        assert "xl/calcChain.xml" not in archive.namelist()
        assert not [part for part in archive.namelist() if b"calcChain" in archive.read(part)]
        for part in ("xl/_rels/workbook.xml.rels", "[Content_Types].xml"):
            ElementTree.fromstring(archive.read(part))


def test_a_shared_formula_lives_on_outside_the_table() -> None:
    """A cell below the table that shared its formula with a table cell keeps the formula."""
    book = openpyxl.load_workbook(CALC)
    book[INPUT_SHEET]["B20"] = 1
    first = '<c r="B2"><f t="shared" ref="B2:B20" si="0">20+25+C30</f><v>45</v></c>'
    last = '<c r="B20"><f t="shared" si="0"/><v>1</v></c>'
    shared = _replaced(
        saved(book),
        lambda text: re.sub(
            '<c r="B20"[^>]*><v>1</v></c>',
            last,
            re.sub('<c r="B2"[^>]*><v>45</v></c>', first, text, count=1),
        ),
    )
    assert formulas_in(shared, "x.xlsx", 18) == 1
    after = edit_workbook(shared, "x.xlsx", with_angle(sample(), 0, 0, 33))
    assert everything(after)[f"{INPUT_SHEET}!B20"][0] == "=20+25+C48"


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda sheet: sheet.__setitem__("A14", "remark 2"), "Insert 1 empty row above row 11"),
        (lambda sheet: sheet.__setitem__("B12", "=1"), "without losing something"),
    ],
)
def test_what_can_t_be_kept_is_refused(change: Callable[[Any], None], said: str) -> None:
    """A new posture is refused if a remark is in its way, or a formula stands in the legend."""
    book = openpyxl.load_workbook(io.BytesIO(ours()))
    change(book[INPUT_SHEET])
    table = sample()
    with pytest.raises(UserError, match=said):
        edit_workbook(saved(book), "x.xlsx", PostureTable({**table.postures, 9: table.postures[1]}))


def test_a_table_of_another_robot_does_not_fit() -> None:
    """A table for eight legs is not saved into a workbook with columns for six legs."""
    file = sample_gait_files("octopod").postures
    assert file is not None
    table = read_gait(file.data, file.name)
    assert isinstance(table, PostureTable)
    with pytest.raises(UserError, match="has a table for 6 legs"):
        edit_workbook(ours(), "x.xlsx", table)


ANGLES = st.integers(-1500, 1500).map(lambda tenths: math.radians(tenths / 10) + 0.0)
TABLES = st.dictionaries(
    st.integers(0, 9), st.lists(ANGLES, min_size=18, max_size=18).map(tuple), min_size=1
).map(PostureTable)


@settings(max_examples=12, deadline=None, phases=[Phase.generate])
@given(st.lists(TABLES, min_size=1, max_size=3), st.sampled_from(sorted(FILES)))
def test_any_tables_one_after_another(tables: list[PostureTable], name: str) -> None:
    """After any tables are saved one after another, each is read back, and all else stays."""
    before = data = FILES[name]
    for table in tables:
        data = edit_workbook(data, "x.xlsx", table)
        assert read_workbook(data, "x.xlsx") == table
    one, two = everything(before), everything(data)
    kept = [key for key in one if not key.startswith(f"{INPUT_SHEET}")]
    assert {key: one[key] for key in kept} == {key: two[key] for key in kept}
    for key in (f"{INPUT_SHEET}!B20", f"{INPUT_SHEET}!W30", f"{INPUT_SHEET} widths"):
        assert one.get(key) == two.get(key)


def _replaced(data: bytes, change: Callable[[str], str]) -> bytes:
    """Return a workbook with the XML of each sheet changed by a function."""
    stream = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(data)) as before, zipfile.ZipFile(stream, "w") as after:
        for part in before.namelist():
            content = before.read(part)
            if part.startswith("xl/worksheets/sheet"):
                assert part
                content = change(content.decode()).encode()
            after.writestr(part, content)
    return stream.getvalue()
