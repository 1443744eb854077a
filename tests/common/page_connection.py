"""A page's connection without a browser: it sends requests and keeps the gateway's messages."""

import itertools
import time
from collections.abc import Callable
from typing import Any, Self

import msgpack
import msgspec
from waiting import LIMIT_S
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect

from lacoc_client.web.gateway.wire import MessageKind
from lacoc_shared.words import Phrase, render

_OF_COURTS = (
    MessageKind.FRAME,
    MessageKind.EVENT,
    MessageKind.SHEET,
    MessageKind.SCENE,
    MessageKind.HEALTH,
)
"""Kinds of messages that a gateway passes on from a court; the connection does not keep them."""


class Refused(Exception):
    """The gateway, or a court or studio behind it, refused a request; `reply` is its reply."""

    def __init__(self, reply: dict[str, Any]) -> None:
        self.reply = reply
        self.why = msgspec.convert(reply["error"], Phrase)
        super().__init__(render(self.why))
        self.mistakes: list[dict[str, Any]] = reply.get("mistakes", [])
        self.is_the_token: bool = reply.get("token_refused", False)
        self.again: bool = reply.get("again", False)
        self.unanswered: bool = reply.get("unanswered", False)


class PageConnection:
    """A page's connection; it reads only while it waits for something.

    Args:
        url: address of the gateway.
        path: path of the WebSocket.
        options: of the WebSocket's `connect`.
    """

    def __init__(self, url: str, path: str, **options: Any) -> None:
        address = f"{url.replace('http', 'ws', 1)}{path}"
        # Without `max_queue`, unread messages never block the answers to pings.
        # A gateway that answers many requests one after another closes late; no test waits for it.
        self.socket: ClientConnection = connect(
            address, max_size=None, max_queue=None, close_timeout=1, legacy=True, **options
        )
        self._ids = itertools.count(1)
        self._replies: dict[int, dict[str, Any]] = {}
        self.told: dict[MessageKind, list[dict[str, Any]]] = {kind: [] for kind in MessageKind}
        """All messages of the gateway's own kinds, except replies."""

    def last(self, kind: MessageKind) -> dict[str, Any]:
        """Return the newest message of a kind; {}: there is none yet."""
        return self.told[kind][-1] if self.told[kind] else {}

    def ask(self, do: str, **fields: Any) -> Any:
        """Send a request, wait for the reply and return its value.

        Raises:
            Refused: if the request was refused.
        """
        return self.reply(self.send(do, **fields))

    def send(self, do: str, **fields: Any) -> int:
        """Send a request without waiting for its reply; return its id."""
        number = next(self._ids)
        self.socket.send(msgpack.packb({"id": number, "do": do, **fields}))
        return number

    def reply(self, number: int) -> Any:
        """Wait for the reply to a request and return its value.

        Raises:
            Refused: if the request was refused.
        """
        self.until(lambda: number in self._replies)
        reply = self._replies.pop(number)
        if not reply["ok"]:
            raise Refused(reply)
        return reply["value"]

    def until(self, condition: Callable[[], Any]) -> None:
        """Take in messages until a condition is true."""
        deadline_s = time.monotonic() + LIMIT_S
        while not condition():
            assert time.monotonic() < deadline_s, "it did not become true"
            self._receive(self.socket.recv(LIMIT_S))

    def code(self) -> int | None:
        """Wait until the gateway closes the connection; return its close code."""
        try:
            while True:
                self._receive(self.socket.recv(LIMIT_S))
        except ConnectionClosed:
            return self.socket.protocol.close_code

    def close(self) -> None:
        self.socket.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _receive(self, message: str | bytes) -> None:
        assert isinstance(message, bytes)
        self._take(MessageKind(message[0]), message[1:])

    def _take(self, kind: MessageKind, payload: bytes) -> None:
        if kind in _OF_COURTS:
            return
        body = msgpack.unpackb(payload)
        if kind is MessageKind.REPLY:
            self._replies[body["id"]] = body
        else:
            self.told[kind].append(body)
