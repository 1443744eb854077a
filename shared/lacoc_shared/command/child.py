"""A `lacoc` process, such as a court or a studio, that a command starts and ends for itself."""

import json
import math
import os
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import Any

from lacoc_shared.command import parent, screen
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import Phrase, current, render, say

NOT_AGAIN = 75
"""A process that ends with this exit code must not be started again."""
_OPEN_S = 60.0
"""Longest time until a process must be ready [s], also on a slow machine."""
_CLOSE_S = 10.0
_LOOK_S = 0.02
_STARTS = 3
"""How often a process is started again if it is killed before it is ready; for `kept_child`."""
_TOLD_S = 60.0
"""Shortest time between two reports that a process ended for the same reason [s]."""
_AGAIN_S = 1.0
"""Time between two checks whether the process has ended and must be started again [s]."""


def command_line(words: Sequence[str]) -> list[str]:
    """Return the command line of a `lacoc` command, from the words after `lacoc`."""
    return [sys.executable, "-m", "lacoc_shared", *words]


def apart() -> dict[str, Any]:
    """Return the options for `subprocess` with which a program starts a `lacoc` process.

    Of the LACOC_ variables, the new process inherits only the language. Ctrl-C does not reach the
    new process; the process that started it must end it. If the starter is killed, the new process
    ends too, because then its own standard input ends (`lacoc_shared.command.parent`).
    """
    environment = {name: value for name, value in os.environ.items() if name[:6] != "LACOC_"}
    return {
        "env": environment | {"LACOC_LANGUAGE": current(), parent.VARIABLE: "pipe"},
        "stdin": subprocess.PIPE,
        "start_new_session": True,
    }


class Child:
    """A `lacoc` command in a process of its own, which prints a line of JSON when it is ready.

    Args:
        words: the words of the command line after `lacoc`.
        folder: folder for the files with the process's output.
        what: name of the process for messages (`child.*`), such as "The studio".
    """

    def __init__(self, words: list[str], folder: Path, what: Phrase) -> None:
        self._what = what
        # The output goes into files: with a pipe that nobody empties, the process would block.
        self._said = folder / "child.out"
        self._complained = folder / "child.err"
        with self._said.open("wb") as out, self._complained.open("wb") as err:
            self._process = subprocess.Popen(command_line(words), stdout=out, stderr=err, **apart())

    def opened(self) -> dict[str, Any]:
        """Wait until the process is ready; return the message that it prints then.

        Raises:
            UserError: if the process ends (the error quotes what it printed), or takes too long.
        """
        deadline_s = time.monotonic() + _OPEN_S
        while time.monotonic() < deadline_s:
            ended = self.ended
            first, end, _ = _text(self._said).partition("\n")
            if end:
                opened: dict[str, Any] = json.loads(first)
                return opened
            if ended:
                why = complaint(_text(self._complained), self._process.returncode)
                raise UserError(say("child.closed", what=self._what, why=why))
            time.sleep(_LOOK_S)
        raise UserError(say("child.slow", what=self._what, seconds=_OPEN_S))

    @property
    def ended(self) -> bool:
        """Whether the process has ended, for any reason."""
        return self._process.poll() is not None

    @property
    def was_killed(self) -> bool:
        """Whether a signal has ended the process."""
        return (self._process.poll() or 0) < 0

    @property
    def ended_for_good(self) -> bool:
        """Whether the process has ended with an exit code that forbids to start it again."""
        return self._process.poll() == NOT_AGAIN

    def show_crash(self) -> None:
        """If the process crashed, print its errors, because the file with them is deleted soon."""
        if self._process.poll():
            screen.note(_text(self._complained))

    @property
    def complaint(self) -> str:
        """The error with which the process ended; "": it runs, or something killed it."""
        if self.was_killed or not self.ended:
            return ""
        return complaint(_text(self._complained), self._process.returncode)

    def close(self) -> None:
        """End the process that was started."""
        assert self._process.stdin is not None
        self._process.stdin.close()
        self._process.terminate()
        try:
            self._process.wait(_CLOSE_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()


@contextmanager
def child(words: list[str], folder: Path, what: Phrase) -> Iterator[dict[str, Any]]:
    """Run a `lacoc` command until the `with` block ends; yield the message it prints when ready.

    Args:
        words: the words of the command line after `lacoc`.
        folder: folder for the files with the process's output.
        what: name of the process for messages (`child.*`), such as "The studio".

    Raises:
        UserError: if the process does not become ready.
    """
    process = Child(words, folder, what)
    with ExitStack() as stack:
        stack.callback(process.close)
        yield process.opened()
        process.show_crash()


@contextmanager
def kept_child(
    words: list[str],
    folder: Path,
    what: Phrase,
    again: Callable[[dict[str, Any]], list[str]],
    tell: Callable[[Phrase], None] | None = None,
) -> Iterator[dict[str, Any]]:
    """Run a `lacoc` command as `child` does, and start it again whenever it ends.

    It is not started again after the exit code `NOT_AGAIN`. If it fails at its first start, an
    error is raised.

    Args:
        words: the words of the command line after `lacoc`.
        folder: folder for the files with the process's output.
        what: name of the process for messages (`child.*`), such as "The studio".
        again: takes the message of the first start, and returns the words for all later starts.
        tell: called, from another thread, when the process is started again after it was ready;
            None: nobody is told.

    Raises:
        UserError: if the process does not become ready at first.
    """
    process = Child(words, folder, what)
    ending = threading.Event()

    def keep(words: list[str]) -> None:
        nonlocal process
        told, told_s = "", -math.inf
        while not ending.wait(_AGAIN_S) and not process.ended_for_good:
            if not process.ended:
                continue
            with suppress(OSError, ValueError):  # nobody can be told, or read why
                why, now_s = process.complaint, time.monotonic()
                if tell is not None and (why != told or now_s - told_s > _TOLD_S):
                    told, told_s = why, now_s
                    tell(say("child.again", what=what, why=why or None))
            with suppress(OSError):  # no process can be started now: it is tried again
                process = Child(words, folder, what)

    with ExitStack() as stack:
        stack.callback(lambda: process.close())
        for _ in range(_STARTS):
            try:
                opened = process.opened()
                break
            except UserError:
                if not process.was_killed:  # it said itself why it can't start
                    raise
                process = Child(words, folder, what)
        else:
            opened = process.opened()
        keeper = threading.Thread(target=keep, args=(again(opened),), daemon=True)
        keeper.start()
        stack.callback(keeper.join)
        stack.callback(ending.set)
        yield opened


def complaint(errors: str, exit_code: int | None) -> str:
    """Return the error with which a `lacoc` process ended, without the word "Error:".

    Args:
        errors: the text that the process wrote to standard error.
        exit_code: exit code of the process; it is reported if there is no text.
    """
    said = errors.strip() or f"its process ended with {exit_code}."
    return said.removeprefix(render(say("command.error"))).strip()


def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8", errors="replace")
