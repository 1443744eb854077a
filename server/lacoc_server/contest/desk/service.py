"""The desk's place on the network: its gateway asks, threads answer."""

from concurrent.futures import ThreadPoolExecutor
from typing import Self

from lacoc_server.contest.desk.desk import Desk
from lacoc_shared.codec import encode
from lacoc_shared.command import log
from lacoc_shared.keyspace import DESK
from lacoc_shared.messages import Refusal
from lacoc_shared.network.session import Request, open_desk
from lacoc_shared.words import say

_THREADS = 4
_MOST_WAITING = 64
"""Most requests that wait for a thread; more are refused, and may be sent again."""
_HERE = "tcp/127.0.0.1:0"
"""The gateway runs on the machine of the office; nobody else reaches the desk directly."""


class DeskService:
    """Answers requests to a desk until it is closed; used as a context manager.

    Args:
        desk: the desk.

    Raises:
        UserError: if it can't listen.
    """

    def __init__(self, desk: Desk) -> None:
        self._desk = desk
        self._threads = ThreadPoolExecutor(_THREADS, thread_name_prefix="desk")
        self._waiting = 0
        self._session = open_desk([_HERE])
        self._session.answer(DESK, self._arrived)
        self.address = self._session.locators()[0]
        """Where the gateway finds the desk."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._session.close()
        self._threads.shutdown(wait=True, cancel_futures=True)

    def _arrived(self, request: Request) -> None:
        """Give a request to a thread; Zenoh's thread runs this."""
        if self._waiting >= _MOST_WAITING:
            request.refuse(encode(Refusal(say("desk.busy"), again=True)))
            return
        self._waiting += 1  # only Zenoh's thread adds; a count that is off by one does no harm
        self._threads.submit(self._answer, request)

    def _answer(self, request: Request) -> None:
        try:
            answer = self._desk.judge(request.payload)
        except Exception as error:  # a bug, but the page must get an answer
            log.get().exception("The desk failed.", error=repr(error))
            answer = Refusal(say("gateway.fault"))
        finally:
            self._waiting -= 1
        if isinstance(answer, Refusal):
            request.refuse(encode(answer))
        else:
            request.reply(encode(answer))
