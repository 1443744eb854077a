import json
import sys
from pathlib import Path

import pytest

from lacoc_robots.library import find_robot
from lacoc_shared.command import cli, installing

HEXAPOD = find_robot("hexapod")[1].decode()


def lacoc(*words: str) -> int:
    """Run the command line and return its exit code, also if it ends with SystemExit."""
    with pytest.raises(SystemExit) as end:
        sys.exit(cli.main(words))
    assert isinstance(end.value.code, int)
    return end.value.code


def test_check_weighs_in(capsys: pytest.CaptureFixture[str]) -> None:
    """`robot check` prints a correct robot's facts, and that it stands."""
    assert lacoc("robot", "check", "hexapod") == 0
    out = capsys.readouterr().out
    for fact in (
        "R,F  R,C  R,B  L,B  L,C  L,F",
        "18",
        "1.115 kg",
        "0.300 x 0.120 x 0.105 m",
        "120",
        "yes, tried in physics for 2 s",
    ):
        assert fact in out


def test_check_for_programs(capsys: pytest.CaptureFixture[str]) -> None:
    """`robot check --json` prints the facts of a correct robot as JSON."""
    assert lacoc("robot", "check", "quadruped", "--json") == 0
    facts = json.loads(capsys.readouterr().out)
    assert (facts["legs"], facts["joints"], facts["mass_kg"]) == (4, 12, 0.76)
    assert facts["stands"] is True


def test_check_names_every_mistake(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """`robot check` prints a table of all mistakes of a robot file and exits with code 2."""
    file = tmp_path / "mine.toml"
    file.write_text(HEXAPOD.replace("kp = 20.0", "kp = nan").replace('"Hexapod"', "6"))
    assert lacoc("robot", "check", str(file)) == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    for word in ("2 mistakes", "mine.toml", "servo.kp", "nan", "from 1 to 200", "name"):
        assert word in printed.err


def test_mistakes_for_programs(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """`robot check --json` prints every mistake as JSON, with the entry and what was found."""
    file = tmp_path / "mine.toml"
    file.write_text(HEXAPOD.replace("kp = 20.0", "kp = nan").replace('"Hexapod"', "6"))
    assert lacoc("robot", "check", "--json", str(file)) == 2
    printed = capsys.readouterr()
    mistakes = json.loads(printed.out)["mistakes"]
    assert [mistake["field"] for mistake in mistakes] == ["name", "servo.kp"]
    assert mistakes[1]["found"] == "nan"
    assert printed.err == ""


@pytest.mark.parametrize("encoding", ["cp932", "utf-16", "utf-16-le"])
def test_a_robot_file_that_is_not_utf_8(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], encoding: str
) -> None:
    """For a robot file in Shift-JIS or UTF-16, the mistake says to save it as UTF-8."""
    file = tmp_path / "mine.toml"
    file.write_bytes(HEXAPOD.replace("Hexapod", "六足").encode(encoding, "ignore"))
    assert lacoc("robot", "check", "--json", str(file)) == 2
    (mistake,) = json.loads(capsys.readouterr().out)["mistakes"]
    assert (mistake["found"], mistake["expected"]) == (
        "bytes that are not text in UTF-8",
        "a TOML file saved as UTF-8",
    )


def test_an_integer_of_many_digits(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A number with 6,000 digits is a mistake that names its line and what to write."""
    file = tmp_path / "mine.toml"
    file.write_text(HEXAPOD.replace("kp = 20.0", "kp = 2" + "0" * 6000))
    assert lacoc("robot", "check", "--json", str(file)) == 2
    (mistake,) = json.loads(capsys.readouterr().out)["mistakes"]
    assert mistake["found"] == "a number with too many digits"
    assert mistake["expected"] == "a number of at most 15 digits"
    assert HEXAPOD.splitlines()[mistake["row"] - 1].startswith("kp = ")


def test_check_by_a_contest(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """`robot check --contest` applies the limits of that contest."""
    contest = tmp_path / "contest.toml"
    assert lacoc("contest", "init", str(contest)) == 0
    assert lacoc("robot", "check", "hexapod", "--contest", str(contest)) == 0
    contest.write_text(contest.read_text().replace("[limits]", "[limits]\nang_min_deg_s = 100\n#"))
    assert lacoc("robot", "check", "hexapod", "--contest", str(contest)) == 2
    assert "drive.ang_min_deg_s" in capsys.readouterr().err


def test_list(capsys: pytest.CaptureFixture[str]) -> None:
    """`robot list` shows every installed robot; --json prints their facts, such as the legs."""
    assert lacoc("robot", "list") == 0
    out = capsys.readouterr().out
    assert all(name in out for name in ("hexapod", "long-legs", "octopod", "quadruped"))
    assert lacoc("robot", "list", "--json") == 0
    assert json.loads(capsys.readouterr().out)["octopod"]["legs"] == 8


def test_export_keeps_the_older_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """`robot export` writes MJCF and keeps an older file under a number."""
    out = tmp_path / "out.xml"
    out.write_text("mine")
    assert lacoc("robot", "export", "hexapod", str(out)) == 0
    assert out.read_text().startswith("<mujoco")
    assert (tmp_path / "out.1.xml").read_text() == "mine"
    assert "out.1.xml" in capsys.readouterr().err


def test_export_without_mujoco(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """If MuJoCo is missing, `robot export` says in one line how to install MuJoCo."""
    monkeypatch.delitem(sys.modules, "lacoc_robots.model", raising=False)
    monkeypatch.setitem(sys.modules, "mujoco", None)
    assert lacoc("robot", "export", "hexapod", str(tmp_path / "out.xml")) == 2
    assert installing.command("server") in capsys.readouterr().err
    assert not (tmp_path / "out.xml").exists()


def test_nothing_there(capsys: pytest.CaptureFixture[str]) -> None:
    """`robot check` of an unknown robot prints one line and exits with code 2."""
    assert lacoc("robot", "check", "centipede") == 2
    printed = capsys.readouterr()
    assert printed.err.count("\n") == 1
    assert 'There is no robot "centipede"' in printed.err
