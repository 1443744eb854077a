"""A command that serves a page to one person."""

import os
import re
import signal
import subprocess
import threading
from contextlib import suppress
from pathlib import Path
from typing import Any, Self

from lacoc_process import COMMAND, Lacoc, environment
from waiting import LIMIT_S

_ROOMS = ("arenas", "client", "robots", "server", "shared")
_ADDRESS = re.compile(r"(http://127\.0\.0\.1:\d+)(/\w+)(?:#key=(\S+))?")


class OwnPage:
    """A command that opens a page for one person and prints its address; a context manager.

    Args:
        folder: where it runs.
        words: the command.
        checkout: root of another checkout whose code runs, or this one's; it then gets a new
            interpreter, as what is measured must have.
    """

    def __init__(self, folder: Path, *words: str, checkout: Path | None = None) -> None:
        options: dict[str, Any] = {
            "stdin": subprocess.DEVNULL,
            "stdout": subprocess.PIPE,
            "stderr": subprocess.STDOUT,
            "text": True,
            "cwd": folder,
            "env": environment(),
        }
        self.process: subprocess.Popen[str]
        if checkout is None:
            self.process = Lacoc(*words, "--no-open", **options)
        else:
            path = os.pathsep.join(str(checkout / room) for room in _ROOMS)
            command = [COMMAND[0], "-u", *COMMAND[1:], *words, "--no-open"]
            options["env"] = environment(PYTHONPATH=path)
            self.process = subprocess.Popen(command, **options)
        assert self.process.stdout is not None
        self.said = ""
        """What it has printed so far, and after `close` or `ended` all of it."""
        found = None
        while found is None:
            line = self.process.stdout.readline()
            assert line, self.said
            self.said += line
            found = _ADDRESS.search(line)
        self.url: str = found[1]
        self.path: str = found[2]
        self.key: str = found[3] or ""
        """The page key; empty if there is none."""
        self._reading = threading.Thread(target=self._read, daemon=True)
        self._reading.start()

    @property
    def link(self) -> str:
        """Return the whole address of the page."""
        return f"{self.url}{self.path}#key={self.key}"

    def ended(self) -> int:
        """Press Ctrl-C, and return the exit code."""
        self.process.send_signal(signal.SIGINT)
        self._wait()
        return self.process.returncode

    def close(self) -> None:
        """End the command."""
        self.process.terminate()
        self._wait()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _wait(self) -> None:
        self.process.wait(LIMIT_S)
        self._reading.join(LIMIT_S)

    def _read(self) -> None:
        """Take in all further output: a full pipe would stop the command."""
        assert self.process.stdout is not None
        with suppress(ValueError):  # somebody else has read the rest and closed it
            for line in self.process.stdout:
                self.said += line


THIS = Path(__file__).parents[2]
"""The root of this checkout."""
