"""A studio's place on the network: requests come in, processes answer them."""

import contextlib
from collections.abc import Sequence
from concurrent.futures import CancelledError, Future
from functools import partial
from typing import Self

from lacoc_server.studio.answers import Answer
from lacoc_server.studio.floors import answered
from lacoc_server.studio.workers import WorkerDied, Workers
from lacoc_shared.codec import encode
from lacoc_shared.command import log
from lacoc_shared.messages import PROTOCOL, Refusal
from lacoc_shared.network.session import Request, open_studio
from lacoc_shared.studio import RobotRequest, StudioKeys
from lacoc_shared.words import render, say

_MOST_WAITING = 128
"""Requests that may wait for a process; more are refused, and may come again."""


class Studio:
    """Answers requests over the network until it is closed; used as a context manager.

    Zenoh's threads bring the requests, and the processes' threads send the answers; no thread is
    needed that waits.

    Args:
        name: name of the studio.
        listen: addresses to listen on; port 0 takes a free one.
        jobs: number of processes for trials; None: one for each core.

    Raises:
        UserError: if the name is wrong, or the studio can't listen on an address.
    """

    def __init__(self, name: str, listen: Sequence[str], jobs: int | None = None) -> None:
        keys = StudioKeys(name)
        self._log = log.get(studio=name)
        self._session = session = open_studio(listen)
        self._workers = Workers(jobs)
        for _ in range(self._workers.count):  # so that the first student does not wait for MuJoCo
            self._workers.submit(answered, "robot", encode(RobotRequest(protocol=PROTOCOL)))
        session.answer(keys.request("*"), self._arrived)
        session.announce(keys.alive)
        self.locators = session.locators()
        """Addresses to connect to, with the real ports."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._workers.close()
        self._session.close()

    def _arrived(self, request: Request) -> None:
        what = request.key.rpartition("/")[2]
        if self._workers.waiting >= _MOST_WAITING:
            request.refuse(encode(Refusal(say("studio.busy"), again=True)))
            return
        result = self._workers.submit(answered, what, request.payload)
        result.add_done_callback(partial(self._done, request))

    def _done(self, request: Request, result: "Future[Answer]") -> None:
        try:
            right, payload = result.result()
        except (WorkerDied, CancelledError) as error:
            self._log.warning(render(say("studio.died")), error=str(error))
            right, payload = False, encode(Refusal(say("studio.died"), again=True))
        except Exception as error:  # a bug: one request fails, the studio does not
            self._log.warning(str(error))
            right, payload = False, encode(Refusal(say("studio.failed")))
        with contextlib.suppress(Exception):  # whoever asked may have gone
            (request.reply if right else request.refuse)(payload)
