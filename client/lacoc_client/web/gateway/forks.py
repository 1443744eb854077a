"""Plays forks that pages ask for: `lacoc replay fork` goes on with a recording of this gateway.

The command runs in a process of its own, because a gateway has no physics. The record of a fork
lies beside the gateway's copies, so it is listed and shown like any other recording. It is deleted
when the gateway ends.
"""

import asyncio
import contextlib
import os
import sys
from asyncio.subprocess import PIPE, Process
from pathlib import Path
from typing import Annotated

import msgspec

from lacoc_arenas import arena as arenas
from lacoc_arenas import brains
from lacoc_shared.command import plugins
from lacoc_shared.command.child import apart, command_line
from lacoc_shared.command.priority import BACKGROUND
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.reader import Record
from lacoc_shared.words import render, say
from lacoc_shared.words.render import Language

_MOST_WAITING = 4
_LIMIT_S = 120.0
"""Longest time that the command may take [s]; a fork of three minutes takes some 10 s."""

_Name = Annotated[str, msgspec.Meta(max_length=64, pattern="^[A-Za-z0-9][A-Za-z0-9_-]*$")]
_Player = Annotated[str, msgspec.Meta(max_length=64)]


class ForkAsk(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A page's request for a fork of a recording."""

    beat: Annotated[int, msgspec.Meta(ge=1, le=10**8)]
    """First beat that may differ from the recording."""
    take_back: Annotated[int, msgspec.Meta(ge=1, le=10**8)] | None = None
    """Number of an event of the recording that is taken back; None: no event."""
    restart: tuple[_Name, ...] = ()
    """Ids of the seats whose robots are put back at their start place."""
    players: tuple[_Player, ...] = ()
    """For each seat the name of a bot, or `brains.RECORDED`; empty: all seats keep their recorded
    keys."""


class ForkMade(msgspec.Struct, frozen=True):
    """The answer to a page whose fork was played."""

    name: str
    """Name of the fork's recording at this gateway."""


class _Printed(msgspec.Struct):
    record: str


_printed = msgspec.json.Decoder(_Printed)


class Forks:
    """Plays the forks that pages ask for, one at a time; used from the event loop only.

    Args:
        folder: folder for the records of the forks.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._playing = asyncio.Lock()
        self._waiting = 0
        self._process: Process | None = None

    async def play(self, record: Path, asked: ForkAsk, language: Language) -> ForkMade:
        """Play a fork of a recording, and record it.

        Args:
            record: the recording.
            asked: how to go on.
            language: language of the command's errors.

        Raises:
            UserError: if the recording can't be read, if there is no such bot, if too many forks
                wait already, or if the command fails; the message then has the command's own.
        """
        await asyncio.to_thread(_check_players, record, asked.players)
        if self._waiting >= _MOST_WAITING:
            raise UserError(say("gateway.too-much"))
        self._waiting += 1
        try:
            async with self._playing:
                return await self._run(_words(record, asked, self._folder), language)
        finally:
            self._waiting -= 1

    def close(self) -> None:
        """End the command that plays a fork, if one is running."""
        if self._process is not None:
            with contextlib.suppress(ProcessLookupError):
                self._process.kill()

    async def _run(self, words: list[str], language: Language) -> ForkMade:
        options = apart()
        options["env"] |= {"LACOC_LANGUAGE": language}
        try:
            process = await asyncio.create_subprocess_exec(
                *command_line(words), stdout=PIPE, stderr=PIPE, **options
            )
        except OSError as error:
            raise UserError(say("gateway.fork-failed", why=error.strerror or str(error))) from None
        self._process = process
        if sys.platform != "win32":
            with contextlib.suppress(OSError):  # it has ended already
                os.setpriority(os.PRIO_PROCESS, process.pid, BACKGROUND)
        try:
            out, errors = await asyncio.wait_for(_output(process), _LIMIT_S)
        except TimeoutError:
            raise UserError(say("gateway.fork-slow", seconds=_LIMIT_S)) from None
        finally:
            self.close()
            self._process = None
        if process.returncode == 0:
            return ForkMade(Path(_printed.decode(out).record).name)
        text = " ".join(errors.decode(errors="replace").split())
        why = text.removeprefix(render(say("command.error"), language)).strip()
        raise UserError(say("gateway.fork-failed", why=why or str(process.returncode)))


def bots(record: Path) -> list[str]:
    """Return the names of the bots that can steer robots in a fork of a recording.

    Raises:
        UserError: if the recording can't be read, or its game is not installed here.
    """
    setup = Record.read(record).header.setup
    arena = arenas.from_settings(setup.arena, setup.settings, None)
    return [*arena.bots, *(name for name in plugins.installed(brains.GROUP))]


def _check_players(record: Path, players: tuple[str, ...]) -> None:
    """Check that each player is the name of a known bot.

    A page could else name a file, and the file's code would run.

    Raises:
        UserError: if a player is no known bot.
    """
    if not players:
        return
    known = bots(record)
    for name in players:
        if name not in (brains.RECORDED, *known):
            raise UserError(say("gateway.no-bot", name=name, bots=known))


def _words(record: Path, asked: ForkAsk, folder: Path) -> list[str]:
    words = ["replay", "fork", str(record), "--json", f"--beat={asked.beat}", f"--out={folder}"]
    if asked.take_back is not None:
        words.append(f"--take-back={asked.take_back}")
    words += [f"--restart={seat}" for seat in asked.restart]
    if asked.players:
        words.append(f"--players={','.join(asked.players)}")
    return words


async def _output(process: Process) -> tuple[bytes, bytes]:
    """Read what a process prints, until it ends; meanwhile keep its standard input open."""
    assert process.stdout is not None
    assert process.stderr is not None
    out, errors = await asyncio.gather(process.stdout.read(), process.stderr.read())
    await process.wait()
    return out, errors
