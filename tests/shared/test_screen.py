"""What the command line prints for people and for programs."""

import json

import pytest

from lacoc_shared.command import screen
from lacoc_shared.messages import Done
from lacoc_shared.mistakes import Mistake


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
    screen.print_json({"done": Done("ok"), "scores": (1, 2), "bytes": b"\x00"})
    screen.print_json([])

    first, second = capsys.readouterr().out.splitlines()
    assert json.loads(first) == {"done": {"text": "ok"}, "scores": [1, 2], "bytes": "AA=="}
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
