"""Loco-data.xlsx, read and written (workshop 4-1, rules 2)."""

import io
import math
import re
import zipfile

import openpyxl
import pytest
from workbook_bombs import (
    parts_of,
    with_cells,
    with_formats,
    with_formulas,
    with_sheets,
    with_text,
    zipped,
)

from lacoc_shared.gait.tables import SAMPLE_KEYS, PostureTable, to_locomotion
from lacoc_shared.gait.text import read_gait, write_gait
from lacoc_shared.gait.workbook import INPUT_SHEET, MIRROR_SHEET
from lacoc_shared.gait.workbook.content import MAX_BYTES
from lacoc_shared.gait.workbook.file import read_gait_file, read_workbook, write_workbook
from lacoc_shared.mistakes import FileRefused, UserError
from lacoc_shared.words import Phrase, render


@pytest.fixture(scope="module")
def sample(workshop, legs) -> bytes:
    """Give the workshop's table as a workbook that we wrote."""
    return write_workbook(workshop, legs)


def edited(data: bytes, sheet: str = INPUT_SHEET, **cells: object) -> bytes:
    """Return a workbook with new values in cells, saved by a program that can't calculate."""
    book = openpyxl.load_workbook(io.BytesIO(data))
    for cell, value in cells.items():
        book[sheet][cell] = value
    return saved(book)


def saved(book: openpyxl.Workbook) -> bytes:
    """Return the bytes of a workbook."""
    stream = io.BytesIO()
    book.save(stream)
    return stream.getvalue()


def refused(data: bytes, **robot: object) -> list[tuple[object, ...]]:
    """Return the mistakes for which a workbook is refused.

    Each mistake is a tuple: row, column, joint, leg, field, found, expected.
    """
    with pytest.raises(FileRefused) as refusal:
        read_workbook(data, "x.xlsx", **robot)
    assert {m.file for m in refusal.value.mistakes} == {"x.xlsx"}
    return [
        (m.row, m.column, m.joint, m.leg, m.field, m.found, m.expected)
        for m in (mistake.in_words() for mistake in refusal.value.mistakes)
    ]


def test_both_sheets_have_the_cells_of_figure_4_1(sample, workshop, legs):
    """Both sheets hold workshop Fig. 4-1 from cell A1 on, one as values and one as formulas."""
    values = openpyxl.load_workbook(io.BytesIO(sample), data_only=True)
    assert values.sheetnames == [INPUT_SHEET, MIRROR_SHEET]
    text = [line.split("\t") for line in write_gait(workshop, legs).decode().splitlines()]
    for sheet in values:
        shown = [
            ["" if cell is None else str(cell) for cell in row]
            for row in sheet.iter_rows(values_only=True)
        ]
        trimmed = [line[: max(i for i, cell in enumerate(line) if cell) + 1] for line in text]
        for row, line in zip(shown, trimmed, strict=False):
            assert row[: len(line)] == line
            assert not any(row[len(line) :])
        assert not any(cell for row in shown[len(text) :] for cell in row)


def test_the_mirror_is_made_of_live_formulas_with_values(sample):
    """Each formula has a stored value, for programs that don't calculate."""
    formulas = openpyxl.load_workbook(io.BytesIO(sample))[MIRROR_SHEET]
    values = openpyxl.load_workbook(io.BytesIO(sample), data_only=True)
    for row in formulas["A1:S13"]:
        for cell in row:
            assert str(cell.value).startswith("=IF(INDEX('EX (input)'!$A:$S,ROW(),COLUMN())")
            shown, typed = (values[name][cell.coordinate].value for name in values.sheetnames)
            assert shown == typed


def test_a_workbook_is_the_same_file_each_time(sample, workshop, legs):
    """The same table always gives the same bytes, without a date or a random name."""
    assert write_workbook(workshop, legs) == sample


def test_the_edited_sheet_is_what_counts(sample, workshop):
    """The sheet "EX (input)" is read, not the formulas of the sheet "Loco-data" (rules 2)."""
    table = read_workbook(edited(sample, B2=-22.5, C2="３０,５"), "x")
    assert table.postures[0][:3] == (
        math.radians(-22.5),
        math.radians(30.5),
        workshop.postures[0][2],
    )
    assert table.postures[1] == workshop.postures[1]


def test_loco_data_alone_is_read(sample, workshop):
    """A workbook whose only sheet is "Loco-data" is read."""
    book = openpyxl.load_workbook(io.BytesIO(sample), data_only=True)
    del book[INPUT_SHEET]
    assert read_workbook(saved(book), "x") == workshop


def test_formulas_that_show_nothing_are_empty_cells(sample, workshop):
    """The stored value of a formula is read, and the value "" is read as an empty cell."""
    with zipfile.ZipFile(io.BytesIO(sample)) as archive:
        parts = {name: archive.read(name) for name in archive.namelist()}
    mirror = b'<sheet name="Loco-data" sheetId="2" r:id="rId2"/>'
    sheets = parts["xl/workbook.xml"].partition(b"<sheets>")[2].partition(b"</sheets>")[0]
    assert sheets.endswith(mirror)
    parts["xl/workbook.xml"] = parts["xl/workbook.xml"].replace(sheets, mirror)
    assert read_workbook(zipped(parts), "x") == workshop


def test_a_typed_table_is_read():
    """A plain workbook without a legend, with blank rows and numbers as text, is read."""
    book = openpyxl.Workbook()
    sheet = book.active
    sheet.title = INPUT_SHEET
    sheet.append(["Num of Posture", "1"])
    sheet.append([])
    sheet.append(["0 Key", *["１"] * 6, *[2.0] * 6, *[3] * 6])
    (posture,) = read_workbook(saved(book), "x").postures.values()
    assert posture == tuple(math.radians(value) for value in [1] * 6 + [2] * 6 + [3] * 6)


def test_three_planted_mistakes_are_three_mistakes_with_their_cells(sample, legs):
    """Every mistake is listed with its row, column, cell, joint and leg."""
    data = edited(sample, E3=151, M6="abc", T2=1, S10=True)
    angle = "an angle from -150 to 150 degrees"
    many = "18 angles (3 for each of 6 legs)"
    assert refused(data, legs=legs) == [
        (2, None, None, None, "EX (input)", "19 angles", many),
        (3, 5, 3, "L,B", "EX (input)!E3", "151", angle),
        (6, 13, 11, "L,F", "EX (input)!M6", '"abc"', angle),
        (10, 19, 17, "L,F", "EX (input)!S10", '"TRUE"', angle),
    ]


def test_empty_cells_and_formulas_without_a_value(sample):
    """An empty cell is a mistake, and so is a formula without a stored value."""
    found = [mistake[4:6] for mistake in refused(edited(sample, B2=None, C2="=D2*2"))]
    assert found == [
        ("EX (input)!B2", "nothing"),
        (
            "EX (input)!C2",
            'the formula "=D2*2" without a result: open the file in Excel or LibreOffice and '
            "save it",
        ),
    ]


def test_a_workbook_for_another_robot_is_called_so(sample):
    """A workbook for another robot is refused; the message has the number of legs of both."""
    ((row, column, *_, found, expected),) = refused(sample, legs=8)
    assert (row, column) == (2, None)
    assert found == "18 angles in a row: a gait for a robot with 6 legs"
    assert expected == "24 angles in a row: this robot has 8 legs"


def test_sequences_are_not_for_workbooks():
    """A workbook with sequences of postures is refused: they belong in LocoTra-data.txt."""
    book = openpyxl.Workbook()
    book.active.title = INPUT_SHEET
    for row in [1], [1], [0] * 18:
        book.active.append(row)
    assert refused(saved(book))[0][5:] == (
        "sequences of postures",
        '"Num of Posture" in cell A1 (Loco-data). Sequences belong in a text file '
        "(LocoTra-data.txt)",
    )


def test_a_workbook_is_not_told_to_be_a_text_file(sample):
    """A message about a workbook gives no advice for text files."""
    mistakes = refused(edited(sample, A1="Number"))
    assert mistakes[0][5:] == (
        '"Number"',
        '"Num of Posture" and the number of postures (Loco-data)',
    )


def test_other_sheets_are_named():
    """A workbook without the expected sheet is refused, and the message names its sheets."""
    book = openpyxl.Workbook()
    book.create_sheet(MIRROR_SHEET)
    assert refused(saved(book))[0][5:] == (
        'the sheets "Sheet" and "Loco-data"',
        'a sheet "EX (input)", or a workbook whose only sheet is "Loco-data"',
    )


def locked(data: bytes) -> bytes:
    """Return a zip with every part marked as protected by a password."""
    data = bytearray(data)
    for signature, flags in ((b"PK\x01\x02", 8), (b"PK\x03\x04", 6)):
        place = data.find(signature)
        while place >= 0:
            data[place + flags] |= 1
            place = data.find(signature, place + 1)
    return bytes(data)


WANTED = "an .xlsx workbook without a password, as spreadsheet programs save it"


@pytest.mark.parametrize(
    ("data", "found", "expected"),
    [
        (b"", "a damaged file, or not a workbook", WANTED),
        (b"Num of Posture\t1\n", "a damaged file, or not a workbook", WANTED),
        (b"PK\x03\x04 and no more", "a damaged file, or not a workbook", WANTED),
        (
            b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(600),
            "an old .xls workbook, or one with a password",
            WANTED,
        ),
        (zipped({"mimetype": b"text/plain"}), "a workbook that can't be read", WANTED),
        (zipped({"[Content_Types].xml": b"<no xml"}), "a workbook that can't be read", WANTED),
        (locked(zipped({"xl/workbook.xml": b"<x/>"})), "a file with a password", WANTED),
        (
            zipped({"xl/workbook.xml": b" " * (8 * MAX_BYTES + 1)}),
            "a workbook that unpacks to more than 8 MiB",
            "a table of angles",
        ),
        (
            zipped({"mimetype": b"", "content.xml": b""}),
            "an OpenDocument file, such as .ods",
            "the table saved as .xlsx, or as text with tabs",
        ),
        (
            zipped({"word/document.xml": b""}),
            "a Word document (.docx)",
            "the table saved as .xlsx, or as text with tabs",
        ),
        (bytes(MAX_BYTES + 1), "more than 1048576 bytes", "a workbook of at most 1 MiB"),
    ],
    ids=["empty", "text", "cut", "old", "zip", "xml", "password", "bomb", "ods", "docx", "large"],
)
def test_what_is_no_workbook(data, found, expected):
    """A file that is not a workbook is refused with words that say what it seems to be."""
    assert refused(data) == [(None, None, None, None, None, found, expected)]


@pytest.mark.parametrize(
    ("bomb", "found"),
    [
        (lambda data: with_formulas(data, 6_000_000, 20), "formulas have more than"),
        (lambda data: with_formulas(data, 3000, 25_000), "formulas have more than"),
        (lambda data: with_formats(data, 500, 20_000), "more than 50000 elements"),
        (lambda data: with_sheets(data, 100), "more than 50000 elements"),
        (
            lambda data: zipped(with_cells(data, f'<c r="{"A" * 9000}"><v>1</v></c>')),
            "too much memory or time",
        ),
    ],
    ids=["formula", "formulas", "formats", "sheets", "attribute"],
)
def test_what_a_small_file_repeats_is_counted_before_it_is_read(sample, bomb, found):
    """Formulas, formats and sheets that a small file uses very often are refused."""
    data = bomb(sample)
    assert len(data) < MAX_BYTES / 10
    assert found in refused(data)[0][5]


def test_a_long_text_in_many_cells_costs_what_one_costs(sample):
    """A text of 200,000 characters that 20,000 cells show is refused for its cells alone."""
    data = with_text(sample, 200_000, 20_000)
    assert len(data) < MAX_BYTES / 10
    (first, *_) = refused(data)
    assert len(first[5]) < 300


def strict(data: bytes) -> bytes:
    """Return a workbook as Excel saves it as "Strict Open XML Spreadsheet"."""
    parts = {
        name: re.sub(
            rb"http://schemas.openxmlformats.org/(officeDocument|spreadsheetml|drawingml)/2006/",
            rb"http://purl.oclc.org/ooxml/\1/",
            part,
        )
        for name, part in parts_of(data).items()
    }
    assert b"purl.oclc.org/ooxml/spreadsheetml/main" in parts["xl/workbook.xml"]
    return zipped(parts)


def test_strict_open_xml_is_read(sample, workshop, legs):
    """The other kind of .xlsx that Excel saves is read, and its mistakes name their cells."""
    assert read_workbook(strict(sample), "x") == workshop
    assert refused(strict(edited(sample, E3=151)), legs=legs)[0][4:6] == ("EX (input)!E3", "151")


@pytest.mark.parametrize("title", ["EX（input）", "ex (INPUT)", "EX(input)", "　EX (input) "])
def test_a_sheet_is_found_by_what_its_name_looks_like(sample, workshop, title):
    """Widths, cases and spaces of a sheet's name do not matter."""
    book = openpyxl.load_workbook(io.BytesIO(sample))
    book[INPUT_SHEET].title = "another"  # else openpyxl takes the same name for a second one
    book["another"].title = title
    assert read_workbook(saved(book), "x") == workshop


def test_a_date_is_named(sample):
    """A number that a spreadsheet shows as a date is refused as one, with what to do."""
    book = openpyxl.load_workbook(io.BytesIO(sample))
    book[INPUT_SHEET]["C2"].number_format = "yyyy-mm-dd"
    book[INPUT_SHEET]["C2"] = 12
    ((*_, field, found, _),) = refused(saved(book))
    assert field == "EX (input)!C2"
    assert found.startswith('the date "1900-01-12 00:00:00": give this cell the format Number')


def test_a_percentage_is_noted(sample):
    """A number that a spreadsheet shows as 45 % is read as what it is, with a note."""
    book = openpyxl.load_workbook(io.BytesIO(sample))
    book[INPUT_SHEET]["C2"].number_format = "0%"
    book[INPUT_SHEET]["C2"] = 0.45
    notes: list[Phrase] = []
    table = read_workbook(saved(book), "x.xlsx", notes=notes)
    assert math.degrees(table.postures[0][1]) == pytest.approx(0.45)
    assert [render(note, "en") for note in notes] == [
        "x.xlsx: EX (input)!C2 is shown as a percentage; it counts as 0.45 degrees."
    ]


def test_radians_are_noted(workshop, legs):
    """A table without an angle above half a turn in radians is read, with a note."""
    small = PostureTable(
        {
            digit: tuple(math.radians(angle) for angle in posture)
            for digit, posture in workshop.postures.items()
        }
    )
    usual: list[Phrase] = []
    read_gait(write_gait(workshop, legs), "x", notes=usual)
    assert usual == []
    for data, read in (
        (write_workbook(small, legs), read_workbook),
        (write_gait(small, legs), read_gait),
    ):
        notes: list[Phrase] = []
        assert read(data, "x", notes=notes) == small
        assert [note.code for note in notes] == ["gait.radians"]
        notes.clear()


def test_an_entity_bomb_is_refused(sample):
    """A workbook that defines XML entities is refused, as parsing could need endless memory."""
    with zipfile.ZipFile(io.BytesIO(sample)) as archive:
        parts = {name: archive.read(name) for name in archive.namelist()}
    entities = "".join(f'<!ENTITY e{n} "{f"&e{n - 1};" * 20}">' for n in range(1, 12))
    parts["xl/sharedStrings.xml"] = (
        f'<!DOCTYPE sst [<!ENTITY e0 "ha">{entities}]>'
        '<sst xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main">'
        "<si><t>&e11;</t></si></sst>"
    ).encode()
    assert refused(zipped(parts))[0][5] == "a workbook that defines XML entities"


@pytest.mark.parametrize(
    "content", ["<si/>" * 60_000, "<si><t>a</t></si>" * 30_000], ids=["empty", "strings"]
)
def test_more_xml_than_a_table_has_is_refused(sample, content):
    """A workbook of more than 50,000 XML elements is refused, even if it unpacks to few bytes."""
    with zipfile.ZipFile(io.BytesIO(sample)) as archive:
        parts = {name: archive.read(name) for name in archive.namelist()}
    main = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
    parts["xl/sharedStrings.xml"] = f'<sst xmlns="{main}">{content}</sst>'.encode()
    assert refused(zipped(parts))[0][5] == "a workbook of more than 50000 elements"


def test_a_row_far_below_costs_nothing(sample):
    """A sheet that claims the largest possible size is read, but a cell in its last row is not."""
    with zipfile.ZipFile(io.BytesIO(sample)) as archive:
        parts = {name: archive.read(name) for name in archive.namelist()}
    sheet = parts["xl/worksheets/sheet1.xml"]
    sheet = sheet.replace(b'ref="A1:S13"', b'ref="A1:XFD1048576"')
    parts["xl/worksheets/sheet1.xml"] = sheet.replace(
        b"</sheetData>", b'<row r="1048576"><c r="XFD1048576"><v>1</v></c></row></sheetData>'
    )
    assert len(read_workbook(zipped(parts), "x").postures) == 9


def test_a_file_is_told_by_its_content(tmp_path, sample, workshop, legs):
    """The content decides whether a file is a text or a workbook; its name does not."""
    locomotion = to_locomotion(workshop, SAMPLE_KEYS)
    for name, data, table in (
        ("Loco-data.xlsx", sample, workshop),
        ("LocoTra-data.txt", sample, workshop),
        ("Loco-data.txt", write_gait(workshop, legs), workshop),
        ("book.xlsx", write_gait(locomotion, legs), locomotion),
    ):
        path = tmp_path / name
        path.write_bytes(data)
        assert read_gait_file(path, legs=legs) == table


def test_a_file_that_is_not_there(tmp_path):
    """The error for a missing file names the file and gives the reason."""
    with pytest.raises(UserError, match=r"Cannot read .*none\.txt: No such file or directory\."):
        read_gait_file(tmp_path / "none.txt")


def test_a_label_is_text(workshop):
    """A leg's label comes from anybody's robot file, and is never a formula or a link."""
    labels = ["=1+2", "http://a", "@SUM(A1)", "R,B", "L,B", "L,C"]
    sheet = openpyxl.load_workbook(io.BytesIO(write_workbook(workshop, labels)))[INPUT_SHEET]
    assert [sheet.cell(12, column).value for column in range(2, 8)] == labels
    assert {sheet.cell(12, column).data_type for column in range(2, 8)} == {"s"}
    assert not any(sheet.cell(12, column).hyperlink for column in range(2, 8))
