"""The connection to the desk of a contest's office."""

import asyncio
import threading
import time

from lacoc_client.play.asking import NoAnswer, NotNow, refusal_of
from lacoc_client.web.gateway.threads import Threads
from lacoc_shared.keyspace import DESK
from lacoc_shared.network.session import (
    NoReply,
    NotConnected,
    Refused,
    Session,
    TooLate,
    open_client,
)
from lacoc_shared.words import say

_THREADS = 8
_ANSWER_S = 30.0
"""Longest wait for an answer [s]: the desk weighs in the files of this request and of all before
it."""
_COMING_BACK_S, _AGAIN_S = 1.0, 0.05


class DeskLine:
    """The connection to the office's desk; it is opened with the first request.

    Args:
        address: address of the desk.
    """

    def __init__(self, address: str) -> None:
        self._address = address
        self._threads = Threads(_THREADS)
        self._session: Session | None = None
        self._opening = threading.Lock()

    async def ask(self, request: bytes) -> bytes:
        """Send a request to the office's desk, and return the answer.

        Raises:
            FileRefused: if the desk found mistakes in files.
            NotNow: if the office is not running, or has too much to do.
            NoAnswer: if the desk got the request and does not answer in time.
            UserError: if the desk refuses.
        """
        return await self._threads.run(lambda: self._ask(request))

    async def close(self) -> None:
        """Close the connection to the office's desk."""
        self._threads.close()
        if self._session is not None:
            await asyncio.to_thread(self._session.close)

    def _ask(self, request: bytes) -> bytes:
        end_s = time.monotonic() + _COMING_BACK_S
        while True:
            try:
                return self._opened().ask(DESK, request, _ANSWER_S)
            except TooLate:
                raise NoAnswer(say("desk.no-office")) from None
            except (NoReply, NotConnected):
                # Nobody received it: right after a connection this may last for a moment.
                if time.monotonic() >= end_s:
                    raise NotNow(say("desk.no-office")) from None
                time.sleep(_AGAIN_S)
            except Refused as refused:
                raise refusal_of(refused.payload) from None

    def _opened(self) -> Session:
        with self._opening:
            if self._session is None:
                self._session = open_client([self._address])
            return self._session
