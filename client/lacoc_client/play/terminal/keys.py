"""Keys from a terminal, one by one, as they are pressed.

When reading ends, also by an error, the terminal gets its former settings back.
"""

import codecs
import os
import re
import select
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Protocol

from lacoc_client.play.terminal.pipe_keys import PipeKeys
from lacoc_shared.gait.cells import narrow
from lacoc_shared.words import Phrase

if sys.platform == "win32":
    import msvcrt
else:
    import termios
    import tty

_ESCAPE = re.compile(r"\x1b(?:\[[0-9;?]*[ -/]*[@-~]|O.)")
_BEGUN = re.compile(r"\x1b(?:\[[0-9;?]*[ -/]*|O)?")
"""The beginning of such a sequence; the rest of it may come with the next bytes."""
_NAMES = {
    "\x1b[A": "up",
    "\x1b[B": "down",
    "\x1b[C": "right",
    "\x1b[D": "left",
    "\x1bOA": "up",
    "\x1bOB": "down",
    "\x1bOC": "right",
    "\x1bOD": "left",
    "\t": "tab",
    " ": "space",
}
_WINDOWS_ARROWS = {"H": "up", "P": "down", "K": "left", "M": "right"}
_WINDOWS_LOOK_S = 0.005


class KeySource(Protocol):
    """Something from which keys come: a terminal, or a script in a pipe."""

    @property
    def ended(self) -> bool:
        """Whether no more keys will come."""

    def read(self, timeout_s: float, playing_s: float, playing: bool) -> list[str]:
        """Wait for keys of the player; return their names, such as "2", "x", "up" or "space".

        Args:
            timeout_s: longest wait [s].
            playing_s: how long the match has been played [s]; the times in a script refer to it.
            playing: whether the match is being played.
        """

    def take_said(self) -> list[Phrase]:
        """Return what was wrong with the keys that came since the last call, as sentences."""


class KeyDecoder:
    """Turns the bytes of a terminal into names of keys."""

    def __init__(self) -> None:
        self._decoder = codecs.getincrementaldecoder("utf-8")(errors="replace")
        self._rest = ""

    def feed(self, data: bytes) -> list[str]:
        """Decode bytes into names of keys; keep an incomplete escape sequence for the next call."""
        text = self._rest + self._decoder.decode(data)
        self._rest = ""
        keys: list[str] = []
        while text:
            sequence = _ESCAPE.match(text)
            if sequence:
                name = _NAMES.get(sequence[0])
                text = text[sequence.end() :]
            elif text[0] == "\x1b":
                if _BEGUN.fullmatch(text):
                    self._rest = text
                    break
                name, text = None, text[1:]
            else:
                name, text = key_name(text[0]), text[1:]
            if name:
                keys.append(name)
        return keys


def key_name(character: str) -> str | None:
    """Return the name of a character's key, even if a Japanese input method made the character."""
    character = narrow(character)
    return _NAMES.get(character) or (character.lower() if character.isprintable() else None)


@contextmanager
def open_keys() -> Iterator[KeySource]:
    """Read keys from standard input: as they are pressed at a terminal, or a script in a pipe."""
    if not sys.stdin.isatty():
        yield PipeKeys(sys.stdin.fileno())
    elif sys.platform == "win32":
        yield _WindowsKeys()
    else:
        descriptor = sys.stdin.fileno()
        before = termios.tcgetattr(descriptor)
        try:
            tty.setcbreak(descriptor)
            yield _PosixKeys(descriptor)
        finally:
            termios.tcsetattr(descriptor, termios.TCSAFLUSH, before)


class _PosixKeys:
    """Keys of a terminal that delivers each character at once."""

    def __init__(self, descriptor: int) -> None:
        self.ended = False
        self._descriptor = descriptor
        self._decoder = KeyDecoder()

    def read(self, timeout_s: float, playing_s: float, playing: bool) -> list[str]:
        if not select.select([self._descriptor], [], [], timeout_s)[0]:
            return []
        try:
            data = os.read(self._descriptor, 1024)
        except OSError:  # the terminal is gone
            data = b""
        self.ended = not data
        return self._decoder.feed(data)

    def take_said(self) -> list[Phrase]:
        return []


if sys.platform == "win32":

    class _WindowsKeys:
        """Keys that are pressed in a Windows console."""

        ended = False

        def read(self, timeout_s: float, playing_s: float, playing: bool) -> list[str]:
            deadline_s = time.monotonic() + timeout_s
            while not msvcrt.kbhit():
                if time.monotonic() >= deadline_s:
                    return []
                time.sleep(_WINDOWS_LOOK_S)
            character = msvcrt.getwch()
            special = character in "\x00\xe0"
            name = _WINDOWS_ARROWS.get(msvcrt.getwch()) if special else key_name(character)
            return [name] if name else []

        def take_said(self) -> list[Phrase]:
            return []
