"""Runs jobs in other processes. If a process dies, at most its job is lost; a new one starts."""

import contextlib
import os
import signal
import sys
import threading
import time
import traceback
from collections.abc import Callable
from concurrent.futures import Future
from multiprocessing import get_context
from multiprocessing.connection import Connection, wait
from queue import SimpleQueue
from typing import Any, NamedTuple, ParamSpec, Self, TypeVar

from lacoc_arenas import time_limit
from lacoc_shared.command.priority import give_way
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import Phrase, say

P = ParamSpec("P")
T = TypeVar("T")

_SPAWN = get_context("spawn")
_END_S = 5.0
_WAIT_S = 1.0
"""Time after which the wait for an answer stops, to look whether a bot blocks the process [s]."""
_MOST_MISSED = 60
"""A process is ended if its thread that watches the bot did not run in this many waits of `_WAIT_S`
in a row: then the bot blocks the process. On a busy machine it may miss a few waits.
"""


class WorkerDied(Exception):
    """The process that ran a job ended before the job was done, or because the job took too long.

    Args:
        what: what happened.
        last_words: the process's own reason for its end; None if it gave none.
    """

    def __init__(self, what: str = "", last_words: Phrase | None = None) -> None:
        super().__init__(what)
        self.last_words = last_words


class WorkerFailed(Exception):
    """A job raised an error, which is a bug; the text is its traceback."""


class _WorkerJob(NamedTuple):
    function: Callable[..., Any]
    arguments: tuple[Any, ...]
    result: "Future[Any]"


class Workers:
    """Runs functions in processes, first come, first served; used as a context manager.

    The processes start at once, so that the first job finds them ready.

    Args:
        jobs: number of processes; None: one for each core.
        background: whether these processes give way to all others.
        limit_s: longest time for a job [s]; after this its process is ended.
        again: how often a job is given to a new process if its process died, or was ended after
            `limit_s`. Only for jobs that give the same result each time.
    """

    def __init__(
        self,
        jobs: int | None = None,
        *,
        background: bool = False,
        limit_s: float = 60.0,
        again: int = 0,
    ) -> None:
        self.count = jobs or os.cpu_count() or 1
        self._background = background
        self._limit_s = limit_s
        self._again = again
        self._jobs: SimpleQueue[_WorkerJob | None] = SimpleQueue()
        self._closing = False
        self._children: set[_WorkerProcess] = set()
        self._threads = [threading.Thread(target=self._run, daemon=True) for _ in range(self.count)]
        for thread in self._threads:
            thread.start()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def waiting(self) -> int:
        """Number of jobs that no process has begun yet."""
        return self._jobs.qsize()

    @property
    def processes(self) -> tuple[int, ...]:
        """The ids of the processes that run now."""
        return tuple(pid for child in list(self._children) if (pid := child.process.pid))

    def submit(
        self, function: Callable[P, T], *arguments: P.args, **named: P.kwargs
    ) -> "Future[T]":
        """Run a module's function (no method, no closure) in a process.

        Returns:
            A future of the function's result. Its `result` raises `WorkerDied` if the process
            ended or took too long, `WorkerFailed` if the function raised an error, and
            `CancelledError` if `close` came first.
        """
        assert not named, "a job has positional arguments only"
        result: Future[T] = Future()
        self._jobs.put(_WorkerJob(function, arguments, result))
        return result

    def close(self) -> None:
        """End all processes; cancel waiting jobs, and let running jobs raise `WorkerDied`."""
        self._closing = True
        for _ in self._threads:
            self._jobs.put(None)
        for child in list(self._children):
            child.process.kill()
        for thread in self._threads:
            thread.join(_END_S)

    def _run(self) -> None:
        child: _WorkerProcess | None = None
        with contextlib.suppress(OSError):  # no process can start now: the first job tries again
            child = self._child()
        while (job := self._jobs.get()) is not None:
            if self._closing or not job.result.set_running_or_notify_cancel():
                job.result.cancel()
                continue
            child = self._do(job, child)
        if child is not None:
            self._children.discard(child)
            child.end()

    def _do(self, job: _WorkerJob, child: "_WorkerProcess | None") -> "_WorkerProcess | None":
        """Run a job in a process, and set the result of its future.

        Returns:
            The process; a new one if it ended. None: no process can be started.
        """
        left = self._again
        while True:
            try:
                if child is None or not child.process.is_alive():  # it died between two jobs
                    child = self._replaced(child)
                right, found = child.call(job.function, job.arguments, self._limit_s)
            except WorkerDied as error:
                if not self._closing:
                    with contextlib.suppress(WorkerDied):  # else the next job tries again
                        child = self._replaced(child)
                if left == 0 or self._closing or error.last_words is not None:
                    job.result.set_exception(error)
                    return child
                left -= 1
                continue
            except Exception as error:  # the job can't be sent to a process
                job.result.set_exception(error)
                return child
            if right:
                job.result.set_result(found)
            else:
                job.result.set_exception(WorkerFailed(found))
            return child

    def _replaced(self, child: "_WorkerProcess | None") -> "_WorkerProcess":
        if child is not None:
            self._children.discard(child)
            child.end()
        try:
            return self._child()
        except OSError as error:
            raise WorkerDied(f"no process can be started: {error}") from None

    def _child(self) -> "_WorkerProcess":
        child = _WorkerProcess(self._background)
        self._children.add(child)
        if self._closing:  # `close` may have missed this new process
            child.process.kill()
        return child


class _WorkerProcess:
    """A process that runs functions, and the pipe to it."""

    def __init__(self, background: bool) -> None:
        self._connection, other = _SPAWN.Pipe()
        bot, looks = _SPAWN.RawArray("c", time_limit.NAME_BYTES), _SPAWN.RawValue("L", 0)
        self._shown = time_limit.ShownBots(bot, looks)
        arguments = (other, background, self._shown)
        self.process = _SPAWN.Process(target=_work, args=arguments, daemon=True)
        self.process.start()
        other.close()  # only the process holds this end now, so it closes with the process

    def call(
        self, function: Callable[..., Any], arguments: tuple[Any, ...], limit_s: float
    ) -> tuple[bool, Any]:
        """Run a function in the process; return whether it worked, and its result or its traceback.

        Raises:
            WorkerDied: if the process ended, took longer than `limit_s`, or gave no sign of life.
        """
        try:
            self._connection.send((function, arguments))
            if self._connection not in self._wait(limit_s):
                raise WorkerDied(f"{function.__name__}: no result in {limit_s:.0f} s, or it ended")
            right, found = self._connection.recv()
        except (EOFError, OSError) as error:
            raise WorkerDied(f"{function.__name__}: {error!r}") from None
        if right is None:
            raise WorkerDied(str(UserError(found)), found)
        return right, found

    def _wait(self, limit_s: float) -> list[Any]:
        """Wait for an answer, the end of the process, or the limit; return the ready objects.

        Raises:
            WorkerDied: if a bot lets nothing else run in the process.
        """
        until_s = time.monotonic() + limit_s
        looks, missed = -1, 0
        while True:
            left_s = max(0.0, until_s - time.monotonic())
            come = wait([self._connection, self.process.sentinel], min(left_s, _WAIT_S))
            if come or left_s <= _WAIT_S:
                return come
            bot, before = self._shown.bot.value.decode(errors="replace"), looks
            looks = self._shown.looks.value
            missed = missed + 1 if bot and looks == before else 0
            if missed >= _MOST_MISSED:
                why = say("bot.no-sign", seconds=_WAIT_S * missed)
                said = say("bot.no-answer", bot=bot, place=None, why=why)
                raise WorkerDied(str(UserError(said)), said)

    def end(self) -> None:
        """End the process."""
        self._connection.close()
        self.process.kill()
        self.process.join(_END_S)


def _work(
    connection: "Connection[Any, Any]", background: bool, shown: time_limit.ShownBots
) -> None:
    """Run the functions that arrive through the pipe, until its other end is closed.

    Args:
        connection: the pipe.
        background: whether this process gives way to others.
        shown: shared memory, in which the parent sees which bot runs, and whether this process
            still watches the bot's time.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent process handles Ctrl-C
    sys.stdout = sys.stderr  # the parent process prints the results
    if background:
        give_way()

    def end(why: Phrase) -> None:
        connection.send((None, why))
        os._exit(1)

    time_limit.when_stuck = end
    time_limit.shown = shown
    with contextlib.suppress(EOFError, OSError):
        while True:
            function, arguments = connection.recv()
            try:
                found = True, function(*arguments)
            except Exception:
                found = False, traceback.format_exc()
            connection.send(found)
