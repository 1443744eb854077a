"""Tests of bots in users' files: each mistake is reported with its line."""

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
    ],
)
def test_what_is_a_key(tmp_path: Path, returns: str, expected: Key | None) -> None:
    """A brain returns None or a key; the key's level may be a plain 0 or 1."""
    assert play(tmp_path, brain(returns)) == expected


@pytest.mark.parametrize(
    "returns",
    ["2", "(1, 2)", "Key(1, 42)", "Key(1, -1)", "Key(2, 1)", "Key('B', 2)", "Key(1, 2.0)"],
)
def test_what_is_no_key(tmp_path: Path, returns: str) -> None:
    """If a brain returns anything but a valid key or None, the error says what was expected."""
    with pytest.raises(UserError, match=r"my_bot\.py:5\) returned .*Expected a Key\(level"):
        play(tmp_path, brain(returns))


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
        ("import no_such_package\n", r"needs the module no_such_package \(.*py:4\), which"),
        ("def bot(sheet, seat)\n", r"py:4\): SyntaxError: expected ':'"),
    ],
)
def test_the_line_of_a_mistake(tmp_path: Path, text: str, says: str) -> None:
    """The message about a mistake in a bot is one line, and names the line of the bot's file."""
    with pytest.raises(UserError, match=rf"^The bot .*my_bot\.py.*{says}") as refused:
        play(tmp_path, text)
    assert "\n" not in str(refused.value)
