"""The output of the command line, for people and for programs."""

import io
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from rich.table import Table
from waiting import LIMIT_S

from lacoc_shared.command import screen
from lacoc_shared.messages import Done
from lacoc_shared.mistakes import Mistake, text_of
from lacoc_shared.words import say


def test_text_is_no_markup_and_is_never_broken(capsys: pytest.CaptureFixture[str]) -> None:
    """Square brackets such as [x] are shown unchanged, and a long line in a pipe is not broken."""
    long = "[x] " + "word " * 100

    screen.show(long)

    assert capsys.readouterr().out.rstrip() == long.rstrip()


def test_a_table_in_a_pipe_is_not_padded(capsys: pytest.CaptureFixture[str]) -> None:
    """In a pipe, a long cell of a table is not broken, and the lines of other cells are short."""
    table = Table(show_header=False, box=None)
    table.add_row("teams", "Ants")
    table.add_row("how", "word " * 100 + "end")
    screen.show(table)

    first, second = capsys.readouterr().out.splitlines()
    assert first.split() == ["teams", "Ants"]
    assert first == first.rstrip()
    assert second.endswith("word end")


def test_results_and_remarks_go_different_ways(capsys: pytest.CaptureFixture[str]) -> None:
    """Results go to standard output; notes, warnings and errors go to standard error."""
    screen.show("result")
    screen.note("written")
    screen.warn("late")
    screen.error("[stop]")

    assert capsys.readouterr() == ("result\n", "written\nNote: late\nError: [stop]\n")


def test_json_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    """`print_json` prints each value as one line of JSON, also messages and bytes."""
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
    """The table of mistakes has only the columns that at least one mistake fills."""
    text = Mistake(file="a.txt", row=1, found="x", expected="a number")
    robot = Mistake(file="r.toml", field="body.mass_kg", found="-1", expected="0.005 to 1")

    headers = [str(column.header) for column in screen.mistakes_table([text]).columns]
    assert headers == ["file", "row", "found", "expected"]
    headers = [str(column.header) for column in screen.mistakes_table([text, robot]).columns]
    assert headers == ["file", "row", "entry", "found", "expected"]


def test_one_mistake_is_one(capsys: pytest.CaptureFixture[str]) -> None:
    """The heading has the number of mistakes, and says that nothing of the file is used."""
    screen.refused([Mistake(file="a.txt", found="nothing", expected="a table")])

    err = capsys.readouterr().err
    assert err.startswith("Error: 1 mistake. The file is not used")
    assert "a table" in err


NOT_UTF_8 = os.fsdecode(b"Bad\x98\x8b.txt")
"""A file name in Shift-JIS, as a zip file from Japanese Windows has it, decoded by Python."""


def test_a_name_that_is_no_text_becomes_text() -> None:
    """Bytes of a name that are not UTF-8 are shown as numbers; any other name stays as it is."""
    assert text_of(NOT_UTF_8) == r"Bad\x98\x8b.txt"
    assert text_of(Path("六足.txt")) == "六足.txt"


@pytest.mark.parametrize("encoding", ["utf-8", "cp932", "cp1252", "ascii"])
def test_every_character_can_be_shown(encoding: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """A character that the terminal lacks is written as a number; JSON is read back unchanged."""
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
    """`lacoc gait check` works with a file's name and a terminal that are not in UTF-8."""
    folder = os.fsencode(tmp_path)
    with open(folder + b"/Bad\x98\x8b.txt", "wb") as file:
        file.write(b"Num of Posture\t1\n0 Key\tM\xc3\xb6we\xc2\xa0\n")
    words = [sys.executable, "-m", "lacoc_shared", "gait", "check", "--json"]
    done = subprocess.run(
        [*map(os.fsencode, words), b"Bad\x98\x8b.txt"],
        capture_output=True,
        cwd=tmp_path,
        env=os.environ | {"PYTHONIOENCODING": "cp932"},
        timeout=LIMIT_S,
        check=False,
    )
    assert (done.returncode, done.stderr) == (2, b"")
    mistakes = json.loads(done.stdout)["mistakes"]
    assert {mistake["file"] for mistake in mistakes} == {r"Bad\x98\x8b.txt"}
    assert "Möwe" in mistakes[-1]["found"]
