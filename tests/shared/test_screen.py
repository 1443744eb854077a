"""The output of the command line for people and for programs."""

import io
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from lacoc_shared.command import screen
from lacoc_shared.messages import Done
from lacoc_shared.mistakes import Mistake, text_of
from lacoc_shared.words import say


def test_text_is_no_markup_and_is_never_broken(capsys: pytest.CaptureFixture[str]) -> None:
    """A key such as [x] shows as it is; in a pipe a long line stays one line."""
    long = "[x] " + "word " * 100

    screen.show(long)

    assert capsys.readouterr().out.rstrip() == long.rstrip()


def test_results_and_remarks_go_different_ways(capsys: pytest.CaptureFixture[str]) -> None:
    """A pipe carries results only: notes, warnings and errors are on standard error."""
    screen.show("result")
    screen.note("written")
    screen.warn("late")
    screen.error("[stop]")

    assert capsys.readouterr() == ("result\n", "written\nNote: late\nError: [stop]\n")


def test_json_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    """Plain values, messages and bytes, a line each, so that a program reads line by line."""
    screen.print_json({"done": Done(say("note.seat-stays")), "scores": (1, 2), "bytes": b"\x00"})
    screen.print_json([])

    first, second = capsys.readouterr().out.splitlines()
    assert json.loads(first) == {
        "done": {"said": {"code": "note.seat-stays"}},
        "scores": [1, 2],
        "bytes": "AA==",
    }
    assert second == "[]"


def test_a_table_of_mistakes_has_the_columns_it_needs() -> None:
    """A text file's mistakes have rows, a robot file's have entries."""
    text = Mistake(file="a.txt", row=1, found="x", expected="a number")
    robot = Mistake(file="r.toml", field="body.mass_kg", found="-1", expected="0.005 to 1")

    headers = [str(column.header) for column in screen.mistakes_table([text]).columns]
    assert headers == ["file", "row", "found", "expected"]
    headers = [str(column.header) for column in screen.mistakes_table([text, robot]).columns]
    assert headers == ["file", "row", "entry", "found", "expected"]


def test_one_mistake_is_one(capsys: pytest.CaptureFixture[str]) -> None:
    """The heading counts, and says that the file is refused whole (rules 2)."""
    screen.refused([Mistake(file="a.txt", found="nothing", expected="a table")])

    err = capsys.readouterr().err
    assert err.startswith("Error: 1 mistake. Nothing of the file is used")
    assert "a table" in err


NOT_UTF_8 = os.fsdecode(b"Bad\x98\x8b.txt")
"""What a zip from Japanese Windows gives, as Python keeps it."""


def test_a_name_that_is_no_text_becomes_text() -> None:
    """Bytes that are not UTF-8 are shown by their numbers; any other name stays as it is."""
    assert text_of(NOT_UTF_8) == r"Bad\x98\x8b.txt"
    assert text_of(Path("六足.txt")) == "六足.txt"


@pytest.mark.parametrize("encoding", ["utf-8", "cp932", "cp1252", "ascii"])
def test_every_character_can_be_shown(encoding: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """A character that the terminal lacks is written as a number; JSON reads back unchanged."""
    stream = io.TextIOWrapper(io.BytesIO(), encoding=encoding)
    monkeypatch.setattr(sys, "stdout", stream)
    names = ["Möwe", "六足 🤖", "a\N{NO-BREAK SPACE}b", NOT_UTF_8]
    screen.accept_any_text()
    screen.show(
        screen.mistakes_table([Mistake(file=name, found="", expected="") for name in names])
    )
    screen.print_json({"names": names, NOT_UTF_8: Mistake(file=NOT_UTF_8, found="", expected="")})
    *table, line = stream.buffer.getvalue().decode(encoding).splitlines()
    assert r"Bad\x98\x8b.txt" in "".join(table)
    read = json.loads(line)
    assert read["names"] == [*names[:3], r"Bad\x98\x8b.txt"]
    assert read[r"Bad\x98\x8b.txt"]["file"] == r"Bad\x98\x8b.txt"


@pytest.mark.skipif(sys.platform == "win32", reason="such names can't exist there")
def test_no_name_is_a_traceback(tmp_path: Path) -> None:
    """The whole command: a wrong gait in a file whose name is not UTF-8, at an old terminal."""
    folder = os.fsencode(tmp_path)
    with open(folder + b"/Bad\x98\x8b.txt", "wb") as file:
        file.write(b"Num of Posture\t1\n0 Key\tM\xc3\xb6we\xc2\xa0\n")
    words = [sys.executable, "-m", "lacoc_shared", "gait", "check", "--json"]
    done = subprocess.run(
        [*map(os.fsencode, words), b"Bad\x98\x8b.txt"],
        capture_output=True,
        cwd=tmp_path,
        env=os.environ | {"PYTHONIOENCODING": "cp932"},
        timeout=60,
        check=False,
    )
    assert (done.returncode, done.stderr) == (2, b"")
    mistakes = json.loads(done.stdout)["mistakes"]
    assert {mistake["file"] for mistake in mistakes} == {r"Bad\x98\x8b.txt"}
    assert "Möwe" in mistakes[-1]["found"]
