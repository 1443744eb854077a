"""Plays matches without a network, many at a time in worker processes."""

import os
import re
import signal
import traceback
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from contextlib import chdir, contextmanager
from pathlib import Path
from typing import Any, NamedTuple, Self

import msgspec

from lacoc_arenas import arena as arenas
from lacoc_arenas import brains
from lacoc_arenas.bot import BotFactory
from lacoc_server.simulate import Player, Seated, simulate
from lacoc_server.simulate.inputs import BotFailed, failed
from lacoc_server.simulate.refused import RefusedKeys
from lacoc_server.simulate.workers import WorkerDied, Workers
from lacoc_shared.command import screen
from lacoc_shared.command.scratch import Scratch
from lacoc_shared.messages import Frame
from lacoc_shared.mistakes import UserError
from lacoc_shared.record import files
from lacoc_shared.record.schema import Result, Setup
from lacoc_shared.seat import BEATS_PER_S
from lacoc_shared.words import Phrase, render, say

COURT = "simulation"
"""Name of the court in records of matches without a network."""
_LONGEST_S = 86_400.0
"""Longest time that a match may take [s]."""
_LOOK_S = 0.5


class Job(msgspec.Struct, frozen=True, kw_only=True):
    """A match to play. It can be sent to another process, also on another machine."""

    match_id: str
    arena: str
    overrides: dict[str, Any]
    players: tuple[Seated, ...]
    late_ticks: int
    limits: dict[str, float] = {}
    folder: str | None = None
    """Folder into which the record is written; None: no record is kept in a folder."""
    brings_record: bool = False
    """Whether the record comes back as bytes with the result, and is not kept in `folder`."""

    @property
    def record(self) -> Path | None:
        """The file of the match's record; None: it is in no folder."""
        return files.packed_path(Path(self.folder), self.match_id) if self.folder else None

    @property
    def teams(self) -> tuple[str, ...]:
        """Names of the teams, by seat."""
        return tuple(one.join.team for one in self.players)


class PlayedAlone(NamedTuple):
    """A match that was played without a network."""

    result: Result
    record: bytes | None
    """The bytes of the record, if the job has `brings_record`; else None."""
    refused_keys: tuple[int, ...]
    """By seat: how many keys were pressed that the seat's gait does not have."""


def match_id(number: int) -> str:
    """Return the id of a match that belongs to no contest."""
    return f"simulated-{number:03d}"


def first_number(record: Path | None) -> int:
    """Return a free number for a new record: one more than the highest in the folder `record`."""
    paths = [] if record is None else record.glob("simulated-*.mcap")
    known = (re.match(r"simulated-(\d+)", path.name) for path in paths)
    return 1 + max((int(found[1]) for found in known if found), default=0)


class EngineLost(UserError):
    """The processes or machines that play games are gone, so no game can be played."""


@contextmanager
def interrupted_by_signals() -> Iterator[None]:
    """In the block, treat a request to end (SIGTERM) like Ctrl-C: no half record is left."""
    before = signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


class Pool:
    """Plays matches in processes of this machine; used as a context manager.

    When it is closed, no half record of a match is left.

    Args:
        jobs: number of processes; None: one for each core.
    """

    def __init__(self, jobs: int | None = None) -> None:
        self._workers = Workers(jobs or os.cpu_count() or 1, background=True, limit_s=_LONGEST_S)
        self._playing: dict[Future[PlayedAlone | Phrase], Job] = {}

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._workers.close()
        for future, job in self._playing.items():
            if future.done() and not future.cancelled() and _is_lost(future):
                _remove_half_record(job)

    @property
    def processes(self) -> tuple[int, ...]:
        """The ids of the processes that run now."""
        return self._workers.processes

    def submit(self, job: Job) -> "Future[PlayedAlone | Phrase]":
        """Queue a match for the next free process; read its result from the future with `ended`."""
        future = self._workers.submit(attempt_match, job)
        self._playing[future] = job
        return future


def ended(job: Job, future: "Future[PlayedAlone | Phrase]") -> PlayedAlone:
    """Return the result of a job whose future is done, or raise its error.

    Raises:
        EngineLost: if no game can be played any more.
        BotFailed: if a bot failed.
        UserError: if its files have a mistake, its record can't be written, its process died, or
            another error came up.
    """
    try:
        found = future.result()
    except WorkerDied as error:
        if error.last_words is None:
            raise UserError(say("simulate.died", players=job.teams)) from None
        raise _stuck(job, error.last_words) from None
    if isinstance(found, Phrase):
        if found.code == BotFailed.CODE:
            raise BotFailed(found)
        raise UserError(found)
    return found


def _stuck(job: Job, said: Phrase) -> BotFailed:
    """Return the error for a bot because of which a worker process ended; it names the team."""
    of_bot = [one.join.team for one in job.players if _name(one) == said.values["bot"]]
    return failed(of_bot[0] if of_bot else job.teams[0], said)


def play_all(
    work: Sequence[Job], jobs: int | None
) -> Generator[tuple[Job, PlayedAlone | BotFailed], None, None]:
    """Play all matches; yield each when it has ended, with its result or the bot that failed.

    No half record is left if a worker process dies, or if the caller stops early and closes the
    iterator (`contextlib.closing`).

    Args:
        work: the matches.
        jobs: largest number of processes; None: one for each core. One match alone is played in
            this process.

    Raises:
        UserError: if a record can't be written, or a worker process dies.
    """
    if len(work) == 1:
        try:
            yield work[0], play_alone(work[0])
        except BotFailed as error:
            yield work[0], error
        return
    workers = min(jobs or os.cpu_count() or 1, len(work))
    with Pool(workers) as pool, screen.progress() as progress:
        task = progress.add_task(render(say("simulate.matches")), total=len(work))
        playing = {pool.submit(job): job for job in work}
        waiting = set(playing)
        while waiting:
            done, waiting = first_done(waiting)
            for future in done:
                progress.advance(task)
                job = playing[future]
                try:
                    yield job, ended(job, future)
                except BotFailed as error:
                    yield job, error


def first_done(
    futures: "set[Future[PlayedAlone | Phrase]]",
) -> "tuple[set[Future[PlayedAlone | Phrase]], set[Future[PlayedAlone | Phrase]]]":
    """Wait at most half a second for matches; return the futures that are done, then all others."""
    # A wait without an end could not be interrupted on Windows.
    return wait(futures, _LOOK_S, FIRST_COMPLETED)


def attempt_match(job: Job) -> PlayedAlone | Phrase:
    """Play a match in a worker process.

    Return the message of a `UserError` instead of raising it. Any other error is unexpected: print
    its traceback, and return a message too, so that it ends no other match.
    """
    try:
        if not job.brings_record:
            return _play(job)
        with Scratch("game") as folder:
            here = msgspec.structs.replace(job, folder=str(folder))
            found = _play(here)
            assert here.record is not None
            return found._replace(record=here.record.read_bytes())
    except UserError as error:
        return error.phrase
    except BaseException as error:  # no Ctrl-C comes to a worker process
        traceback.print_exc()
        what = traceback.format_exception_only(error)[-1].strip()
        return say("simulate.broke", players=job.teams, error=what)


def _is_lost(future: "Future[PlayedAlone | Phrase]") -> bool:
    return isinstance(future.exception(), WorkerDied)


def _remove_half_record(job: Job) -> None:
    """Remove the unfinished record of a match whose process died; it can be played again."""
    if (record := job.record) is not None:
        files.unfinished_path(record).unlink(missing_ok=True)


def _play(job: Job, watch: Callable[[Frame], None] | None = None) -> PlayedAlone:
    arena = arenas.load(job.arena, job.overrides)
    setup = setup_of(job.match_id, arena, job.limits)
    refused = RefusedKeys(len(job.players))

    def see(frame: Frame) -> None:
        refused.see(frame)
        if watch is not None:
            watch(frame)

    folder = Path(job.folder) if job.folder else None
    with chdir("."):  # a bot may go to another folder
        players = [_player(arena, one, job.late_ticks) for one in job.players]
        result = simulate(setup, players, folder, see, arena.folder)
    return PlayedAlone(result, None, refused.counts)


def _player(arena: arenas.Arena, seated: Seated, late_ticks: int) -> Player:
    """Make the player of a seat; raise `BotFailed` if its bot has a mistake."""
    try:
        return Player(seated.join, bot_of(arena, seated), late_ticks)
    except UserError as error:
        raise failed(seated.join.team, error.phrase) from error


def setup_of(match_id: str, arena: arenas.Arena, limits: Mapping[str, float]) -> Setup:
    """Return id, arena, settings and limits of a match that is played without a network."""
    return Setup(
        match_id=match_id,
        court=COURT,
        match=1,
        arena=arena.name,
        settings=arena.settings,
        limits=dict(limits),
    )


def bot_of(arena: arenas.Arena, seated: Seated) -> BotFactory:
    """Find the bot of a player: an installed one, or the team's own program, which is loaded here.

    Raises:
        UserError: if there is no such bot, or its program has a mistake.
    """
    if seated.program is None:
        return brains.find(arena, seated.bot)
    return brains.of_program(_name(seated), seated.program)


def _name(seated: Seated) -> str:
    """Return a bot's name for messages: the name of its file, or of an installed bot."""
    return seated.bot if seated.program is None else f"{seated.bot}.py"


def play_alone(job: Job) -> PlayedAlone:
    """Play a match in this process; the errors are those of `ended`."""
    duration_s = arenas.load(job.arena, job.overrides).match.duration_s
    with screen.results_only(), screen.progress() as progress:
        task = progress.add_task(" : ".join(job.teams), total=round(duration_s))

        def watch(frame: Frame) -> None:
            if frame.beat % BEATS_PER_S == 0:
                progress.update(task, completed=max(0, frame.clock_ticks) // BEATS_PER_S)

        return _play(job, watch)
