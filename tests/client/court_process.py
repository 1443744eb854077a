"""Runs a court in a process of its own, and commands that connect to this court."""

import json
import os
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

from lacoc_process import Lacoc
from waiting import LIMIT_S


def environment(**changes: str) -> dict[str, str]:
    """Return this process's environment without LACOC_ variables (options), and with `changes`."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith("LACOC_")}
    return kept | changes


class CourtProcess:
    """A court that `lacoc serve` runs on a free port."""

    def __init__(self, folder: Path, *words: str) -> None:
        self.folder = folder
        where = ("--listen", "tcp/127.0.0.1:0", "--recordings", str(folder / "recordings"))
        with (folder / "court.log").open("wb") as log:
            self.process = Lacoc(
                *("serve", "--json", *where, *words),
                stdout=subprocess.PIPE,
                stderr=log,
                text=True,
                env=environment(),
            )
        assert self.process.stdout is not None
        self.opened = opened = json.loads(self.process.stdout.readline())
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

    def close(self) -> None:
        for process in (*self._commands, self.process):
            process.terminate()
        for process in (*self._commands, self.process):
            process.communicate(timeout=LIMIT_S)


OpenCourt = Callable[..., CourtProcess]
"""A function that opens a court; its arguments are words for `lacoc serve`."""
