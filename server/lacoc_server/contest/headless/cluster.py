"""Plays games on the machines of a Dask cluster (docs/cluster.md)."""

import logging
from collections.abc import Callable
from concurrent.futures import Future
from threading import Event, Thread
from typing import Any, Self

from lacoc_server.contest.headless.pool import EngineLost, Job, PlayedAlone, attempt_match
from lacoc_server.simulate.workers import WorkerDied
from lacoc_shared.command import installing
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import Phrase, say

_CONNECT_S = 10
_RETRIES = 3
"""How often Dask plays a game again after its worker was lost."""
_LOOK_S = 5.0
"""Time between two checks whether there are workers [s]."""
_MISSED_LOOKS = 2
"""Number of checks in a row without a worker after which the user is told. A worker that restarts
is back earlier."""


class Cluster:
    """Plays games at the workers of a cluster; used as a context manager.

    A game's record comes back with its result, so the workers need no common disk. If a worker is
    lost during a game, another one plays it again, at most three times. While there is no worker,
    games wait.

    Args:
        address: address of the cluster's scheduler, such as tcp://192.168.1.20:8786.
        tell: called from another thread when the cluster has no worker, and when it has one again.

    Raises:
        UserError: if `distributed` is not installed, or no scheduler answers at the address.
    """

    def __init__(self, address: str, tell: Callable[[Phrase], None]) -> None:
        self._client = _connected(address)
        self._address = address
        self._tell = tell
        self._waiting: set[Future[PlayedAlone | Phrase]] = set()
        """Futures of unfinished games; whichever thread removes one sets its result or error."""
        self._closed = Event()

    def __enter__(self) -> Self:
        Thread(target=self._look, daemon=True).start()
        return self

    def __exit__(self, *_: object) -> None:
        self._closed.set()
        self._client.close()

    def submit(self, job: Job) -> "Future[PlayedAlone | Phrase]":
        """Queue a game for the next free worker.

        Read its result from the future with `pool.ended`.
        """
        from distributed import KilledWorker
        from distributed.client import ClosedClientError

        ours: Future[PlayedAlone | Phrase] = Future()
        self._waiting.add(ours)

        def done(theirs: "Future[PlayedAlone | Phrase]") -> None:
            try:
                self._waiting.remove(ours)
            except KeyError:  # the cluster is lost
                return
            error = None if theirs.cancelled() else theirs.exception()
            if theirs.cancelled() or isinstance(error, KilledWorker):
                ours.set_exception(WorkerDied())
            elif error is not None:
                ours.set_exception(error)
            else:
                ours.set_result(theirs.result())

        # The id is a hash of all that decides the game, so Dask need not make one.
        try:
            theirs = self._client.submit(attempt_match, job, key=job.match_id, retries=_RETRIES)
        except ClosedClientError:  # the cluster was lost at this moment
            self._lose()
        else:
            theirs.add_done_callback(done)
        return ours

    def _look(self) -> None:
        """Tell the user when all workers are gone, and when there is one again.

        If the cluster is lost, end its games.
        """
        missed = 0
        while not self._closed.wait(_LOOK_S):
            workers = self._client.scheduler_info(n_workers=0).get("n_workers", 0)
            if self._client.status == "closed":  # Dask could not connect again in _CONNECT_S
                self._lose()
            elif not workers:
                missed += 1
                if missed == _MISSED_LOOKS:
                    self._tell(say("cluster.no-worker", address=self._address))
            else:
                if missed >= _MISSED_LOOKS:
                    self._tell(say("cluster.workers", workers=workers))
                missed = 0

    def _lose(self) -> None:
        """End all games with `EngineLost`; Dask itself would never end them."""
        while self._waiting:
            ours = self._waiting.pop()
            ours.set_exception(EngineLost(say("cluster.lost", address=self._address)))


def _connected(address: str) -> Any:
    """Return a client of the scheduler at an address; for the errors see `Cluster`."""
    try:
        from distributed import Client
    except ModuleNotFoundError:
        install = installing.command("server", "cluster")
        raise UserError(say("cluster.not-installed", install=install)) from None
    logging.getLogger("distributed.client").setLevel(logging.CRITICAL)  # it says what we say
    found: Future[Any] = Future()

    def connect() -> None:
        try:
            found.set_result(Client(address, timeout=_CONNECT_S))
        except Exception as error:  # of any kind, if a server of another kind answers
            found.set_exception(error)

    # Dask waits for ever for a server that takes the connection and then says nothing.
    Thread(target=connect, daemon=True).start()
    try:
        return found.result(2 * _CONNECT_S)
    except ValueError:
        raise UserError(say("cluster.bad-address", address=address)) from None
    except Exception:
        raise UserError(say("cluster.no-answer", address=address)) from None
