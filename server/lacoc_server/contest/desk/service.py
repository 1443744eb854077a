"""Connects a desk to the network: requests arrive over Zenoh, and threads answer them."""

import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Self

import msgspec

from lacoc_shared.codec import encode
from lacoc_shared.command import log
from lacoc_shared.keyspace import DESK
from lacoc_shared.messages import Refusal
from lacoc_shared.network.session import Request, open_desk
from lacoc_shared.words import say

_THREADS = 4
_MOST_AT_ONCE = 64
"""How many requests can wait or be under way at most. Further ones are refused, and may be sent
again."""
HERE = "tcp/127.0.0.1:0"
"""Where the desk listens: only on this machine, at a free port, because the gateway runs here
too."""


class DeskService:
    """Answers requests to a desk until it is closed; used as a context manager.

    Args:
        judge: answers an encoded request, or refuses it; any thread may call it.
        listen: address at which to listen.

    Raises:
        UserError: if it can't listen.
    """

    def __init__(
        self, judge: Callable[[bytes], msgspec.Struct | bytes], listen: str = HERE
    ) -> None:
        self._judge = judge
        self._threads = ThreadPoolExecutor(_THREADS, thread_name_prefix="desk")
        self._room = threading.Semaphore(_MOST_AT_ONCE)
        self._session = open_desk([listen])
        self._session.answer(DESK, self._arrived)
        self.address = self._session.locators()[0]
        """Address of the desk, with the real port."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._session.close()
        self._threads.shutdown(wait=True, cancel_futures=True)

    def _arrived(self, request: Request) -> None:
        """Hand a request to a thread that answers it; this is called in Zenoh's thread."""
        if not self._room.acquire(blocking=False):
            request.refuse(encode(Refusal(say("desk.busy"), again=True)))
            return
        self._threads.submit(self._answer, request)

    def _answer(self, request: Request) -> None:
        try:
            answer = self._judge(request.payload)
        except Exception as error:  # a bug, but the page must get an answer
            log.get().exception("The desk failed.", error=repr(error))
            answer = Refusal(say("gateway.fault"))
        finally:
            self._room.release()
        if isinstance(answer, Refusal):
            request.refuse(encode(answer))
        else:
            request.reply(encode(answer))
