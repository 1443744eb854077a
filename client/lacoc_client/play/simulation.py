"""Runs `lacoc simulate` in a process of its own, and reads the lines that it prints."""

import asyncio
import contextlib
from asyncio.subprocess import PIPE, Process
from collections.abc import AsyncIterator, Sequence
from typing import Self

import msgspec

from lacoc_shared.command.child import apart, command_line, complaint
from lacoc_shared.mistakes import Mistake
from lacoc_shared.words import Phrase

_LINE_BYTES = 1 << 24
_LOOK_S = 0.5


class PlayerStanding(msgspec.Struct, frozen=True, kw_only=True):
    """How many matches a player has won, drawn and lost so far."""

    name: str
    rank: int
    """Place from 1; players who are equal share it."""
    won: int
    drawn: int
    lost: int
    points: int
    """Sum of the player's points in all matches."""


class OutputLine(msgspec.Struct, frozen=True, tag_field="kind"):
    """A line that `lacoc simulate --json` prints."""


class LeftOutLine(OutputLine, frozen=True, tag="left-out"):
    """A line that says which player can't play, and for which reason or mistakes."""

    player: str
    mistakes: tuple[Mistake, ...]
    why: Phrase | None


class BeginLine(OutputLine, frozen=True, tag="begin"):
    """A line that says how many matches begin now."""

    matches: int


class MatchResult(msgspec.Struct, frozen=True):
    """The part of a match's result that a tournament of a class needs."""

    scores: tuple[int, int]
    official: str


class MatchLine(OutputLine, frozen=True, tag="match"):
    """A line that says that a match has ended, and how."""

    players: tuple[str, str]
    winner: int | None
    record: str | None
    result: MatchResult


class StandingsLine(OutputLine, frozen=True, tag="standings"):
    """A line with the standings after a match."""

    done: int
    standings: tuple[PlayerStanding, ...]


_lines = msgspec.json.Decoder(LeftOutLine | BeginLine | MatchLine | StandingsLine)


class Simulation:
    """A running `lacoc simulate`; used from the event loop only.

    Args:
        process: its process; `start` makes it.
    """

    def __init__(self, process: Process) -> None:
        assert process.stdout is not None
        assert process.stderr is not None
        self._process = process
        self._out = process.stdout
        self._complaining = asyncio.create_task(process.stderr.read())

    @classmethod
    async def start(cls, words: Sequence[str]) -> Self:
        """Start `lacoc simulate --json` with further words on its command line.

        Raises:
            OSError: if the system can't start another process.
        """
        return cls(
            await asyncio.create_subprocess_exec(
                *command_line(["simulate", "--json", *words]),
                stdout=PIPE,
                stderr=PIPE,
                limit=_LINE_BYTES,
                **apart(),
            )
        )

    async def lines(self) -> AsyncIterator[OutputLine]:
        """Yield the lines that `lacoc simulate` prints, until the command ends.

        The end of the command counts, not the end of its output: after a kill, the command's
        worker processes keep the output open until their matches have ended.
        """
        reading = asyncio.create_task(self._out.readline())
        try:
            while True:
                await asyncio.wait({reading}, timeout=_LOOK_S)
                if reading.done():
                    if not (line := reading.result()).endswith(b"\n"):
                        return
                    yield _lines.decode(line)
                    reading = asyncio.create_task(self._out.readline())
                elif self._process.returncode is not None:
                    return
        finally:
            reading.cancel()

    async def complaint(self) -> str | None:
        """Wait until the command has ended; return the error that it printed; None if none."""
        while self._process.returncode is None:
            await asyncio.sleep(_LOOK_S / 10)
        if self._process.returncode == 0:
            return None
        await asyncio.wait({self._complaining}, timeout=_LOOK_S)
        errors = self._complaining.result() if self._complaining.done() else b""
        last_line = errors.decode(errors="replace").strip().rpartition("\n")[2]
        return complaint(last_line, self._process.returncode)

    def end(self) -> None:
        """Ask the running `lacoc simulate` to end, as Ctrl-C does."""
        with contextlib.suppress(ProcessLookupError):
            self._process.terminate()

    def close(self) -> None:
        """Kill the running `lacoc simulate`."""
        self._complaining.cancel()
        with contextlib.suppress(ProcessLookupError):
            self._process.kill()
