"""Reads a page's requests in their order, and slows down a page that sends too many.

A request that takes long is answered later, while the next ones are read.
"""

import asyncio
import time
from collections.abc import Awaitable, Callable
from contextlib import suppress
from typing import Protocol, TypeVar

from starlette.websockets import WebSocket, WebSocketDisconnect

from lacoc_client.web.gateway import wire
from lacoc_client.web.gateway.answers import Answers
from lacoc_shared.mistakes import FileRefused, UserError
from lacoc_shared.network.allowance import Allowance

GARBAGE = 1008
"""WebSocket close code (policy violation) for a page whose message can't be decoded."""

_FIRST_S = 10.0
_COST_BYTES = 4096
"""A message counts as one more request for each so many bytes, because checking a large table takes
long."""


class Numbered(Protocol):
    """A request of a page; its reply has the same number."""

    @property
    def id(self) -> int:
        """Number of the request."""


Asked = TypeVar("Asked", bound=Numbered)


async def serve_requests(
    websocket: WebSocket,
    answers: Answers,
    read: Callable[[bytes], Asked],
    answer: Callable[[Asked], Awaitable[bool]],
    most_hz: float,
    burst: int,
) -> None:
    """Answer a page's requests until the page goes, or `answer` returns False.

    Args:
        websocket: the page's WebSocket, not accepted yet.
        answers: sends refusals.
        read: decodes a request; raises `wire.Unreadable`.
        answer: answers a request; returns True to go on, or False after it has closed the page. A
            `UserError` or `FileRefused` that it raises is sent to the page as a refusal.
        most_hz: how many requests a second are read in the long run; a page that sends more waits.
        burst: how many requests are read at once.
    """
    asks = Allowance(most_hz, burst)
    await websocket.accept()
    with suppress(TimeoutError, WebSocketDisconnect):
        # A connection that never sends a request must not stay open.
        message = await asyncio.wait_for(websocket.receive(), _FIRST_S)
        while message["type"] == "websocket.receive":
            data = message.get("bytes") or b""
            if not await _take(data, websocket, answers, read, answer):
                return
            cost = min(burst, 1 + len(data) // _COST_BYTES)
            # A page that asks too much is not read for a while; no other page notices.
            while cost := cost - asks.take(cost, time.monotonic()):
                await asyncio.sleep(1 / most_hz)
            message = await websocket.receive()


async def _take(
    data: bytes,
    websocket: WebSocket,
    answers: Answers,
    read: Callable[[bytes], Asked],
    answer: Callable[[Asked], Awaitable[bool]],
) -> bool:
    """Answer one message of a page; return False if the page's connection was closed."""
    try:
        asked = read(data)
    except wire.Unreadable as error:
        to = wire.read_id(data)
        if to is None:
            await websocket.close(GARBAGE, "not a message")
            return False
        answers.refuse(to, error)
        return True
    try:
        return await answer(asked)
    except (UserError, FileRefused) as error:
        answers.refuse(asked.id, error)
        return True
