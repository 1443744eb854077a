"""A friendly tournament of a class's gaits: the bot `planner` steers the robots; all may watch."""

import asyncio
import os
from collections.abc import Awaitable, Callable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Literal

import msgspec

from lacoc_client.play.simulation import (
    BeginLine,
    LeftOutLine,
    MatchLine,
    OutputLine,
    PlayerStanding,
    Simulation,
    StandingsLine,
)
from lacoc_client.web.gateway.wire import FAULT
from lacoc_client.workshop.phases.export import free_name
from lacoc_robots.seat_files import USUAL_NAMES, SeatFiles
from lacoc_shared.command.scratch import Scratch
from lacoc_shared.mistakes import Mistake, UserError, text_of
from lacoc_shared.words import Phrase, say

RECORDINGS = "recordings"
"""Folder of the records, in the folder of the class."""
TOURNAMENT = "tournament"
"""Name of the document in the class file that has the last tournament."""

_BOT = "planner"
_NOBODY = "–"
"""Stands for a player who was deleted."""
_CLOSE_S = 15.0


class ClassMatch(msgspec.Struct, frozen=True, kw_only=True):
    """A match of the tournament that has ended."""

    left: str
    right: str
    scores: tuple[int, int]
    winner: int | None
    """0: left, 1: right; None: a draw, or void."""
    void: bool
    """Whether the match does not count, because physics stopped in it."""
    record: str | None
    """Name of the record's file in the folder of the records; None: there is no record."""


class LeftOut(msgspec.Struct, frozen=True, kw_only=True):
    """A player who can't play in the tournament."""

    name: str
    mistakes: tuple[Mistake, ...] = ()
    """What is wrong in the files."""
    why: Phrase | None = None
    """Another reason why the player can't play; None: the mistakes are the reason."""


class TournamentState(msgspec.Struct, frozen=True, kw_only=True):
    """How far a tournament is: its matches and standings so far."""

    state: Literal["none", "running", "done", "stopped"] = "none"
    arena: str = ""
    done: int = 0
    """Number of matches that have ended."""
    of: int = 0
    """Number of all matches."""
    matches: tuple[ClassMatch, ...] = ()
    """The matches that have ended, in the order in which they ended."""
    standings: tuple[PlayerStanding, ...] = ()
    """The standings, the best player first; empty until a match has ended."""
    left_out: tuple[LeftOut, ...] = ()
    trouble: Phrase | None = None
    """Why the tournament ended too early; None: it did not, or somebody stopped it."""


class Tournament:
    """A friendly tournament of a class's gaits, played by `lacoc simulate` in its own process.

    It is used from the event loop only.

    Args:
        folder: folder of the class; the records are in its folder "recordings".
        tell: called whenever `state` has changed.
        keep: called when a tournament has ended; it keeps `state` for the next start.
    """

    def __init__(
        self, folder: Path, tell: Callable[[], None], keep: Callable[[], Awaitable[None]]
    ) -> None:
        self.state = TournamentState()
        self.recordings = folder / RECORDINGS
        self._tell = tell
        self._keep = keep
        self._teams: dict[str, _TournamentPlayer] = {}
        """The players of the running tournament, by their words on its command line."""
        self._playing: asyncio.Task[None] | None = None
        self._simulation: Simulation | None = None
        self._stopping = False

    async def play(
        self, players: Mapping[str, SeatFiles], arena: str, rounds: int, seconds: float
    ) -> None:
        """Start a tournament; `state` has its matches and standings.

        Args:
            players: robot and gait of each player, by nickname; players without a file for level B
                are left out.
            arena: the game.
            rounds: how many other players each player meets.
            seconds: length of a match [s].

        Raises:
            UserError: if a tournament is being played, or fewer than two players have a file for
                level B.
        """
        if self.state.state == "running":
            raise UserError(say("tournament.runs"))
        fit = {name: files for name, files in players.items() if files.locomotion is not None}
        without = [name for name in players if name not in fit]
        if len(fit) < 2:
            raise UserError(_too_few(without))
        self._stopping = False
        self.state = TournamentState(
            state="running",
            arena=arena,
            of=rounds * (len(fit) // 2),
            left_out=tuple(LeftOut(name=name, why=say("tournament.no-key")) for name in without),
        )
        words = ["--arena", arena, "--rounds", str(rounds), "--seconds", str(seconds)]
        self._playing = asyncio.get_running_loop().create_task(self._play(fit, words))
        self._tell()

    def load(self, kept: bytes) -> None:
        """Load the state that an earlier run kept, if this version can read it."""
        with suppress(msgspec.DecodeError):
            self.state = msgspec.json.decode(kept, type=TournamentState)

    async def forget(self, name: str) -> None:
        """Take a player's name out of the tournament, and delete the records of its matches."""
        for word, player in self._teams.items():
            if player.name == name:  # matches that end later get no name, and no record
                self._teams[word] = msgspec.structs.replace(player, name=_NOBODY)
        state = self.state
        matches, records = [], []
        for one in state.matches:
            if name in (one.left, one.right):
                records.append(one.record)
                left, right = (_NOBODY if it == name else it for it in (one.left, one.right))
                one = msgspec.structs.replace(one, left=left, right=right, record=None)
            matches.append(one)
        standings = [
            msgspec.structs.replace(one, name=_NOBODY) if one.name == name else one
            for one in state.standings
        ]
        left_out = [one for one in state.left_out if one.name != name]
        self.state = msgspec.structs.replace(
            state, matches=tuple(matches), standings=tuple(standings), left_out=tuple(left_out)
        )
        if self.state == state:
            return
        self._tell()
        await self._keep()
        for record in filter(None, records):
            await asyncio.to_thread((self.recordings / record).unlink, missing_ok=True)

    async def stop(self) -> None:
        """End the tournament, if one is being played; the matches that have ended stay."""
        if self._playing is None:
            return
        self._stopping = True
        if self._simulation is not None:
            self._simulation.end()
        ended, _ = await asyncio.wait({self._playing}, timeout=_CLOSE_S)
        if not ended:
            self._playing.cancel()
            await asyncio.wait({self._playing})

    async def _play(self, players: Mapping[str, SeatFiles], words: list[str]) -> None:
        is_done = False
        trouble: Phrase | None = None
        scratch: Scratch | None = None
        try:
            scratch = await asyncio.to_thread(Scratch, "tournament")
            self._teams = await asyncio.to_thread(_written, players, scratch.path)
            if not self._stopping:
                trouble = await self._simulate(words)
                is_done = trouble is None
        except OSError as error:
            trouble = say("tournament.cannot-start", why=error.strerror or str(error))
        except Exception as error:  # a bug, but the teacher must learn of it
            trouble = FAULT
            shown = {"message": "The tournament ended by a bug", "exception": error}
            asyncio.get_running_loop().call_exception_handler(shown)
        finally:
            if scratch is not None:
                scratch.close()
            if self._stopping:
                trouble = None  # its complaint that it was ended
            self._change(state="done" if is_done else "stopped", trouble=trouble)
            await self._keep()

    async def _simulate(self, words: list[str]) -> Phrase | None:
        """Run `lacoc simulate` with the players and with more words on its command line.

        Returns:
            Why the command ended early; None if it did not.
        """
        jobs = max(1, (os.cpu_count() or 1) - 1)  # one core is left for the class
        words += ["--jobs", str(jobs), "--record", str(self.recordings), "--leave-out"]
        self._simulation = await Simulation.start([*self._teams, *words])
        if self._stopping:  # `stop` came while it started
            self._simulation.end()
        has_begun = False
        try:
            async for line in self._simulation.lines():
                self._take(line)
                has_begun = has_begun or isinstance(line, BeginLine)
            why = await self._simulation.complaint()
        finally:
            self._simulation.close()
            self._simulation = None
        if why is not None and not has_begun and self.state.left_out:
            return _too_few([one.name for one in self.state.left_out])
        return None if why is None else say("tournament.ended", why=why)

    def _take(self, line: OutputLine) -> None:
        """Change the state of the tournament by a line that `lacoc simulate` printed."""
        teams = self._teams
        match line:
            case LeftOutLine():
                out = teams[line.player].left_out(line)
                self._change(left_out=(*self.state.left_out, out))
            case BeginLine():
                self._change(of=line.matches)
            case MatchLine():
                left, right = (teams[word].name for word in line.players)
                record = line.record
                if record and _NOBODY in (left, right):
                    (self.recordings / record).unlink(missing_ok=True)
                    record = None
                played = ClassMatch(
                    left=left,
                    right=right,
                    scores=line.result.scores,
                    winner=line.winner,
                    void=line.result.official == "void",
                    record=record,
                )
                self.state = msgspec.structs.replace(
                    self.state, matches=(*self.state.matches, played)
                )  # its standings follow at once
            case StandingsLine():
                named = (
                    msgspec.structs.replace(one, name=teams[one.name].name)
                    for one in line.standings
                )
                self._change(done=line.done, standings=tuple(named))

    def _change(self, **changes: object) -> None:
        self.state = msgspec.structs.replace(self.state, **changes)
        self._tell()


class _TournamentPlayer(msgspec.Struct, frozen=True):
    """A player of the tournament: the nickname, and the player's own names of the files.

    `files` maps the name under which a file was written to the name that the player gave it.
    """

    name: str
    files: dict[str, str]

    def left_out(self, line: LeftOutLine) -> LeftOut:
        mistakes = tuple(
            msgspec.structs.replace(mistake, file=self.files.get(mistake.file, mistake.file))
            for mistake in line.mistakes
        )
        return LeftOut(name=self.name, mistakes=mistakes, why=line.why)


def _written(players: Mapping[str, SeatFiles], folder: Path) -> dict[str, _TournamentPlayer]:
    """Write the robot and gait files of each player into a folder.

    Returns:
        The players, by the word that names each player on the command line.

    Raises:
        OSError: if a file can't be written.
    """
    teams: dict[str, _TournamentPlayer] = {}
    taken: list[str] = []
    for name, files in players.items():
        taken.append(free_name(name, taken))
        own = folder / taken[-1]
        own.mkdir()
        known: dict[str, str] = {}
        for file, on_disk in zip(files, USUAL_NAMES, strict=True):
            if file is not None:
                (own / on_disk).write_bytes(file.data)
                known[f"{own.name}/{on_disk}"] = file.name
        teams[text_of(f"{_BOT}@{own}")] = _TournamentPlayer(name, known)
    return teams


def _too_few(left_out: list[str]) -> Phrase:
    return say("tournament.too-few", left_out=left_out)
