"""Tests of a folder's files: they are listed, read, saved, and not overwritten by accident."""

import os
from pathlib import Path

import openpyxl
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lacoc_client.workshop.design.files import file_bytes, read_file
from lacoc_client.workshop.design.folder import ABSENT, Conflict, Folder, SavedFile
from lacoc_client.workshop.design.saving.text_edit import edit_text
from lacoc_client.workshop.design.table import FileRow, FileTable, gait_of, page_table
from lacoc_robots.library import find_robot, sample_gait_files
from lacoc_shared.gait.tables import PostureTable
from lacoc_shared.gait.text import read_gait
from lacoc_shared.gait.workbook import INPUT_SHEET
from lacoc_shared.mistakes import FileRefused, UserError
from lacoc_shared.words import say

GAITS = Path(__file__).parents[1] / "gait" / "files"


def sample(robot: str = "hexapod") -> FileTable:
    file = sample_gait_files(robot).postures
    assert file is not None
    table = read_file(file.name, file.data).table
    assert table is not None
    return table


def walk() -> FileTable:
    file = sample_gait_files("hexapod").locomotion
    assert file is not None
    table = read_file(file.name, file.data).table
    assert table is not None
    return table


def turned(table: FileTable, row: int, angle_deg: float) -> FileTable:
    """Return a table in which the first angle of a row is changed."""
    rows = list(table.rows)
    angles = (angle_deg, *rows[row].angles_deg[1:])
    rows[row] = FileRow(key=rows[row].key, posture=rows[row].posture, angles_deg=angles)
    return FileTable(kind=table.kind, legs=table.legs, rows=tuple(rows))


@pytest.fixture
def folder(tmp_path: Path) -> Folder:
    """Give a folder with files of every kind, and some that are neither gaits nor robots."""
    (tmp_path / "Loco-data.xlsx").write_bytes((GAITS / "calc.xlsx").read_bytes())
    utf_16 = (GAITS / "calc-utf-16-Loco-data.txt").read_bytes()
    (tmp_path / "Loco-data-old.txt").write_bytes(utf_16)
    (tmp_path / "LocoTra-data2.txt").write_bytes(file_bytes("LocoTra-data2.txt", walk()))
    (tmp_path / "my.toml").write_bytes(find_robot("hexapod")[1])
    (tmp_path / "contest.toml").write_text("[court.main]\n")
    (tmp_path / "~$Loco-data.xlsx").write_bytes(b"a lock of Excel")
    (tmp_path / "Pos-data.txt").write_text("time_s\tx_m\n")
    return Folder(tmp_path)


def test_gaits_and_robots_are_listed(folder: Folder) -> None:
    """A folder lists gait and robot files, each with its kind, and no other files."""
    assert [(file.name, file.slot) for file in folder.files] == [
        ("Loco-data-old.txt", "postures"),
        ("Loco-data.xlsx", "postures"),
        ("LocoTra-data2.txt", "locomotion"),
        ("my.toml", "robot"),
    ]
    for file in folder.files:
        assert folder.read(file.name).version == file.version


def test_a_file_that_is_locked_for_a_moment_is_listed(
    folder: Folder, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Excel locks a file while it saves; the folder reads it again the next time."""
    path = folder.path / "Loco-data-new.txt"
    path.write_bytes(file_bytes("Loco-data-new.txt", sample()))
    read = folder._data

    def locked(path: Path) -> bytes | None:
        raise UserError(say("design.cannot-read", name=path.name, why="locked"))

    monkeypatch.setattr(folder, "_data", locked)
    known = {file.name for file in folder.files}
    assert folder.look() == ()
    assert {file.name for file in folder.files} == known, "what was read before stays"
    monkeypatch.setattr(folder, "_data", read)
    assert folder.look() == (path.name,)
    assert {file.name for file in folder.files} == {*known, path.name}


def test_files_are_read_as_tables(folder: Folder) -> None:
    """Files of postures, sequences and robots are read, from LibreOffice and in UTF-16 too."""
    assert folder.read("Loco-data.xlsx").table == sample()
    assert folder.read("Loco-data-old.txt").table == sample()
    table = folder.read("LocoTra-data2.txt").table
    assert table == walk()
    assert table is not None
    assert {(row.key, row.posture) for row in table.rows} >= {(0, 0), (2, 0), (2, 3)}
    robot = folder.read("my.toml").robot
    assert robot is not None
    assert robot.encode() == find_robot("hexapod")[1]


def test_a_mistake_is_told_with_its_place(folder: Folder) -> None:
    """A gait file with a wrong angle is refused with the angle's row, column, joint and leg."""
    (folder.path / "Loco-data.txt").write_bytes(
        file_bytes("x.txt", sample()).replace(b"0 Key\t45", b"0 Key\t451", 1)
    )
    with pytest.raises(FileRefused) as refusal:
        folder.read("Loco-data.txt")
    (mistake,) = refusal.value.mistakes
    assert (mistake.row, mistake.column, mistake.joint, mistake.leg) == (2, 2, 0, "R,F")


@pytest.mark.parametrize("name", ["Loco-data.xlsx", "Loco-data-old.txt", "Loco-new.txt"])
def test_a_table_is_saved_and_read_back(folder: Folder, name: str) -> None:
    """A saved table can be read again, and has the version that the save returned."""
    known = {file.name: file.version for file in folder.files}
    table = turned(sample(), 4, -12.25)
    saved = folder.save(name, table, known.get(name, ABSENT), force=False)
    assert isinstance(saved, SavedFile)
    again = folder.read(name)
    assert (again.table, again.version) == (table, saved.version)
    assert saved.version in {file.version for file in folder.files}
    assert folder.look() == (name,)  # other pages are told
    assert not list(folder.path.glob(".lacoc-*"))


def test_a_change_meanwhile_is_a_conflict(folder: Folder) -> None:
    """If another program changed the file, a save writes nothing and returns the file's table."""
    version = folder.read("Loco-data.xlsx").version
    path = folder.path / "Loco-data.xlsx"
    book = openpyxl.load_workbook(path)
    book[INPUT_SHEET]["B2"] = 10
    book[INPUT_SHEET]["A20"] = "my remark"
    book.save(path)
    by_excel = path.read_bytes()
    mine = turned(sample(), 4, -12.25)
    answer = folder.save("Loco-data.xlsx", mine, version, force=False)
    assert isinstance(answer, Conflict)
    assert path.read_bytes() == by_excel
    assert answer.conflict.table == turned(sample(), 0, 10)
    assert answer.conflict.version == folder.read("Loco-data.xlsx").version
    # With `force` the page's table is saved, and the other program's remark stays.
    assert isinstance(folder.save("Loco-data.xlsx", mine, version, force=True), SavedFile)
    assert folder.read("Loco-data.xlsx").table == mine
    assert openpyxl.load_workbook(path)[INPUT_SHEET]["A20"].value == "my remark"


def test_a_conflict_with_a_file_that_has_gone_or_is_broken(folder: Folder) -> None:
    """A conflict tells the mistakes of a file that has become wrong, and that a file has gone."""
    version = folder.read("LocoTra-data2.txt").version
    path = folder.path / "LocoTra-data2.txt"
    path.write_text("1\n1\n500\n")
    answer = folder.save("LocoTra-data2.txt", walk(), version, force=False)
    assert isinstance(answer, Conflict)
    assert answer.conflict.table is None
    assert answer.conflict.mistakes
    path.unlink()
    answer = folder.save("LocoTra-data2.txt", walk(), version, force=False)
    assert isinstance(answer, Conflict)
    assert answer.conflict.version == ABSENT


def test_changes_are_noticed(folder: Folder) -> None:
    """Each file that comes, changes or goes is named once; a new date alone is no change."""
    assert folder.look() == ()
    os.utime(folder.path / "my.toml", (1, 1))
    assert folder.look() == ()
    (folder.path / "my.toml").unlink()
    (folder.path / "Loco-data.txt").write_bytes(file_bytes("x.txt", sample()))
    (folder.path / "LocoTra-data2.txt").write_text("broken")
    assert folder.look() == ("Loco-data.txt", "LocoTra-data2.txt", "my.toml")
    assert folder.look() == ()


@pytest.mark.parametrize(
    "name",
    [
        "../Loco-data.txt",
        "a/Loco.txt",
        "Loco-data.csv",
        "C:Loco.txt",
        ".toml",
        "x.txt",
        "Loco\0.txt",
    ],
)
def test_other_names_are_refused(folder: Folder, name: str) -> None:
    """Only files directly in the folder, with names of gait or robot files, are read and saved."""
    with pytest.raises(UserError, match="can't be a file here"):
        folder.read(name)
    with pytest.raises(UserError, match="can't be a file here"):
        folder.save(name, sample(), ABSENT, force=True)


def test_a_failed_save_leaves_the_old_file(folder: Folder, monkeypatch: pytest.MonkeyPatch) -> None:
    """On a full disk, or without permission to write, a save fails and the old file stays."""
    version = folder.read("Loco-data.xlsx").version
    before = (folder.path / "Loco-data.xlsx").read_bytes()

    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", full)
        with pytest.raises(UserError, match="No space left on device"):
            folder.save("Loco-data.xlsx", turned(sample(), 0, 1), version, force=False)
    with monkeypatch.context() as patch:
        patch.setattr(os, "access", lambda *_: False)  # root may write everything
        with pytest.raises(UserError, match="Permission denied"):
            folder.save("Loco-data.xlsx", turned(sample(), 0, 1), version, force=False)
    assert (folder.path / "Loco-data.xlsx").read_bytes() == before
    assert not list(folder.path.glob(".lacoc-*"))


def test_sequences_belong_into_text(folder: Folder) -> None:
    """Sequences can't be saved as a workbook, nor as text if a key between others is missing."""
    with pytest.raises(UserError, match="sequences belong in a text file"):
        folder.save("Loco-new.xlsx", walk(), ABSENT, force=False)
    table = walk()
    rows = tuple(row for row in table.rows if row.key != 1)
    holed = FileTable(kind="locomotion", legs=6, rows=rows)
    with pytest.raises(UserError, match="Key 1 has no posture"):
        folder.save("LocoTra-new.txt", holed, ABSENT, force=False)


def test_bad_angles_are_mistakes_with_their_place(folder: Folder) -> None:
    """A table is refused if an angle is out of range or no number; the place is named."""
    for angle_deg in (151.0, float("nan"), float("inf")):
        with pytest.raises(FileRefused) as refusal:
            folder.save("Loco-new.txt", turned(sample(), 2, angle_deg), ABSENT, force=False)
        (mistake,) = refusal.value.mistakes
        assert (mistake.row, mistake.column, mistake.joint) == (4, 2, 0)
    assert not (folder.path / "Loco-new.txt").exists()


def test_a_text_keeps_what_is_beside_its_numbers() -> None:
    """When a posture is added to a text file, encoding, line ends, other rows and remarks stay."""
    text = "Num of Posture\t1\r\n0 Key\t" + "\t".join(["４５．０"] * 18)
    text += "\r\n位置\t右前\r\nこれはわたしの歩容\r\n"
    for encoding in ("cp932", "utf-8-sig", "utf-16"):
        data = text.encode(encoding)
        table = read_gait(data, "x")
        assert isinstance(table, PostureTable)
        assert edit_text(data, "x", table) == data
        more = PostureTable({**table.postures, 3: (0.0,) * 18})
        edited = edit_text(data, "x", more).decode(encoding)
        assert edited == text.replace("Posture\t1", "Posture\t2").replace(
            "\r\n位置", "\r\n3 Key" + "\t0" * 18 + "\r\n位置"
        )


ANGLES = st.integers(-15000, 15000).map(lambda hundredths: hundredths / 100)


@st.composite
def tables(draw: st.DrawFn, legs: int) -> FileTable:
    """Draw a table of postures."""
    keys = draw(st.sets(st.integers(0, 9), min_size=1))
    angles = st.tuples(*[ANGLES] * (3 * legs))
    rows = tuple(FileRow(key=key, angles_deg=draw(angles)) for key in sorted(keys))
    return FileTable(kind="postures", legs=legs, rows=rows)


@settings(max_examples=15, deadline=None)
@given(st.sampled_from([4, 6, 8]), st.sampled_from(["Loco.txt", "Loco.xlsx"]), st.data())
def test_any_table_survives(legs: int, name: str, data: st.DataObject) -> None:
    """Any table, saved as a new file or over another table, is read back with the same angles."""
    table, other = data.draw(tables(legs)), data.draw(st.none() | tables(legs))
    before = None if other is None else file_bytes(name, other)
    assert read_file(name, file_bytes(name, table, before)).table == page_table(
        gait_of(table, name)
    )
