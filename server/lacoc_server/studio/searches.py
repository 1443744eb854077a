"""Runs the searches of a studio for better gaits: one at a time, in the order of their requests."""

import threading
import time
from collections import deque
from collections.abc import Callable
from typing import NamedTuple

from lacoc_server.simulate.workers import Workers
from lacoc_server.studio.answers import Answer, Busy, refusal
from lacoc_server.studio.wishes import SearchRequest, fulfil
from lacoc_shared.codec import encode
from lacoc_shared.keyspace import check_name
from lacoc_shared.messages import Refusal
from lacoc_shared.mistakes import FileRefused, UserError
from lacoc_shared.studio import Progress
from lacoc_shared.words import say

_MOST_WAITING = 8
_TELL_S = 0.2
"""Shortest time between two messages of a search's progress [s]."""
_END_S = 10.0

Done = Callable[[Answer], None]
"""Called with the answer of a search, on any thread."""
Tell = Callable[[str, Progress], None]
"""Called with the name of a search and its progress."""


class _WaitingSearch(NamedTuple):
    request: SearchRequest
    done: Done
    stop: threading.Event


class Searches:
    """Searches for better gaits in processes that give way to trials.

    One search uses all processes, so that it ends soon. The processes start with the first search,
    because many studios never have one.

    Args:
        jobs: number of processes; None: one for each core.
        tell: called a few times a second with the progress of the running search and of each
            search that waits.
        failed: makes the answer to a search that ended with an unexpected error.
    """

    def __init__(self, jobs: int | None, tell: Tell, failed: Callable[[Exception], Answer]) -> None:
        self._jobs = jobs
        self._tell = tell
        self._failed = failed
        self._waiting: deque[_WaitingSearch] = deque()
        self._running: _WaitingSearch | None = None
        self._changed = threading.Condition()
        self._closing = False
        self._workers: Workers | None = None
        self._thread = threading.Thread(target=self._run, name="searches", daemon=True)
        self._thread.start()

    def add(self, request: SearchRequest, done: Done) -> None:
        """Begin a search, or let it wait until earlier searches end.

        Raises:
            UserError: if the name of the search is wrong or taken.
            Busy: if too many searches wait.
        """
        check_name(request.job)
        with self._changed:
            if any(one.request.job == request.job for one in self._all()):
                raise UserError(say("studio.job-taken", job=request.job))
            if len(self._waiting) >= _MOST_WAITING:
                raise Busy(say("studio.coach-busy"))
            self._waiting.append(_WaitingSearch(request, done, threading.Event()))
            self._changed.notify()

    def cancel(self, job: str) -> None:
        """Let a running search end soon with the best it has found; remove a search that waits.

        Who asked for a removed search gets a refusal.

        Raises:
            UserError: if there is no search with this name.
        """
        with self._changed:
            search = next((one for one in self._all() if one.request.job == job), None)
            waits = search in self._waiting
            if search is not None and waits:
                self._waiting.remove(search)
        if search is None:
            raise UserError(say("studio.no-job", job=job[:40]))
        search.stop.set()
        if waits:
            search.done(Answer(False, encode(Refusal(say("studio.cancelled")))))

    def close(self) -> None:
        """Stop all searches and end their processes; searches that wait get no answer."""
        with self._changed:
            self._closing = True
            for search in self._all():
                search.stop.set()
            self._changed.notify()
            workers = self._workers
        if workers is not None:
            workers.close()
        self._thread.join(_END_S)

    @property
    def processes(self) -> tuple[int, ...]:
        """The ids of the processes that run now."""
        return () if self._workers is None else self._workers.processes

    def _all(self) -> list[_WaitingSearch]:
        return [*([self._running] if self._running else []), *self._waiting]

    def _run(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._waiting or self._closing)
                if self._closing:
                    return
                search = self._running = self._waiting.popleft()
                if self._workers is None:
                    self._workers = Workers(self._jobs, background=True, limit_s=600.0, again=1)
            try:
                answer = self._answer(search, self._workers)
            except Exception as error:
                answer = self._failed(error)
            with self._changed:
                self._running = None  # first free the name, then send the answer
            search.done(answer)

    def _answer(self, search: _WaitingSearch, workers: Workers) -> Answer:
        request = search.request
        told_s = -_TELL_S

        def tell(how_far: Progress) -> None:
            nonlocal told_s
            now_s = time.monotonic()
            if now_s - told_s < _TELL_S:
                return
            told_s = now_s
            self._tell(request.job, how_far)
            with self._changed:
                waiting = list(self._waiting)
            for other in waiting:
                self._tell(other.request.job, Progress(stage="waiting", done=0.0, trials=0))

        try:
            reply = fulfil(request, workers, search.stop, tell)
        except (FileRefused, UserError) as error:
            return Answer(False, encode(refusal(error)))
        return Answer(True, encode(reply))
