"""Tests of bots in users' files: each mistake is reported with its line."""

import os
from pathlib import Path
from typing import Any

import pytest
from stage import Stage

from lacoc_arenas import arena as arenas
from lacoc_arenas import brains
from lacoc_arenas.bot import Key
from lacoc_shared.gait.tables import Level
from lacoc_shared.mistakes import UserError
from lacoc_shared.seat import RESTART_KEY

OTHELLO = arenas.load("othello")
HEAD = """\
from lacoc_arenas.bot import Key
from lacoc_shared.gait.tables import Level

"""


def play(folder: Path, text: str) -> Any:
    """Return the key that a bot file chooses for the first frame."""
    path = folder / "my_bot.py"
    path.write_text(HEAD + text, encoding="utf-8")
    stage = Stage("othello")
    beat = stage.beat()
    return brains.find(OTHELLO, str(path))(stage.match.sheet(), 0)(beat.frame)


def brain(returns: str) -> str:
    lines = ("def bot(sheet, seat):", "    def brain(frame):", f"        return {returns}")
    return "\n".join([*lines, "    return brain", ""])


@pytest.mark.parametrize(
    ("returns", "expected"),
    [
        ("None", None),
        ("Key(Level.LOCOMOTION, 2)", Key(Level.LOCOMOTION, 2)),
        ("Key(0, 10)", Key(Level.POSTURE, RESTART_KEY)),
        ("Key(1.0, Level(1))", Key(Level.LOCOMOTION, 1)),
        ("Key(1, type('Digit', (int,), {})(2))", Key(Level.LOCOMOTION, 2)),
    ],
)
def test_what_is_a_key(tmp_path: Path, returns: str, expected: Key | None) -> None:
    """A brain returns None or a key; its numbers become plain ones, which a record can hold."""
    key = play(tmp_path, brain(returns))
    assert key == expected
    assert key is None or (type(key.level), type(key.key)) == (Level, int)


@pytest.mark.parametrize(
    "returns",
    [
        "2",
        "(1, 2)",
        "Key(1, 42)",
        "Key(1, -1)",
        "Key(2, 1)",
        "Key('B', 2)",
        "Key(1, 2.0)",
        "Key(1, True)",
        "type('Hm', (), {'__repr__': lambda self: self.nothing})()",
    ],
)
def test_what_is_no_key(tmp_path: Path, returns: str) -> None:
    """If a brain returns anything but a valid key or None, the error says what was expected."""
    with pytest.raises(UserError, match=r"my_bot\.py:5\) returned .*Expected a Key\(level"):
        play(tmp_path, brain(returns))


def test_annotations_may_be_texts(tmp_path: Path) -> None:
    """A bot may have a dataclass with annotations that are texts, in its file and in `bot`."""
    text = "from dataclasses import dataclass\n@dataclass\nclass Target:\n    key: 'int' = 2\n"
    inner = "    @dataclass\n    class Memory:\n        target: 'Target'\n"
    text += f"def bot(sheet, seat):\n{inner}"
    text += "    return lambda frame: Key(1, Memory(Target()).target.key)\n"
    assert play(tmp_path, text) == Key(Level.LOCOMOTION, 2)


def test_a_file_whose_name_is_no_text(tmp_path: Path) -> None:
    """A bot file plays, whatever bytes its name has."""
    path = (tmp_path / os.fsdecode(b"\x98\x8b")).with_suffix(".py")
    path.write_text("def bot(sheet, seat):\n    return lambda frame: None\n")
    assert brains.find(OTHELLO, str(path))(Stage("othello").match.sheet(), 0)


def test_a_bot_changes_no_sheet_of_others(tmp_path: Path) -> None:
    """What a bot does to its sheet, the bots in the other seats do not see."""
    path = tmp_path / "my_bot.py"
    path.write_text("def bot(sheet, seat):\n    sheet.settings['game'].clear()\n    return print\n")
    sheet = Stage("othello").match.sheet()
    brains.find(OTHELLO, str(path))(sheet, 0)
    assert sheet.settings["game"]["pitch_m"]


def test_a_brain_that_is_no_function(tmp_path: Path) -> None:
    """A brain may be an object of any class; if it has no line, the message names none."""
    text = "class Brain:\n    __call__ = lambda self, frame: 2\n"
    text += "    __getattr__ = lambda self, name: self.nothing\n"
    with pytest.raises(UserError, match=r"my_bot\.py returned 2\. Expected a Key\(level"):
        play(tmp_path, f"{text}def bot(sheet, seat):\n    return Brain()\n")


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (
            "def bot(sheet):\n    return None\n",
            r"py:4\) can't be called: .* 2 were given\. Expected",
        ),
        (
            "def bot(sheet, seat):\n    def brain():\n        pass\n    return brain\n",
            r"py:5\) can't be called: .* brain\(frame\)\.",
        ),
        ("def bot(sheet, seat):\n    return 2\n", r"py:4\) returned 2\. Expected a function"),
        ("def bot(sheet, seat):\n    return sheet.team\n", r"py:5\): AttributeError: .*'team'"),
        (brain("frame.seats[7]"), r"py:6\): IndexError: "),
        (brain("Level(frame.seats)"), r"py:6\): ValueError: "),
        (brain("exec('raise GeneratorExit')"), r"py:6\): GeneratorExit: "),
        ("import asyncio; raise asyncio.CancelledError\n", r"py:4\): CancelledError: "),
        (
            "class Hm(Exception):\n    def __str__(self): return self.nothing\nraise Hm\n",
            r"py:6\): Hm: Hm\.",
        ),
        ("import no_such_package\n", r"needs the module no_such_package \(.*py:4\), which"),
        ("def bot(sheet, seat)\n", r"py:4\): SyntaxError: expected ':'"),
    ],
)
def test_the_line_of_a_mistake(tmp_path: Path, text: str, says: str) -> None:
    """The message about a mistake in a bot is one line, and names the line of the bot's file."""
    with pytest.raises(UserError, match=rf"^The bot .*my_bot\.py.*{says}") as refused:
        play(tmp_path, text)
    assert "\n" not in str(refused.value)
