"""Reading and writing Loco-data.txt and LocoTra-data.txt (rules 2)."""

import math

import pytest

from lacoc_shared.gait.tables import SAMPLE_KEYS, LocomotionTable, PostureTable, to_locomotion
from lacoc_shared.gait.text import MAX_BYTES, read_gait, write_gait
from lacoc_shared.mistakes import FileRefused
from lacoc_shared.words import Phrase, render

FIGURE_4_1 = """\
Num of Posture	9
0 Key	45	0	-45	-45	0	45	20	20	20	20	20	20	0	0	0	0	0	0
1 Key	0	0	-45	0	0	45	20	20	20	20	20	20	40	0	40	0	40	0
2 Key	45	0	0	-45	0	0	20	20	20	20	20	20	40	0	40	0	40	0
3 Key	45	0	0	-45	0	0	20	20	20	20	20	20	0	40	0	40	0	40
4 Key	0	0	-45	0	0	45	20	20	20	20	20	20	0	40	0	40	0	40
5 Key	45	0	0	0	0	45	20	20	20	20	20	20	40	0	40	0	40	0
6 Key	45	45	0	-45	0	0	20	20	20	20	20	20	40	0	40	0	40	0
7 Key	45	45	0	-45	0	0	20	20	20	20	20	20	0	40	0	40	0	40
8 Key	45	0	0	0	0	45	20	20	20	20	20	20	0	40	0	40	0	40
ID of Joint	0	1	2	3	4	5	6	7	8	9	10	11	12	13	14	15	16	17
Position	R,F	R,C	R,B	L,B	L,C	L,F	R,F	R,C	R,B	L,B	L,C	L,F	R,F	R,C	R,B	L,B	L,C	L,F
	Root						1st						2nd
"""
FIGURE_4_2 = """\
4
1
45	0	-45	-45	0	45	20	20	20	20	20	20	0	0	0	0	0	0
4
45	0	0	0	0	45	20	20	20	20	20	20	0	40	0	40	0	40
45	45	0	-45	0	0	20	20	20	20	20	20	0	40	0	40	0	40
45	45	0	-45	0	0	20	20	20	20	20	20	40	0	40	0	40	0
45	0	0	0	0	45	20	20	20	20	20	20	40	0	40	0	40	0
4
0	0	-45	0	0	45	20	20	20	20	20	20	40	0	40	0	40	0
45	0	0	-45	0	0	20	20	20	20	20	20	40	0	40	0	40	0
45	0	0	-45	0	0	20	20	20	20	20	20	0	40	0	40	0	40
0	0	-45	0	0	45	20	20	20	20	20	20	0	40	0	40	0	40
4
45	0	0	0	0	45	20	20	20	20	20	20	40	0	40	0	40	0
45	45	0	-45	0	0	20	20	20	20	20	20	40	0	40	0	40	0
45	45	0	-45	0	0	20	20	20	20	20	20	0	40	0	40	0	40
45	0	0	0	0	45	20	20	20	20	20	20	0	40	0	40	0	40
"""


def _row(first: str) -> bytes:
    """Return a Loco-data text of one posture, with the given text as its first angle."""
    return f"Num of Posture\t1\n0 Key\t{first}{chr(9)}0".encode() + b"\t0" * 16 + b"\n"


def test_figure_4_1_is_read(workshop, legs):
    """The text of workshop Fig. 4-1 reads as the workshop's nine postures."""
    assert read_gait(FIGURE_4_1.encode(), "Loco-data.txt", legs=legs) == workshop


def test_figure_4_2_is_read(workshop, legs):
    """The 18 lines of workshop Fig. 4-2 read as the four sample keys."""
    assert len(FIGURE_4_2.splitlines()) == 18
    table = read_gait(FIGURE_4_2.encode(), "LocoTra-data.txt", legs=legs)
    assert table == to_locomotion(workshop, SAMPLE_KEYS)


def test_the_figures_are_written(workshop, legs):
    """We write the layout of workshop Fig. 4-1 and Fig. 4-2, legend rows included."""
    assert write_gait(workshop, legs).decode() == FIGURE_4_1
    assert write_gait(to_locomotion(workshop, SAMPLE_KEYS), legs).decode() == FIGURE_4_2


def test_writing_for_other_legs_is_an_error(workshop):
    """Writing a table with labels for another number of legs raises ValueError."""
    with pytest.raises(ValueError, match="18 joints is not for 4 legs"):
        write_gait(workshop, ("a", "b", "c", "d"))


@pytest.mark.parametrize(
    ("cell", "degrees"),
    [
        ("45", 45),
        ("45.0", 45),
        ("4.5E+01", 45),
        ("4.5e1", 45),
        ("45,0", 45),
        ("+45", 45),
        ("-22.5", -22.5),
        (".5", 0.5),
        ("45.", 45),
        ("４５", 45),
        ("４５．５", 45.5),
        ("－４５", -45),
        ("−45", -45),
        ("\N{FULLWIDTH HYPHEN-MINUS}45", -45),
        ("＋４，５", 4.5),
        ("４．５Ｅ＋０１", 45),
        ('"45"', 45),
        ('"-22,5"', -22.5),
        ("  45 ", 45),
        ("\N{IDEOGRAPHIC SPACE}45", 45),
        ("150", 150),
        ("-150", -150),
        ("-0", 0),
    ],
)
def test_numbers_may_be_written_in_many_ways(cell, degrees):
    """A number may have a comma, an exponent, full-width digits, any minus sign or quotes."""
    assert read_gait(_row(cell), "x").postures[0][0] == math.radians(degrees)


def test_zero_has_one_sign():
    """An angle written as -0.0 reads as +0.0, so that files with equal angles give equal bits."""
    assert math.copysign(1, read_gait(_row("-0.0"), "x").postures[0][0]) == 1


@pytest.mark.parametrize("text", [FIGURE_4_1, FIGURE_4_2], ids=["Loco-data", "LocoTra-data"])
@pytest.mark.parametrize(
    "change",
    [
        pytest.param(lambda t: t.replace("\n", "\r\n"), id="CRLF"),
        pytest.param(lambda t: t.replace("\n", "\r"), id="CR"),
        pytest.param(lambda t: t.rstrip("\n"), id="no last line end"),
        pytest.param(lambda t: "\n\n" + t.replace("\n", "\n \n\t\t\n") + "\n\n", id="blank lines"),
        pytest.param(lambda t: t.replace("\n", "\t\t \t\n"), id="empty cells at the end"),
        pytest.param(lambda t: t.replace("\t", " "), id="a space"),
        pytest.param(lambda t: t.replace("\t", "   "), id="runs of spaces"),
        pytest.param(lambda t: t.replace("\t", "　"), id="full-width spaces"),
        pytest.param(lambda t: t.replace("0", "０").replace("-", "－"), id="full-width"),
        pytest.param(lambda t: t.replace("-", "−"), id="U+2212"),
        pytest.param(lambda t: t.replace("45", "45,0"), id="decimal commas"),
        pytest.param(lambda t: t.replace("-", "ー").replace("45", "45。0"), id="Japanese signs"),
        pytest.param(lambda t: t.replace("-", "–").replace("45", "45°"), id="dashes and degrees"),
        pytest.param(
            lambda t: "\n".join(
                "\t".join(f'"{c}"' if c else "" for c in line.split("\t"))
                for line in t.splitlines()
            ),
            id="quoted cells",
        ),
        pytest.param(
            lambda t: "\n".join(
                " ".join(f'"{c}"' for c in line.split("\t") if c) for line in t.splitlines()
            ),
            id="quoted cells with spaces between",
        ),
        pytest.param(
            lambda t: t.split("ID of Joint")[0],
            id="no legend",
        ),
        pytest.param(
            lambda t: t.replace("ID of Joint", "関節").replace("Position", "位置"),
            id="legend in Japanese",
        ),
        pytest.param(lambda t: t.replace("Key", "KEY").replace("Num", "num"), id="case"),
        pytest.param(lambda t: t.replace(" Key", "Key"), id="no space in the keys"),
        pytest.param(lambda t: t.replace(" ", "\u00a0"), id="spaces that break no line"),
    ],
)
def test_layouts_that_mean_the_same(text, change):
    """Line ends, blank lines, spaces for tabs and a missing legend do not change what is read."""
    plain = read_gait(text.encode(), "x")
    notes: list[Phrase] = []
    assert read_gait(change(text).encode(), "x", notes=notes) == plain
    assert notes == []


@pytest.mark.parametrize("text", [FIGURE_4_1, FIGURE_4_2], ids=["Loco-data", "LocoTra-data"])
@pytest.mark.parametrize(
    "encode",
    [
        pytest.param(lambda t: t.encode("utf-8"), id="UTF-8"),
        pytest.param(lambda t: t.encode("utf-8-sig"), id="UTF-8 with BOM"),
        pytest.param(lambda t: b"\xff\xfe" + t.encode("utf-16-le"), id="UTF-16 LE with BOM"),
        pytest.param(lambda t: b"\xfe\xff" + t.encode("utf-16-be"), id="UTF-16 BE with BOM"),
        pytest.param(lambda t: t.encode("utf-16-le"), id="UTF-16 LE"),
        pytest.param(lambda t: t.encode("utf-16-be"), id="UTF-16 BE"),
        pytest.param(lambda t: t.encode("cp932"), id="Shift-JIS"),
    ],
)
def test_encodings(text, encode):
    """A text reads the same in UTF-8, UTF-16 and Shift-JIS, with or without a byte order mark."""
    japanese = text.replace("ID of Joint", "関節").replace("45", "４５").replace("-", "－")
    assert read_gait(encode(japanese), "x") == read_gait(text.encode(), "x")


def test_a_row_without_a_tab_is_split_by_spaces_on_its_own():
    """A row with tabs is split by tabs, and a row without tabs is split by spaces."""
    lines = FIGURE_4_1.splitlines()
    lines[3] = lines[3].replace("\t", "  ")
    assert read_gait("\n".join(lines).encode(), "x") == read_gait(FIGURE_4_1.encode(), "x")


def test_the_order_and_the_choice_of_keys_is_free():
    """A file may leave out keys and list them in any order."""
    angles = "\t0" * 18
    table = read_gait(f"Num of Posture\t2\n9 Key{angles}\n3 Key{angles}\n".encode(), "x")
    assert sorted(table.postures) == [3, 9]


@pytest.mark.parametrize("legs", [4, 6, 8])
def test_three_columns_a_leg(legs):
    """The gait of a robot with 4, 6 or 8 legs has 12, 18 or 24 columns."""
    row = "\t".join(["10"] * (3 * legs))
    data = f"1\n1\n{row}\n".encode()
    for known in (None, legs, [str(leg) for leg in range(legs)]):
        assert read_gait(data, "x", legs=known).joints == 3 * legs


def test_the_largest_files_are_read():
    """Loco-data may have 10 postures, and LocoTra-data 10 keys and 100 postures for a key."""
    angles = "\t0" * 18
    rows = "".join(f"{digit} Key{angles}\n" for digit in range(10))
    assert len(read_gait(f"Num of Posture\t10\n{rows}".encode(), "x").postures) == 10
    row = angles.strip() + "\n"
    data = ("10\n" + "1\n" + row + f"100\n{row * 100}" + ("1\n" + row) * 8).encode()
    assert [len(s) for s in read_gait(data, "x").sequences] == [1, 100, *[1] * 8]


def test_at_most_32_kib():
    """A file of 32 KiB is read, and one that is a byte longer is refused (rules 2)."""
    data = FIGURE_4_1.encode().ljust(MAX_BYTES, b"\n")
    assert isinstance(read_gait(data, "x"), PostureTable)
    with pytest.raises(FileRefused, match="32769 bytes, expected a gait file of at most 32 KiB"):
        read_gait(data + b"\n", "x")


def test_a_range_for_each_joint():
    """Each joint may have its own range of angles, and an angle outside its range is a mistake."""
    data = FIGURE_4_2.encode()
    limits = [(-45.0, 45.0)] * 6 + [(0.0, 20.0)] * 6 + [(0.0, 40.0)] * 6
    assert isinstance(read_gait(data, "x", legs=6, range_deg=limits), LocomotionTable)
    limits[6] = (0.0, 19.5)
    with pytest.raises(FileRefused) as refusal:
        read_gait(data, "x", legs=6, range_deg=limits)
    assert {(m.column, m.joint, render(m.expected)) for m in refusal.value.mistakes} == {
        (7, 6, "an angle from 0 to 19.5 degrees")
    }
    assert len(refusal.value.mistakes) == 13
    with pytest.raises(FileRefused):
        read_gait(data, "x", range_deg=44.9)


@pytest.mark.parametrize(
    ("data", "count"),
    [
        (b"1\n" * 16_000, 1),
        (b"9\n9\n" + (b"\t".join([b"x"] * 18) + b"\n") * 880, 1000),
        (b"\t" * 32_000, 1),
    ],
    ids=["lines", "mistakes", "tabs"],
)
def test_garbage_is_refused_soon(data: bytes, count: int) -> None:
    """Garbage is refused with one mistake, or with the first 1,000 mistakes."""
    with pytest.raises(FileRefused) as refusal:
        read_gait(data, "Loco-data.txt")
    assert len(refusal.value.mistakes) == count


def test_a_mirrored_sheet_shows_empty_cells_as_0():
    """A 0 that LibreOffice saves for an empty cell of the header or legend is ignored."""
    rows = [line.split("\t") for line in [*FIGURE_4_1.splitlines(), "", "", ""]]
    mirrored = "\n".join("\t".join(c or "0" for c in (row + [""] * 19)[:19]) for row in rows)
    assert mirrored.startswith("Num of Posture\t9\t0\t0")
    assert read_gait(mirrored.encode(), "x") == read_gait(FIGURE_4_1.encode(), "x")


def test_what_stands_below_the_legend_is_said():
    """Text below the legend gives a note that it is not read; a row of zeros there gives none."""
    notes: list[Phrase] = []
    text = f"{FIGURE_4_1.rstrip()}\nmade by Anna\t2026\n" + "\t".join("0" * 19)
    read_gait(text.encode(), "x", notes=notes)
    row = len(FIGURE_4_1.rstrip().splitlines()) + 1
    assert [*map(render, notes)] == [
        f'x, row {row}: "made by Anna" stands below the legend and is not read.'
    ]


@pytest.mark.parametrize(
    ("was", "now", "said"),
    [
        ("ID of Joint\t0\t1", "ID of Joint\t1\t0", "says 1, but this is the column of joint 0"),
        ("Position\tR,F", "Position\tLB", "says LB, but joint 0 is a joint of leg R,F"),
        ("\tRoot\t", "\t2nd\t", "says 2nd, but joint 0 is a joint of level Root"),
    ],
)
def test_a_legend_that_contradicts_the_columns_is_said(was, now, said):
    """A legend that contradicts the order of the columns gives a note, and the order is used."""
    notes: list[Phrase] = []
    assert was in FIGURE_4_1
    text = FIGURE_4_1.replace(was, now)
    assert read_gait(text.encode(), "x", notes=notes) == read_gait(FIGURE_4_1.encode(), "x")
    (note,) = map(render, notes)
    assert said in note
    assert note.endswith("Each angle goes to the joint of its column, whatever the legend says.")
