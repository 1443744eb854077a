"""uvicorn's connections, extended for hundreds of pages and against clients that only block them.

Here a frame is a WebSocket frame: the bytes of one message to a page.

A message to all pages is made once, as the bytes of its WebSocket frame, and written to each page.
Through ASGI, each of 300 pages would need a task switch 25 times a second. A socket also notices
whether its page keeps up, so that a page gets no more than it can take.
"""

import asyncio
import socket
from asyncio.transports import BaseTransport, Transport
from collections.abc import Callable
from typing import cast

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol
from websockets.http11 import Request

from lacoc_shared.network.public import is_loopback, is_proxy

KEPT_BYTES = 1 << 20
"""Most bytes that may wait for a page. A page with more is closed: it has gone, or is too slow."""
_UNSENT_BYTES = 4096
"""A page counts as slow while the system holds back more bytes than these: a dozen frames."""
_UNANSWERED_S = 1.0
"""Longest time to answer a ping. A page that takes longer gets no frames until it answers, so that
buffers on the way, however large, never fill with old frames.
"""
_WATCHED_PING_S = 0.3
REQUEST_S = 20.0
"""Longest time in which a request must arrive, from its first byte to its last [s]."""
CONNECTIONS_MOST = 500
"""Most connections of one machine: a browser opens six, beside its WebSocket."""


class PageSocket(WebSocketsSansIOProtocol):
    """A WebSocket to which finished WebSocket frames are written.

    For the application it is `websocket.state.socket`.
    """

    heard_s = 0.0
    """Time when the page last sent anything, on the loop's clock."""
    drained: Callable[[], None] | None = None
    """Called when all bytes that had to wait have been sent."""

    def connection_made(self, transport: BaseTransport) -> None:
        """Begin to use a new connection of a page; see `asyncio.Protocol`."""
        super().connection_made(transport)
        self.heard_s = self.loop.time()
        cast(Transport, transport).set_write_buffer_limits(high=0)
        raw = transport.get_extra_info("socket")
        if raw is not None and hasattr(socket, "TCP_NOTSENT_LOWAT"):
            raw.setsockopt(socket.IPPROTO_TCP, socket.TCP_NOTSENT_LOWAT, _UNSENT_BYTES)

    def handle_connect(self, event: Request) -> None:
        """Answer the request with which a page opens its WebSocket."""
        super().handle_connect(event)
        if self.response.status_code == 101:
            self.scope["state"]["socket"] = self

    def data_received(self, data: bytes) -> None:
        """Receive bytes from the page; see `asyncio.Protocol`."""
        self.heard_s = self.loop.time()
        super().data_received(data)

    def resume_writing(self) -> None:
        """Continue after all bytes for the page were sent; see `asyncio.Protocol`."""
        super().resume_writing()
        if self.drained is not None:
            self.drained()

    @property
    def keeps_up(self) -> bool:
        """True if no written bytes wait for the page, and the page answers its pings."""
        if self.transport.get_write_buffer_size():
            return False
        if self.pending_ping_payload is None:
            return True
        return self.loop.time() - self.ping_sent_at < _UNANSWERED_S

    def write(self, framed: bytes) -> None:
        """Send a finished WebSocket frame, even if earlier ones still wait to be sent."""
        if self.close_sent or self.transport.is_closing():
            return
        if self.transport.get_write_buffer_size() > KEPT_BYTES:
            self.transport.abort()
            return
        self.transport.write(framed)

    def watch_closely(self) -> None:
        """Ping the page several times a second, because somebody steers a robot on it."""
        if self.ping_interval != _WATCHED_PING_S:
            self.ping_interval = _WATCHED_PING_S
            self.stop_keepalive()
            self.schedule_ping()


class PageRequests(H11Protocol):
    """An HTTP connection of a browser; it is closed if half a request stays on it for too long.

    Otherwise somebody could open many connections, send half a request on each, and block them for
    ever. A machine with very many connections gets no more, unless it is a proxy, which asks for
    other machines.
    """

    _too_late: asyncio.TimerHandle | None = None

    def connection_made(self, transport: Transport) -> None:  # type: ignore[override]
        """Begin to use a new connection of a browser; see `asyncio.Protocol`."""
        super().connection_made(transport)
        clients = (getattr(one, "client", None) for one in self.connections)
        machine = self.client[0] if self.client else ""
        held = sum(client is not None and client[0] == machine for client in clients)
        asks_for_others = is_loopback(machine) or is_proxy(machine, self.config.forwarded_allow_ips)
        if held > CONNECTIONS_MOST and not asks_for_others:
            transport.abort()
            return
        self._wait()

    def connection_lost(self, exc: Exception | None) -> None:
        """Note that a connection has ended; see `asyncio.Protocol`."""
        self._wait_no_longer()
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        """Receive bytes from the browser; see `asyncio.Protocol`."""
        super().data_received(data)
        own = self.transport.get_protocol() is self  # else it is a WebSocket's connection now
        if own and self.conn.their_state in (h11.IDLE, h11.SEND_BODY):
            self._wait()
        else:
            self._wait_no_longer()

    def _wait(self) -> None:
        if self._too_late is None:
            self._too_late = self.loop.call_later(REQUEST_S, self.transport.abort)

    def _wait_no_longer(self) -> None:
        if self._too_late is not None:
            self._too_late.cancel()
            self._too_late = None
