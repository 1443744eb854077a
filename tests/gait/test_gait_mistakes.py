"""Every mistake of a gait file is reported with its place (rules 2)."""

import pytest

from lacoc_shared.gait.text import read_gait
from lacoc_shared.mistakes import FileRefused, Mistake

ANGLE = "an angle from -150 to 150 degrees"
NO_HEADER = (
    '"Num of Posture" and the number of postures (Loco-data), '
    "or only the number of keys (LocoTra-data)"
)

CSV = (
    "commas or semicolons between the cells (CSV)",
    "tabs between the cells. Save the table as text with tabs, or as .xlsx",
)


def refused(data: bytes | str, **robot) -> list[Mistake]:
    """Return the mistakes for which a file is refused."""
    with pytest.raises(FileRefused) as refusal:
        read_gait(data.encode() if isinstance(data, str) else data, "gait.txt", **robot)
    assert all(mistake.file == "gait.txt" for mistake in refusal.value.mistakes)
    return [mistake.in_words() for mistake in refusal.value.mistakes]


def places(mistakes: list[Mistake]) -> list[tuple[object, ...]]:
    """Return each mistake as a tuple: row, column, joint, leg, found, expected."""
    return [(m.row, m.column, m.joint, m.leg, m.found, m.expected) for m in mistakes]


def loco(rows: list[str], announced: object = None) -> str:
    """Return a Loco-data text with these rows; `announced` replaces their number in the header."""
    return f"Num of Posture\t{len(rows) if announced is None else announced}\n" + "\n".join(rows)


def posture(label: str = "0 Key", angles: int = 18, **cells: str) -> str:
    """Return a row with a label and zeros; a cell j3 replaces the angle of joint 3."""
    return "\t".join([label, *(cells.get(f"j{joint}", "0") for joint in range(angles))]).strip()


def test_three_planted_mistakes_are_three_mistakes():
    """Three mistakes are all listed, each with row, column, joint, leg, found and expected."""
    text = loco([posture(j3="151"), posture("1 Key", j11="nan"), posture("2 Key", j16="4S")])
    assert places(refused(text, legs=("A", "B", "C", "D", "E", "F"))) == [
        (2, 5, 3, "D", "151", ANGLE),
        (3, 13, 11, "F", '"nan"', ANGLE),
        (4, 18, 16, "E", '"4S"', ANGLE),
    ]


def test_three_planted_mistakes_at_the_locomotion_level():
    """Mistakes of a LocoTra-data file are listed too; blank lines count as rows."""
    row = posture("", j0="0")
    text = f"2\n\n1\n{posture('', j17='-150.01')}\n3\n{row}\n{posture('', j0='x', j6='')}\n"
    assert places(refused(text)) == [
        (4, 18, 17, "L,F", "-150.01", ANGLE),
        (
            5,
            1,
            None,
            None,
            "the number 3, but 2 rows of angles below it",
            "as many rows as the file says for key [1]",
        ),
        (7, 1, 0, "R,F", '"x"', ANGLE),
        (7, 7, 6, "R,F", "nothing", ANGLE),
    ]


@pytest.mark.parametrize(
    "cell",
    ["nan", "NaN", "inf", "-inf", "Infinity", "1e999", "-1E+999", "150.0001", "-151", "999999"],
)
def test_nothing_is_clamped(cell):
    """NaN, infinity and angles out of range are mistakes; no angle is clamped."""
    assert [m.place for m in refused(loco([posture(j13=cell)]))] == [
        "row 2, column 15, joint 13 (R,C)"
    ]


@pytest.mark.parametrize(
    "cell",
    ["abc", "4 5", "1.2.3", "1,234.5", "--4", "45°°", "4²", "½", "①5", "0x10", "1_0", "٤٥", "4–5"],
)
def test_what_is_no_number(cell):
    """A cell must hold a number, written in an allowed form (rules 2); all else is a mistake."""
    (mistake,) = refused(loco([posture(j0=cell)]))
    assert (mistake.row, mistake.column, mistake.joint, mistake.leg) == (2, 2, 0, "R,F")
    assert mistake.found == f'"{cell}"'


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        pytest.param("", [(None, None, "an empty file", "a table of angles")], id="empty"),
        pytest.param(
            "\n \n\t\n", [(None, None, "an empty file", "a table of angles")], id="only blanks"
        ),
        pytest.param(
            "time_s\tx_m\ty_m\n" + "0.02\t0.1\t0.2\n" * 9000,
            [
                (
                    *(None, None),
                    "the path of a robot (Pos-data)",
                    "a gait (Loco-data or LocoTra-data)",
                )
            ],
            id="Pos-data",
        ),
        pytest.param(
            loco([posture(), posture("1 Key")]).replace("\t", ","), [(None, None, *CSV)], id="CSV"
        ),
        pytest.param(
            loco([posture(j0="4,5")]).replace("\t", ";"), [(None, None, *CSV)], id="CSV with ;"
        ),
        pytest.param("hello world", [(1, 1, '"hello"', NO_HEADER)], id="another text"),
        pytest.param(
            posture(),
            [(1, 1, '"0 Key"', NO_HEADER)],
            id="no header",
        ),
        pytest.param(
            "Number\t1\n" + posture(j1="?"),
            [(1, 1, '"Number"', NO_HEADER), (2, 3, '"?"', ANGLE)],
            id="another header",
        ),
        pytest.param(
            loco([posture()], announced=""),
            [(1, 2, "nothing", "the number of postures, a whole number from 1 to 10")],
            id="no number",
        ),
        pytest.param(
            loco([posture()], announced="1.5"),
            [(1, 2, "1.5", "the number of postures, a whole number from 1 to 10")],
            id="half a posture",
        ),
        pytest.param(
            loco([], announced="0"),
            [(1, 2, "0", "the number of postures, a whole number from 1 to 10")],
            id="no postures",
        ),
        pytest.param(
            loco([posture()], announced="1\t7"),
            [(1, 3, "7", "nothing after the number of postures")],
            id="more in the header",
        ),
        pytest.param(
            loco([posture()], announced=3),
            [(1, 2, "the number 3, but 1 posture below it", "as many rows as the file says above")],
            id="fewer rows",
        ),
        pytest.param(
            loco([posture(), posture("1 Key"), "Position\tR,F"], announced=1),
            [
                (
                    1,
                    2,
                    "the number 1, but 2 postures below it",
                    "as many rows as the file says above",
                )
            ],
            id="more rows",
        ),
        pytest.param(
            loco([posture(), posture("0 Key")]),
            [(3, 1, '"0 Key" again (first in row 2)', "each key once")],
            id="a key twice",
        ),
        pytest.param(
            loco([posture("Key 0"), posture("1 Kye"), posture("10 Key")]),
            [
                (2, 1, '"Key 0"', 'a key from "0 Key" to "9 Key"'),
                (3, 1, '"1 Kye"', 'a key from "0 Key" to "9 Key"'),
                (4, 1, '"10 Key"', 'a key from "0 Key" to "9 Key"'),
            ],
            id="other labels",
        ),
        pytest.param(
            loco([posture(angles=17), posture("1 Key", angles=19), posture("2 Key")]),
            [
                (2, None, "17 angles", "18 angles (3 for each of 6 legs)"),
                (3, None, "19 angles", "18 angles (3 for each of 6 legs)"),
            ],
            id="a column less, a column more",
        ),
        pytest.param(
            loco([posture(), posture("1 Key", angles=12), posture("2 Key")]),
            [(3, None, "12 angles", "18 angles (3 for each of 6 legs)")],
            id="rows for different robots",
        ),
        pytest.param(
            loco(["0 Key", posture("1 Key")]),
            [(2, None, "0 angles", "18 angles (3 for each of 6 legs)")],
            id="a key alone",
        ),
        pytest.param(
            loco([posture(j2="", j5='""')]),
            [(2, 4, "nothing", ANGLE), (2, 7, "nothing", ANGLE)],
            id="empty cells",
        ),
        pytest.param(
            loco([posture(j0="x" * 50)]),
            [(2, 2, '"' + "x" * 40 + '…"', ANGLE)],
            id="a long cell",
        ),
        pytest.param(
            loco([posture(j0="\x1b[2J")]),
            [(2, 2, '"\N{REPLACEMENT CHARACTER}[2J"', ANGLE)],
            id="a cell that would write over the screen",
        ),
        pytest.param(
            loco([posture()]) + "\nPosition\tR,F\n" + posture("1 Key"),
            [
                (
                    1,
                    2,
                    "the number 1, but 3 postures below it",
                    "as many rows as the file says above",
                ),
                (3, None, "1 angle", "18 angles (3 for each of 6 legs)"),
                (3, 1, '"Position"', 'a key from "0 Key" to "9 Key"'),
                (3, 2, '"R,F"', ANGLE),
            ],
            id="a posture below the legend",
        ),
        pytest.param(
            loco([posture() + "\t\tforward", posture("1 Key")]),
            [(2, 21, '"forward"', "nothing after 18 angles (3 for each of 6 legs)")],
            id="a remark beside the angles",
        ),
        pytest.param(
            loco([posture(j0="4\u200b5")]),
            [(2, 2, '"4<zero width space>5"', ANGLE)],
            id="a mark that nobody sees",
        ),
        pytest.param(
            loco([posture(j0="4\u00a05")]),
            [(2, 2, '"4 5"', ANGLE)],
            id="a space that breaks no line",
        ),
        pytest.param(
            loco([posture(j0="x"), posture("1 Key")]) + "\nPosition\tR,F\nmade by Anna\t2026\n",
            [(2, 2, '"x"', ANGLE)],
            id="a row below the legend is not among the mistakes",
        ),
        pytest.param(
            loco([posture(), posture("", j0="\t1").strip("\n")], announced=1),
            [
                (
                    1,
                    2,
                    "the number 1, but 2 postures below it",
                    "as many rows as the file says above",
                ),
                (3, 1, "1", 'a key from "0 Key" to "9 Key"'),
                (3, None, "17 angles", "18 angles (3 for each of 6 legs)"),
            ],
            id="angles without a key are no legend",
        ),
    ],
)
def test_mistakes_of_loco_data(text, expected):
    """A mistake in Loco-data is reported with its place, what was found and what is expected."""
    found = [(m.row, m.column, m.found, m.expected) for m in refused(text)]
    assert sorted(found, key=str) == sorted(expected, key=str)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        pytest.param(
            f"2\n1\n{posture('')}",
            [(1, 1, "the number 2, but 1 key below it", "as many keys as the file says above")],
            id="fewer keys",
        ),
        pytest.param(
            f"1\n1\n{posture('')}\n1\n{posture('')}",
            [(1, 1, "the number 1, but 2 keys below it", "as many keys as the file says above")],
            id="more keys",
        ),
        pytest.param(
            f"1\n2\n{posture('')}",
            [
                (
                    2,
                    1,
                    "the number 2, but 1 row of angles below it",
                    "as many rows as the file says for key [0]",
                )
            ],
            id="fewer rows",
        ),
        pytest.param(
            f"1\n{posture('')}",
            [
                (
                    2,
                    None,
                    "18 cells",
                    "only the number of postures of key [0], in a row above these postures",
                )
            ],
            id="no number of postures",
        ),
        pytest.param(
            "11\n" + f"1\n{posture('')}\n" * 11,
            [(1, 1, "11", "the number of keys, a whole number from 1 to 10")],
            id="eleven keys",
        ),
        pytest.param(
            "1\n101\n" + f"{posture('')}\n" * 101,
            [
                (
                    2,
                    1,
                    "101",
                    "the number of postures of key [0], a whole number from 1 to 100",
                )
            ],
            id="101 postures",
        ),
        pytest.param(
            f"1\nmany\n{posture('')}",
            [
                (
                    2,
                    1,
                    '"many"',
                    "the number of postures of key [0], a whole number from 1 to 100",
                )
            ],
            id="a word for a number",
        ),
        pytest.param(
            "3",
            [(1, 1, "the number 3, but 0 keys below it", "as many keys as the file says above")],
            id="nothing else",
        ),
    ],
)
def test_mistakes_of_locotra_data(text, expected):
    """A mistake in LocoTra-data is reported with its place, what was found and what is expected."""
    assert [(m.row, m.column, m.found, m.expected) for m in refused(text)] == expected


@pytest.mark.parametrize("legs", [6, ("R,F", "R,C", "R,B", "L,B", "L,C", "L,F")])
def test_a_gait_for_another_robot_is_called_so(legs):
    """Rows of 12 angles instead of 18 are together one mistake; other mistakes are listed too."""
    text = loco([posture(angles=12), posture("1 Key", angles=12, j7="x")])
    assert places(refused(text, legs=legs)) == [
        (
            2,
            None,
            None,
            None,
            "12 angles in a row: a gait for a robot with 4 legs",
            "18 angles in a row: this robot has 6 legs",
        ),
        (3, 9, 7, "L,F", '"x"', ANGLE),
    ]


@pytest.mark.parametrize(
    "data",
    [
        b"\xff\xfe\x00",
        b"\xff\xfe\x00\xd8",
        b"\xef\xbb\xbf\xff",
        b"4\n\x81",
        b"\x00\x31\x00",
        b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR\x00\x00\x00\x10",
        b"\x89MCAP0\r\n\x01\x15\x00\x00\x00\x00\x00\x00\x00\x05\x00\x00\x00lacoc",
    ],
)
def test_bytes_that_are_no_text(data):
    """Bytes that are no text in any encoding are refused; the message names the first such byte."""
    (mistake,) = refused(data)
    assert mistake.found.startswith("bytes that are not text (byte ")
    assert mistake.expected == "text in UTF-8, UTF-16 or Shift-JIS"
