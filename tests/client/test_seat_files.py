"""Tests of the files that a contestant brings (rules 2, workshop 4-1)."""

import os
from pathlib import Path

import pytest

from lacoc_client.play.own_files import OwnFiles
from lacoc_robots.library import find_robot, sample_gait_files
from lacoc_robots.seat_files import SeatFiles, as_text, gaits_in, gather, remarks, with_level_b
from lacoc_shared.gait.cells import leg_labels
from lacoc_shared.gait.tables import PostureTable
from lacoc_shared.gait.text import read_gait, write_gait
from lacoc_shared.gait.workbook.file import write_workbook
from lacoc_shared.messages import SentFile
from lacoc_shared.mistakes import FileRefused, UserError
from lacoc_shared.words import render

SAMPLE = sample_gait_files("hexapod")
assert SAMPLE.postures is not None
assert SAMPLE.locomotion is not None
POSTURES, LOCOMOTION = SAMPLE.postures.data, SAMPLE.locomotion.data


def write(path: Path, data: bytes, at_s: int = 1000) -> Path:
    path.write_bytes(data)
    os.utime(path, (at_s, at_s))
    return path


def workbook() -> bytes:
    table = read_gait(POSTURES, "Loco-data.txt")
    assert isinstance(table, PostureTable)
    return write_workbook(table, leg_labels(6))


def test_a_robot_in_a_folder_is_read_again(tmp_path: Path) -> None:
    """A robot that is given as its folder is watched, as one that is given as its file."""
    folder = tmp_path / "mine"
    folder.mkdir()
    (folder / "__init__.py").touch()
    file = write(folder / "robot.toml", find_robot("hexapod")[1])
    own = OwnFiles(str(folder), (), tmp_path)
    write(file, file.read_bytes() + b"# new", 2000)
    assert not own.look(), "it may still be being written"
    assert own.look()
    assert own.changed == ("robot.toml",)


def test_a_link_that_leads_nowhere_is_no_gait(tmp_path: Path) -> None:
    """A broken link, as a copied folder may have, is passed over."""
    (tmp_path / "Loco-data.txt").symlink_to(tmp_path / "gone.txt")
    write(tmp_path / "LocoTra-data.txt", b"")
    assert [path.name for path in gaits_in(tmp_path)] == ["LocoTra-data.txt"]


@pytest.mark.parametrize(
    ("there", "expected"),
    [
        ([], []),
        (["Loco-data.txt"], ["Loco-data.txt"]),
        (
            ["LocoTra-data-6legs.txt", "Loco-data-6legs.txt"],
            ["Loco-data-6legs.txt", "LocoTra-data-6legs.txt"],
        ),
        (["Loco-data.txt", "Loco-data.xlsx"], ["Loco-data.xlsx"]),
        (["LocoTra-data.txt", "LocoTra-data2.txt"], ["LocoTra-data2.txt"]),
        (["LocoTra-data2.txt", "LocoTra-data.txt", "notes.txt"], ["LocoTra-data.txt"]),
        (["loco-data.XLSX", "LOCOTRA-data2.txt"], ["loco-data.XLSX", "LOCOTRA-data2.txt"]),
    ],
)
def test_a_folder_s_gaits_are_the_ones_saved_last(
    tmp_path: Path, there: list[str], expected: list[str]
) -> None:
    """If no file is named, the folder's newest file of each level is taken (workshop 4-1, 4-3)."""
    for age, name in enumerate(there):
        write(tmp_path / name, b"", 1000 + age)

    assert [path.name for path in gaits_in(tmp_path)] == expected


def test_files_saved_in_one_moment_go_by_their_names(tmp_path: Path) -> None:
    """Of files with the same age, Loco-data.txt and LocoTra-data.txt are taken."""
    for name in ("Loco-data-6legs.txt", "Loco-data.txt", "LocoTra-data.txt", "LocoTra-data1.txt"):
        write(tmp_path / name, b"")

    assert [path.name for path in gaits_in(tmp_path)] == ["Loco-data.txt", "LocoTra-data.txt"]


def test_sequences_that_are_older_than_their_postures_are_told(tmp_path: Path) -> None:
    """A player whose LocoTra-data.txt is older than the posture table is told so (workshop 4-1)."""
    table = write(tmp_path / "Loco-data.xlsx", b"", 1000)
    sequences = write(tmp_path / "LocoTra-data.txt", b"", 1000)
    assert remarks(tmp_path, [table, sequences]) == []

    write(table, b"", 1001)
    (remark,) = map(render, remarks(tmp_path, [table, sequences]))
    assert remark.endswith("lacoc gait convert Loco-data.xlsx LocoTra-data.txt")
    assert remarks(tmp_path, [table]) == remarks(tmp_path, [sequences]) == []


def test_a_newer_file_with_another_name_is_told(tmp_path: Path) -> None:
    """Whoever saves a table under another name is told that the older file is used."""
    write(tmp_path / "Loco-forward.txt", b"", 1000)
    (remark,) = map(render, remarks(tmp_path, gaits_in(tmp_path)))
    assert "Loco-forward.txt is the newest gait file here" in remark
    write(tmp_path / "Loco-data.txt", b"", 1000)
    assert remarks(tmp_path, gaits_in(tmp_path)) == []
    write(tmp_path / "Loco-forward.txt", b"", 1001)
    assert len(remarks(tmp_path, gaits_in(tmp_path))) == 1


def test_a_workbook_of_sequences_is_named(tmp_path: Path) -> None:
    """A workbook LocoTra-data.xlsx is left out, and a remark says so (rules 2)."""
    write(tmp_path / "LocoTra-data.xlsx", workbook())
    (remark,) = map(render, remarks(tmp_path, gaits_in(tmp_path)))
    assert "LocoTra-data.xlsx is not used" in remark


def test_nothing_named_leaves_all_to_the_contest() -> None:
    """A contestant who names no files sends none, and plays with the contest's robot and gait."""
    assert gather(None, []) == SeatFiles()


def test_a_robot_brings_the_gait_beside_it() -> None:
    """A player who names an installed robot sends that robot's sample gait with it."""
    files = gather("quadruped", [])

    assert files.robot is not None
    assert files[1:] == sample_gait_files("quadruped")


def test_each_file_goes_to_its_level(tmp_path: Path) -> None:
    """A file's content, not its name, decides its level; text is sent unchanged."""
    first = write(tmp_path / "b.txt", LOCOMOTION)
    second = write(tmp_path / "a.txt", POSTURES)

    assert gather(None, [first, second]) == SeatFiles(
        None, SentFile("a.txt", POSTURES), SentFile("b.txt", LOCOMOTION)
    )


def test_a_workbook_goes_as_the_text_it_stands_for(tmp_path: Path) -> None:
    """A workbook is sent as text, but under the workbook's name (rules 2)."""
    files = gather(None, [write(tmp_path / "Loco-data.xlsx", workbook())])

    assert files.postures is not None
    assert files.postures.name == "Loco-data.xlsx"
    assert read_gait(files.postures.data, "") == read_gait(POSTURES, "")


def test_two_files_for_one_level_are_refused(tmp_path: Path) -> None:
    """Two files for one level are refused, because only the contestant knows which one is meant."""
    paths = [write(tmp_path / name, POSTURES) for name in ("a.txt", "b.txt")]

    with pytest.raises(UserError, match=r"a\.txt and b\.txt are for the same keys"):
        gather(None, paths)


def test_the_mistakes_of_all_files_are_listed_at_once(tmp_path: Path) -> None:
    """All mistakes of all files are listed together, not only the first one (rules 2)."""
    paths = [
        write(tmp_path / "a.txt", POSTURES.replace(b"45", b"451")),
        write(tmp_path / "b.txt", b"1\n1\n5\n"),
    ]
    with pytest.raises(FileRefused) as refused:
        gather(None, paths)

    assert {mistake.file for mistake in refused.value.mistakes} == {"a.txt", "b.txt"}


def test_a_file_that_is_not_there_is_named(tmp_path: Path) -> None:
    """The error names a file that does not exist."""
    with pytest.raises(UserError, match=r"missing\.txt"):
        gather(None, [tmp_path / "missing.txt"])


def test_a_workbook_travels_as_text() -> None:
    """A workbook from a page is changed to text for the court; a broken one is a mistake."""
    book = SentFile("Loco-data.xlsx", workbook())
    files = as_text(SeatFiles(postures=book, locomotion=SAMPLE.locomotion))
    assert files.postures is not None
    assert files.postures.name == "Loco-data.xlsx"
    assert read_gait(files.postures.data, "a") == read_gait(POSTURES, "b")
    assert files.locomotion == SAMPLE.locomotion

    for broken in (b"PK\x03\x04", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"):  # cut off; with a password
        with pytest.raises(FileRefused) as caught:
            as_text(SeatFiles(postures=SentFile("broken.xlsx", broken)))
        assert [one.file for one in caught.value.mistakes] == ["broken.xlsx"]


def test_level_b_is_made_of_postures_that_come_alone() -> None:
    """Level B is made from the postures if there is no locomotion file (workshop 4-2, Fig. 4-2)."""
    book = as_text(SeatFiles(postures=SentFile("Loco-data.xlsx", workbook())))
    made = with_level_b(book).locomotion
    assert made is not None
    assert read_gait(made.data, made.name) == read_gait(LOCOMOTION, "LocoTra-data.txt")
    own = with_level_b(book, [[0], [1, 2]]).locomotion
    assert own is not None
    table = read_gait(own.data, own.name)
    assert [len(sequence) for sequence in table.sequences] == [1, 2]  # type: ignore[union-attr]


def test_level_b_is_never_made_against_what_there_is() -> None:
    """Level B is not made if there is a locomotion file or a posture is missing."""
    both = SeatFiles(postures=SAMPLE.postures, locomotion=SAMPLE.locomotion)
    few = PostureTable({0: (0.0,) * 18, 1: (0.1,) * 18})
    short = SeatFiles(postures=SentFile("few.txt", write_gait(few, leg_labels(6))))
    wrong = SeatFiles(postures=SentFile("wrong.txt", b"x"))
    for files in (SeatFiles(), both, short, wrong):
        assert with_level_b(files) == files
    for keys, expected in (
        ([[0], [2]], "Key 1 of level B uses posture 2, but few.txt has only 0, 1."),
        ([[0], []], "Key 1 of level B has no posture"),
        ([], "There are 0 keys, and the longest sequence has 0 postures"),
    ):
        with pytest.raises(UserError, match=expected):
            with_level_b(short, keys)


def test_files_that_are_saved_again_are_read_again(tmp_path: Path) -> None:
    """A gait file that is saved again is read again; if it is wrong, the old one stays in use."""
    write(tmp_path / "LocoTra-data.txt", LOCOMOTION)
    own = OwnFiles(folder=tmp_path)
    assert not own.look()
    assert own.files.postures is None

    write(tmp_path / "Loco-data.txt", POSTURES, 2000)
    assert not own.look()  # the file may still be incomplete
    assert own.look()
    assert own.changed == ("Loco-data.txt",)
    assert own.version == 2
    assert own.files.postures == SAMPLE.postures
    assert not own.look()

    write(tmp_path / "Loco-data.txt", b"Num of Posture\tmany", 3000)
    assert [own.look(), own.look()] == [False, True]
    assert isinstance(own.refused, FileRefused)
    assert own.files.postures == SAMPLE.postures

    write(tmp_path / "Loco-data.txt", POSTURES, 4000)
    assert [own.look(), own.look()] == [False, True]
    assert own.refused is None
    write(tmp_path / "Loco-data.txt", POSTURES, 5000)  # saved again as it was
    assert [own.look(), own.look()] == [False, False]
    assert own.version == 4

    (tmp_path / "Loco-data.txt").unlink()
    assert [own.look(), own.look()] == [False, True]
    assert own.files.postures is None
    assert own.changed == ("Loco-data.txt",)
