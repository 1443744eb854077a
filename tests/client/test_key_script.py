"""Tests of key scripts: the small language of keys and times that comes through a pipe."""

import os
from collections.abc import Iterator

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lacoc_client.play.terminal.pipe_keys import PipeKeys
from lacoc_shared.gait.key_script import KeyScript
from lacoc_shared.words import render

BEAT_S = 0.02


def played(script: KeyScript, seconds: float) -> Iterator[tuple[float, str]]:
    """Yield the time [s] and the name of each key that a script presses from the start of play."""
    for tick in range(1, round(seconds / BEAT_S) + 1):
        for key in script.due(tick * BEAT_S, True):
            yield round(tick * BEAT_S, 2), key


def script_of(*lines: str) -> KeyScript:
    script = KeyScript()
    for line in lines:
        assert script.add(line) is None
    return script


@pytest.mark.parametrize(
    ("lines", "expected"),
    [
        (["2"], [(0.02, "2")]),
        (["1 2 3 4"], [(0.02, "1"), (0.04, "2"), (0.06, "3"), (0.08, "4")]),
        (["1234"], [(0.02, "1"), (0.04, "2"), (0.06, "3"), (0.08, "4")]),
        (["1.5 3", "0.5 x"], [(1.5, "3"), (2.0, "x")]),
        (["tab 1"], [(0.02, "tab"), (0.02, "1")]),
        (
            ["0.5 up left", "# a remark", "", "1.0 0  # stand"],
            [(0.5, "up"), (0.52, "left"), (1.52, "0")],
        ),
        (["TAB X"], [(0.02, "tab"), (0.02, "x")]),
        (["1.0 z"], [(1.0, "z")]),
    ],
)
def test_a_script_presses_each_key_in_its_time(
    lines: list[str], expected: list[tuple[float, str]]
) -> None:
    """A script presses at most one robot key in a tick; a time counts from the previous key."""
    assert list(played(script_of(*lines), 3.0)) == expected


def test_keys_that_move_the_robot_wait_for_play() -> None:
    """A key that moves the robot, and every key after it, waits until play begins (rules 4)."""
    script = script_of("r", "2", "q")

    assert script.due(0.0, False) == ["r"]
    assert script.due(0.0, False) == []
    assert script.due(0.02, True) == ["2", "q"]
    assert script.empty


def test_time_stands_still_while_the_match_is_halted() -> None:
    """A script's time runs only while the match is played, so a halt delays its keys."""
    script = script_of("2", "1.0 3")

    assert script.due(0.02, True) == ["2"]
    assert [script.due(0.5, False) for _ in range(100)] == [[]] * 100
    assert script.due(1.02, True) == ["3"]


@pytest.mark.parametrize("line", ["hello", "-1.5 2", "nan 2", "1e999.0 3", "2 up down jump", "²"])
def test_a_wrong_line_is_left_out_and_named(line: str) -> None:
    """A wrong line is left out and named by its number; the other lines are played."""
    script = script_of("1")

    wrong = script.add(line)
    assert wrong is not None
    assert render(wrong).startswith("Line 2 can't be used: ")
    assert script.add("3") is None
    assert [key for _, key in played(script, 1.0)] == ["1", "3"]


@given(st.lists(st.text()))
def test_no_line_breaks_a_script(lines: list[str]) -> None:
    """A script of any text presses only known keys and raises no exception."""
    script = KeyScript()
    for line in lines:
        script.add(line)
    known = set("0123456789xzrq") | {"tab", "space", "up", "down", "left", "right"}

    assert {key for _, key in played(script, 1.0)} <= known


def test_a_pipe_is_read_to_its_end() -> None:
    """The last line of a pipe needs no line end, and a wrong line is reported once."""
    read, write = os.pipe()
    keys = PipeKeys(read)
    os.write(write, b"r\nwhat\n2")
    pressed: list[str] = []
    while "r" not in pressed:
        pressed += keys.read(1.0, 0.0, False)
    assert not keys.ended
    os.close(write)
    while not keys.ended:
        pressed += keys.read(1.0, 0.02, True)
    os.close(read)

    assert pressed == ["r", "2"]
    assert [render(said)[:6] for said in keys.take_said()] == ["Line 2"]
    assert keys.take_said() == []
