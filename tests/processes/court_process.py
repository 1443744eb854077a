"""Runs a court in a process of its own, and commands that connect to this court."""

import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any, Self

from lacoc_process import Lacoc, Running, environment
from waiting import LIMIT_S


class CourtProcess:
    """A court that `lacoc serve` runs on a free port; a context manager.

    Args:
        folder: for records and log.
        words: more words of `lacoc serve`.
        fresh: whether it gets a new interpreter, as what is measured must have.
    """

    def __init__(self, folder: Path, *words: str, fresh: bool = False) -> None:
        self.folder = folder
        where = ("--listen", "tcp/127.0.0.1:0", "--recordings", str(folder / "recordings"))
        words = ("serve", "--json", *where, *words)
        log = folder / "court.log"
        self._court = Running(*words, log=log, fresh=fresh, env=environment())
        self.process = self._court.process
        self.opened = opened = self._court.opened
        self.name: str = opened["court"]
        self.address: str = opened["locators"][0]
        self.tokens: dict[str, str] = opened["tokens"]
        self.referee: str = opened["referee"]
        self._commands: list[Lacoc] = []

    def where(self, seat: str = "") -> list[str]:
        """Return the options that connect a command to the court, and to a seat if one is named."""
        if not seat:
            return ["--connect", self.address]
        return ["--connect", self.address, "--token", self.tokens[seat]]

    def start(self, *words: str, **options: Any) -> Lacoc:
        """Start a command; `close` ends it together with the court."""
        settings: dict[str, Any] = {
            "stdin": subprocess.DEVNULL,
            "stdout": subprocess.PIPE,
            "stderr": subprocess.STDOUT,
            "text": True,
            "cwd": self.folder,
            "env": environment(),
        }
        command = Lacoc(*words, **settings | options)
        self._commands.append(command)
        return command

    def bots(self, left: str = "straight", right: str = "straight") -> None:
        """Put a bot in each seat."""
        for seat, name in (("left", left), ("right", right)):
            self.start("bot", name, *self.where(seat), stdout=subprocess.DEVNULL)

    def hush(self) -> None:
        """Throw away all further output of the court."""
        self._court.hush()

    def close(self) -> None:
        for command in self._commands:
            command.terminate()
        for command in self._commands:
            command.communicate(timeout=LIMIT_S)
        self._court.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


OpenCourt = Callable[..., CourtProcess]
"""A function that opens a court; its arguments are words for `lacoc serve`."""
