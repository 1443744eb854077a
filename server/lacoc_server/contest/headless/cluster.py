"""Plays games on the machines of a Dask cluster (docs/cluster.md)."""

from concurrent.futures import Future
from typing import Self

from lacoc_server.contest.headless.pool import Ended, Job, attempt
from lacoc_server.studio.workers import WorkerDied
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import Phrase, say

_CONNECT_S = 10
_RETRIES = 3
"""How often a game is played again because its worker was lost."""


class Cluster:
    """Plays games at the workers of a cluster; used as a context manager.

    A game's record comes back with its result, so the workers need no common disk. What a worker
    had not delivered when it was lost is played again by another one.

    Args:
        address: address of the cluster's scheduler, such as tcp://192.168.1.20:8786.

    Raises:
        UserError: if `distributed` is not installed, or nobody answers at the address.
    """

    def __init__(self, address: str) -> None:
        try:
            from distributed import Client
        except ModuleNotFoundError:
            raise UserError(say("cluster.not-installed")) from None
        try:
            self._client = Client(address, timeout=_CONNECT_S)
        except (OSError, ValueError) as error:
            raise UserError(say("cluster.no-answer", address=address, why=str(error))) from None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._client.close()

    def submit(self, job: Job) -> "Future[Ended | Phrase]":
        """Play a game when a worker is free; its result is read with `pool.ended`."""
        from distributed import KilledWorker

        ours: Future[Ended | Phrase] = Future()

        def done(theirs: "Future[Ended | Phrase]") -> None:
            error = None if theirs.cancelled() else theirs.exception()
            if theirs.cancelled() or isinstance(error, KilledWorker):
                ours.set_exception(WorkerDied())
            elif error is not None:
                ours.set_exception(error)
            else:
                ours.set_result(theirs.result())

        # The id is a hash of all that decides the game, so Dask need not make one.
        theirs = self._client.submit(attempt, job, key=job.match_id, retries=_RETRIES)
        theirs.add_done_callback(done)
        return ours
