"""The commands `lacoc gait check` and `lacoc gait convert` (rules 2)."""

import json
import re
from pathlib import Path

import pytest

from lacoc_robots.joint_picture import joint_picture, labels_of
from lacoc_robots.library import installed_robots, robot_folder
from lacoc_shared.command.cli import main
from lacoc_shared.gait.cells import LEG_LABELS, leg_labels
from lacoc_shared.gait.tables import SAMPLE_KEYS, PostureTable, to_locomotion
from lacoc_shared.gait.text import read_gait, write_gait
from lacoc_shared.gait.workbook.file import read_gait_file, write_workbook
from lacoc_shared.mistakes import Mistake


@pytest.fixture
def lacoc(capsys):
    """Give a function that runs a command and returns its exit code, output and errors."""

    def run(*words: object) -> tuple[int, str, str]:
        try:
            code = main([str(word) for word in words])
        except SystemExit as end:
            code = end.code
        output = capsys.readouterr()
        return code, output.out, output.err

    return run


def test_the_sample_is_a_table_to_change(lacoc, tmp_path):
    """`gait sample` writes the robot's own postures, and keeps an older file of that name."""
    new = tmp_path / "new"
    code, out, err = lacoc("gait", "sample", new)
    table = new / "Loco-data.xlsx"

    assert (code, out) == (0, "")
    assert str(table) in err
    own = robot_folder("hexapod")
    assert table.read_bytes() == (own / "Loco-data.xlsx").read_bytes()

    code, _, err = lacoc("gait", "sample", new, "--robot", "octopod")
    assert code == 0
    assert "Loco-data.1.xlsx" in err
    assert (new / "Loco-data.1.xlsx").read_bytes() == (own / "Loco-data.xlsx").read_bytes()
    assert read_gait_file(table) == read_gait_file(robot_folder("octopod") / "Loco-data.txt")


@pytest.mark.parametrize("name", installed_robots())
def test_each_installed_robot_has_a_sample(lacoc, tmp_path, name):
    """The sample of each robot has no mistakes for that robot."""
    assert lacoc("gait", "sample", tmp_path, "--robot", name)[0] == 0
    code, _, err = lacoc("gait", "check", tmp_path / "Loco-data.xlsx", "--robot", name)
    assert (code, err) == (0, "")


def test_a_robot_without_a_gait_has_no_sample(lacoc, tmp_path):
    """A robot's folder without Loco-data.txt is told in a sentence, and nothing is written."""
    bare = tmp_path / "bare"
    bare.mkdir()
    (bare / "robot.toml").write_bytes((robot_folder("hexapod") / "robot.toml").read_bytes())

    code, _, err = lacoc("gait", "sample", tmp_path / "out", "--robot", bare)

    assert code == 2
    assert "no Loco-data.txt" in err
    assert not (tmp_path / "out").exists()


@pytest.fixture
def folder(tmp_path, workshop, legs) -> Path:
    """Give a folder with the workshop's gait in all three kinds of file."""
    (tmp_path / "Loco-data.txt").write_bytes(write_gait(workshop, legs))
    locomotion = to_locomotion(workshop, SAMPLE_KEYS)
    (tmp_path / "LocoTra-data.txt").write_bytes(write_gait(locomotion, legs))
    (tmp_path / "Loco-data.xlsx").write_bytes(write_workbook(workshop, legs))
    return tmp_path


def test_check_says_what_each_key_does(lacoc, folder):
    """For each key, `check` prints how many postures it has and which feet it lifts."""
    code, out, err = lacoc("gait", "check", *sorted(folder.iterdir()))
    assert (code, err) == (0, "")
    assert "Loco-data.txt: no mistakes. Level A, postures, 6 legs." in out
    assert "Loco-data.xlsx: no mistakes. Level A, postures, 6 legs." in out
    _, locomotion = out.split("LocoTra-data.txt: no mistakes. Level B, locomotion, 6 legs.")
    rows = [[c.strip() for c in line.split("│")[1:-1]] for line in locomotion.splitlines()]
    assert [row for row in rows if row] == [
        ["0", "1", "none"],
        ["1", "4", "R,C L,B L,F, then R,F R,B L,C"],
        ["2", "4", "R,F R,B L,C, then R,C L,B L,F"],
        ["3", "4", "R,F R,B L,C, then R,C L,B L,F"],
    ]


def test_check_lists_every_mistake_of_every_file(lacoc, folder):
    """`check` prints a table of all mistakes of all files, and exits with code 2."""
    for name in ("a.txt", "b.txt"):
        text = (folder / "Loco-data.txt").read_text().replace("-45\t-45", "-451\tx", 1)
        (folder / name).write_text(text)
    code, out, err = lacoc("gait", "check", folder / "a.txt", folder / "b.txt")
    assert code == 2
    assert out == ""
    assert "4 mistakes" in err
    cells = [[c.strip() for c in line.split("│")[1:-1]] for line in err.splitlines()]
    angle = "an angle from -150 to 150 degrees"
    assert [row for row in cells if row] == [
        [name, "2", *place, angle]
        for name in ("a.txt", "b.txt")
        for place in (("4", "2", "R,B", "-451"), ("5", "3", "L,B", '"x"'))
    ]


def test_check_draws_the_legs_of_the_mistakes(lacoc, tmp_path):
    """Below the mistakes stands a picture of the legs with their joint ids."""
    postures = ["Num of Posture 1", "0 Key " + "0 " * 16 + "200 0"]
    (tmp_path / "Loco-data.txt").write_text("\n".join(postures))
    code, _, err = lacoc("gait", "check", str(tmp_path / "Loco-data.txt"))
    assert code == 2
    assert "  L,F  17 11  5 ─┐   ┌─  0  6 12  R,F" in err
    assert "  L,C  16 10  4 ─┤   ├─  1  7 13  R,C" in err


@pytest.mark.parametrize("legs", LEG_LABELS)
def test_the_picture_names_the_leg_of_each_joint(legs):
    """Each line of the picture has the joint ids of two legs; only joints with mistakes are red."""
    labels = LEG_LABELS[legs]
    picture = joint_picture(labels, {legs})
    for line in picture.plain.splitlines()[1:-1]:
        left, *ids, right = re.findall(r"[LR],\w+|\d+", line)
        assert {labels[int(one) % legs] for one in ids[:3]} == {left}
        assert {labels[int(one) % legs] for one in ids[3:]} == {right}
    assert [picture.plain[s.start : s.end].strip() for s in picture.spans if "red" in s.style] == [
        str(legs)
    ]
    mistake = Mistake(file="a", found="b", expected="c", joint=legs, leg=labels[0])
    assert labels_of([mistake]) is not None


def test_check_shows_right_files_beside_wrong_ones(lacoc, folder):
    """`check` still describes a correct file when another file has mistakes."""
    (folder / "bad.txt").write_text("?")
    code, out, err = lacoc("gait", "check", folder / "bad.txt", folder / "Loco-data.txt")
    assert code == 2
    assert "Loco-data.txt: no mistakes" in out
    assert "bad.txt" in err


@pytest.mark.parametrize("kind", ["Loco-data.txt", "Loco-data.xlsx"])
def test_labels_that_are_exchanged_are_noted(lacoc, tmp_path, workshop, kind):
    """A legend with exchanged leg labels is no mistake; `check` and `convert` print a note."""
    exchanged = ("L,F", "R,C", "R,B", "L,B", "L,C", "R,F")
    write = write_workbook if kind.endswith("xlsx") else write_gait
    (tmp_path / kind).write_bytes(write(workshop, exchanged))
    code, out, err = lacoc("gait", "check", tmp_path / kind)
    assert (code, f"{kind}: no mistakes" in out) == (0, True)
    note = (
        f"Note: {kind}, row 12, column 2: the legend says L,F, but joint 0 is a joint of leg R,F. "
        "Each angle goes to the joint of its column, whatever the legend says.\n"
    )
    assert err == note
    target = tmp_path / "LocoTra-data.txt"
    code, out, err = lacoc("gait", "convert", tmp_path / kind, target)
    assert (code, out, err) == (0, "", f"{target} written.\n{note}")


def test_check_for_a_robot(lacoc, folder):
    """With --legs, a gait for another number of legs is a mistake."""
    assert lacoc("gait", "check", folder / "Loco-data.txt", "--legs", 6)[0] == 0
    code, _, err = lacoc("gait", "check", folder / "Loco-data.txt", "--legs", 4)
    assert code == 2
    assert "a gait for a robot with 6 legs" in err


def test_check_takes_a_robot_of_any_number_of_legs(lacoc, folder):
    """`check` accepts a gait for five legs, although the software has no names for five legs."""
    table = PostureTable({0: (0.0,) * 10 + (1.0,) * 5})
    (folder / "five.txt").write_bytes(write_gait(table, leg_labels(5)))
    code, out, _ = lacoc("gait", "check", folder / "five.txt", "--legs", 5)
    assert (code, "5 legs" in out) == (0, True)


def test_check_json(lacoc, folder):
    """With --json, `check` prints the correct files and all mistakes as JSON."""
    (folder / "bad.txt").write_text("Num of Posture\t1\n0 Key" + "\t0" * 17 + "\t200\n")
    code, out, err = lacoc(
        "gait", "check", "--json", folder / "LocoTra-data.txt", folder / "bad.txt"
    )
    assert (code, err) == (2, "")
    assert json.loads(out) == {
        "files": [
            {
                "file": "LocoTra-data.txt",
                "kind": "locomotion",
                "legs": 6,
                "keys": {"0": 1, "1": 4, "2": 4, "3": 4},
            }
        ],
        "mistakes": [
            {
                "file": "bad.txt",
                "row": 2,
                "column": 19,
                "joint": 17,
                "leg": "L,F",
                "found": "200",
                "expected": "an angle from -150 to 150 degrees",
            }
        ],
        "notes": [],
    }
    assert lacoc("gait", "check", "--json", folder / "Loco-data.xlsx")[0] == 0


def test_check_goes_on_after_a_file_that_is_not_there(lacoc, folder, monkeypatch):
    """A file that does not exist is reported, and the other files are still checked."""
    monkeypatch.chdir(folder)
    code, out, _ = lacoc("gait", "check", "*.ods", "Loco-data.txt")
    assert code == 2
    assert "Loco-data.txt: no mistakes" in out
    code, out, _ = lacoc("gait", "check", "--json", "*.ods", "Loco-data.txt")
    (mistake,) = json.loads(out)["mistakes"]
    assert (code, mistake["file"]) == (2, "*.ods")
    assert mistake["found"] == "Cannot read *.ods: No such file or directory."


KINDS = ("Loco-data.txt", "LocoTra-data.txt", "Loco-data.xlsx")


@pytest.mark.parametrize("source", KINDS)
@pytest.mark.parametrize("target", KINDS)
def test_any_of_the_three_becomes_any_other(lacoc, folder, workshop, source, target):
    """`convert A B` writes the format of B's name; without --keys it takes the sample's keys."""
    (folder / "out").mkdir()
    written = folder / "out" / target
    code, out, err = lacoc("gait", "convert", folder / source, written)
    assert (code, out) == (0, "")
    assert err == f"{written} written.\n"
    locomotion = to_locomotion(workshop, SAMPLE_KEYS)
    table = read_gait_file(written)
    if target == "LocoTra-data.txt":
        assert table == locomotion
    elif source == "LocoTra-data.txt":
        assert set(table.postures.values()) == set(workshop.postures.values())
        assert table.postures[0] == workshop.postures[0]
    else:
        assert table == workshop


def test_convert_with_keys(lacoc, folder, workshop):
    """The option --keys says which postures each key takes."""
    target = folder / "LocoTra-data-new.txt"
    code, *_ = lacoc(
        "gait", "convert", folder / "Loco-data.xlsx", target, "--keys", "0; 1,2,3,4 ;5"
    )
    assert code == 0
    table = read_gait(target.read_bytes(), "x")
    assert table == to_locomotion(workshop, ((0,), (1, 2, 3, 4), (5,)))


def test_convert_never_overwrites(lacoc, folder, workshop):
    """`convert` renames an older file with a number, and says so."""
    target = folder / "LocoTra-data.txt"
    before = target.read_bytes()
    code, _, err = lacoc("gait", "convert", folder / "Loco-data.txt", target, "--keys", "0")
    assert code == 0
    kept = folder / "LocoTra-data.1.txt"
    assert f"The older {target} is now named {kept}." in err
    assert kept.read_bytes() == before
    assert read_gait_file(target) == to_locomotion(workshop, ((0,),))


@pytest.mark.parametrize(
    ("source", "target", "keys", "message"),
    [
        ("Loco-data.txt", "LocoTra.txt", "0;9", "uses posture 9, but Loco-data.txt has only 0, 1,"),
        ("Loco-data.txt", "LocoTra.txt", "", "is not a list of postures"),
        ("Loco-data.txt", "LocoTra.txt", "0;;1", "is not a list of postures"),
        ("Loco-data.txt", "LocoTra.txt", "0;12", "is not a list of postures"),
        (
            "Loco-data.txt",
            "LocoTra.txt",
            "0" + ";0" * 10,
            "11 keys, and the longest sequence has 1",
        ),
        ("Loco-data.txt", "LocoTra.txt", "0" + ",0" * 100, "the longest sequence has 101 postures"),
        ("Loco-data.txt", "Loco-data.xlsx", "0", "--keys makes locomotion from postures"),
        ("LocoTra-data.txt", "LocoTra.txt", "0", "--keys makes locomotion from postures"),
        (
            "Loco-data.txt",
            "Loco-data.ods",
            None,
            "the name of the file to write must end with .txt or .xlsx",
        ),
        ("Loco-data.txt", "no/folder.txt", None, "No such file or directory"),
        ("many.txt", "Loco-data.txt", None, "many.txt has 11 different postures"),
        ("bad.txt", "Loco-data.txt", None, "1 mistake."),
    ],
)
def test_convert_says_what_is_wrong(lacoc, folder, source, target, keys, message):
    """A wrong `convert` prints one message, exits with code 2, and leaves every file as it was."""
    rows = "".join("\t".join([str(n)] * 18) + "\n" for n in range(11))
    (folder / "many.txt").write_text(f"1\n11\n{rows}")
    (folder / "bad.txt").write_text("no gait")
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    options = [] if keys is None else ["--keys", keys]
    code, out, err = lacoc("gait", "convert", folder / source, folder / target, *options)
    assert (code, out) == (2, "")
    assert message in err
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before
