"""Plays matches without a network, many at a time in worker processes."""

import os
import signal
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import msgspec

from lacoc_arenas import arena as arenas
from lacoc_server.simulate import player, simulate
from lacoc_server.studio.workers import WorkerDied, Workers
from lacoc_shared.command import screen
from lacoc_shared.messages import Frame
from lacoc_shared.mistakes import UserError
from lacoc_shared.record import files
from lacoc_shared.record.schema import Result, Setup
from lacoc_shared.seat import BEATS_PER_S
from lacoc_shared.words import Phrase, render, say

_LONGEST_S = 86_400.0
"""Longest time that a match may take [s]."""
_LOOK_S = 0.5


class Job(msgspec.Struct, frozen=True):
    """A match to play; it can be sent to a worker process."""

    match_id: str
    arena: str
    overrides: dict[str, Any]
    robot: str
    players: tuple[str, ...]
    late_ticks: int
    folder: str | None

    @property
    def record(self) -> Path | None:
        """The file of the match's record; None: it is not recorded."""
        return files.packed_path(Path(self.folder), self.match_id) if self.folder else None


@contextmanager
def interrupted_by_signals() -> Iterator[None]:
    """Let a request to end (SIGTERM) do what Ctrl-C does, so that no half record is left."""
    before = signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def play_all(work: Sequence[Job], jobs: int | None) -> Generator[tuple[Job, Result], None, None]:
    """Play all matches; yield each with its result when it has ended.

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
        yield work[0], _play_one(work[0])
        return
    playing: dict[Future[Result | Phrase], Job] = {}
    workers = Workers(
        min(jobs or os.cpu_count() or 1, len(work)), background=True, limit_s=_LONGEST_S
    )
    try:
        with screen.progress() as progress, workers:
            task = progress.add_task(render(say("simulate.matches")), total=len(work))
            playing = {workers.submit(_attempt, job): job for job in work}
            waiting = set(playing)
            while waiting:
                # A wait without an end could not be interrupted on Windows.
                ended, waiting = wait(waiting, _LOOK_S, FIRST_COMPLETED)
                for future in ended:
                    progress.advance(task)
                    yield playing[future], _result(playing[future], future)
    finally:
        for future, job in playing.items():
            if future.done() and not future.cancelled() and _is_lost(future):
                _remove_half_record(job)


def _result(job: Job, future: "Future[Result | Phrase]") -> Result:
    try:
        found = future.result()
    except WorkerDied:
        raise UserError(say("simulate.died", players=job.players)) from None
    if isinstance(found, Phrase):
        raise UserError(found)
    return found


def _is_lost(future: "Future[Result | Phrase]") -> bool:
    return isinstance(future.exception(), WorkerDied)


def _attempt(job: Job) -> Result | Phrase:
    """Play a match in a worker process; an error that a user can correct is returned."""
    try:
        return _play(job)
    except UserError as error:
        return error.phrase


def _remove_half_record(job: Job) -> None:
    """Remove the unfinished record of a match whose process died; it can be played again."""
    if (record := job.record) is not None:
        segments = files.segment_paths(record.parent, job.match_id)
        for path in (*segments, record.with_name(f"{record.name}.part")):
            path.unlink(missing_ok=True)


def _play(job: Job, watch: Callable[[Frame], None] | None = None) -> Result:
    arena = arenas.load(job.arena, job.overrides)
    setup = Setup(
        match_id=job.match_id,
        court="simulation",
        match=1,
        arena=arena.name,
        settings=arena.settings,
        limits={},
    )
    seated = [
        player(arena, seat, name, job.robot, late_ticks=job.late_ticks)
        for seat, name in enumerate(job.players)
    ]
    return simulate(setup, seated, Path(job.folder) if job.folder else None, watch, arena.folder)


def _play_one(job: Job) -> Result:
    duration_s = arenas.load(job.arena, job.overrides).match.duration_s
    with screen.progress() as progress:
        task = progress.add_task(" : ".join(job.players), total=round(duration_s))

        def watch(frame: Frame) -> None:
            if frame.beat % BEATS_PER_S == 0:
                progress.update(task, completed=max(0, frame.clock_ticks) // BEATS_PER_S)

        return _play(job, watch)
