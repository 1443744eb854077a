"""Keys of a script that comes through a pipe; `gait.key_script` describes its form."""

import os
import queue
import threading

from lacoc_shared.gait.key_script import KeyScript
from lacoc_shared.words import Phrase

_READ_BYTES = 4096


class PipeKeys:
    """The keys of a script that comes through a pipe.

    On some systems a program can't see whether a pipe has data, so a thread of its own reads the
    pipe.
    """

    def __init__(self, descriptor: int) -> None:
        self._lines: queue.SimpleQueue[str | None] = queue.SimpleQueue()
        self._script = KeyScript()
        self._said: list[Phrase] = []
        self._read_all = False
        threading.Thread(target=_read_lines, args=(descriptor, self._lines), daemon=True).start()

    @property
    def ended(self) -> bool:
        """True if the script was read and all its keys were pressed."""
        return self._read_all and self._script.empty

    def read(self, timeout_s: float, playing_s: float, playing: bool) -> list[str]:
        """Return the keys of the script whose time has come; see `keys.KeySource`."""
        try:
            while True:
                line = self._lines.get(timeout=timeout_s)
                timeout_s = 0.0
                if line is None:
                    self._read_all = True
                elif wrong := self._script.add(line):
                    self._said.append(wrong)
        except queue.Empty:
            return self._script.due(playing_s, playing)

    def take_said(self) -> list[Phrase]:
        """Return the mistakes in the script since the last call; see `keys.KeySource`."""
        said, self._said = self._said, []
        return said


def _read_lines(descriptor: int, lines: "queue.SimpleQueue[str | None]") -> None:
    """Put each line of the pipe into the queue, and None after the last line."""
    rest = b""
    while data := os.read(descriptor, _READ_BYTES):
        *whole, rest = (rest + data).split(b"\n")
        for line in whole:
            lines.put(line.decode("utf-8", "replace"))
    if rest:
        lines.put(rest.decode("utf-8", "replace"))
    lines.put(None)
