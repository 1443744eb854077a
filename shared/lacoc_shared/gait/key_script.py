"""A script of keys: a small language, so that a file or a program can play.

A line holds keys, which are pressed in order: `2`, or `tab 1`, or `1 2 3 4` (also `1234`). A line
may begin with a time [s], which has a decimal point: `1.5 3` presses key 3 when 1.5 s have passed
after the keys before. Times count only while the match is played, and keys that move the robot wait
until it is played. `#` begins a comment.
"""

import math
from collections import deque
from typing import NamedTuple

from lacoc_shared.words import Phrase, say

NAMED = ("tab", "space", "up", "down", "left", "right")
MOVING = frozenset("0123456789x") | {"up", "down", "left", "right"}
"""Keys that have an effect only while the match is played."""
ARROWS = {"up": 2, "left": 1, "right": 3, "down": 0}
"""The digit that each arrow key stands for, at level B."""
_LETTERS = frozenset("xzrq")


class _ScriptStep(NamedTuple):
    wait_s: float
    key: str


class KeyScript:
    """Holds the keys of a script, and returns each key when its time has come."""

    def __init__(self) -> None:
        self._steps: deque[_ScriptStep] = deque()
        self._since_s = 0.0
        """Time of play at which the last key was due [s]; the times in the script count from
        there."""
        self._moved_s = -1.0
        """Time of play at which the last key that moves the robot was pressed [s]."""
        self._lines = 0

    def add(self, line: str) -> Phrase | None:
        """Read a line of the script, and add its keys.

        Returns:
            What is wrong with the line, whose keys are then left out; None: nothing is wrong.
        """
        self._lines += 1
        words = line.partition("#")[0].split()
        wait_s = _number(words[0]) if len(words) > 1 else None
        typed = words[wait_s is not None :]
        wrong = next((word for word in typed if not all(map(_known, _keys(word)))), None)
        if wrong is not None:
            return say("script.no-key", line=self._lines, key=wrong)
        if wait_s is not None and not 0 <= wait_s < math.inf:
            return say("script.no-time", line=self._lines, time=words[0])
        for index, key in enumerate(key for word in typed for key in _keys(word)):
            self._steps.append(_ScriptStep(0.0 if index else wait_s or 0.0, key))
        return None

    def due(self, playing_s: float, playing: bool) -> list[str]:
        """Return the keys whose time has come; at most one of them moves the robot.

        Args:
            playing_s: how long the match has been played [s].
            playing: whether the match is being played now.
        """
        keys: list[str] = []
        while self._steps:
            wait_s, key = self._steps[0]
            if playing_s < self._since_s + wait_s:
                break
            if key in MOVING and not (playing and playing_s > self._moved_s):
                break
            self._steps.popleft()
            keys.append(key)
            if key in MOVING:
                self._moved_s = playing_s
            self._since_s = self._since_s + wait_s if wait_s else max(self._since_s, playing_s)
        return keys

    @property
    def empty(self) -> bool:
        """Whether all keys of the script so far have been returned."""
        return not self._steps


def _keys(word: str) -> list[str]:
    """Return the keys for which a word stands: one key with a name, or one for each character."""
    word = word.lower()
    return [word] if word in NAMED or len(word) == 1 else list(word)


def _known(key: str) -> bool:
    return key in MOVING or key in _LETTERS or key in NAMED


def _number(word: str) -> float | None:
    if "." not in word:  # without a point these are keys: "1 2 3 4"
        return None
    try:
        return float(word)
    except ValueError:
        return None
