"""Runs a gateway: opens its port and serves until somebody asks it to end."""

import asyncio
import contextlib
import errno
import os
import re
import socket
from collections.abc import Callable, Iterator

import uvicorn
from starlette.types import ASGIApp

from lacoc_client.gateway.page_socket import PageRequests, PageSocket
from lacoc_client.gateway.wire import JOIN_BYTES
from lacoc_client.stopping import stop_signals
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.address import own_address
from lacoc_shared.words import say

LOOPBACK = "127.0.0.1:0"
"""Where a gateway listens by default: on a free port, for this machine only."""

_LISTEN = re.compile(r"(?P<host>\[[0-9A-Fa-f:.]+\]|[A-Za-z0-9_.-]+):(?P<port>[0-9]{1,5})")
_LOOK_S = 0.1
_ANY = ("0.0.0.0", "::")
_PING_S, _GONE_S = 3.0, 20.0
_BACKLOG = 512  # a whole hall opens its pages at once


def listen(where: str) -> socket.socket:
    """Open the port of a gateway.

    Args:
        where: "HOST:PORT"; port 0 takes a free one.

    Raises:
        UserError: if the address is wrong, or can't be listened on.
    """
    match = _LISTEN.fullmatch(where)
    if match is None or int(match["port"]) > 65_535:
        raise UserError(say("command.bad-listen", where=where))
    host, port = match["host"].strip("[]"), int(match["port"])
    try:
        found = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
        family, kind, protocol, _, address = found
        # asyncio turns Nagle's algorithm off only for a socket whose protocol is TCP. With it a
        # reply and the frame after it would wait 40 ms for the page's delayed acknowledgement.
        opened = socket.socket(family, kind, protocol)
    except OSError as error:
        raise UserError(
            say("gateway.cannot-listen", where=where, why=error.strerror or str(error))
        ) from None
    try:
        if os.name == "posix":  # on Windows two programs could share the port
            opened.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        opened.bind(address)
        opened.listen(_BACKLOG)
    except OSError as error:
        opened.close()
        if error.errno == errno.EADDRINUSE:
            raise UserError(say("gateway.port-used", where=where)) from None
        said = say("gateway.cannot-listen", where=where, why=error.strerror or str(error))
        raise UserError(said) from None
    return opened


def url(opened: socket.socket) -> str:
    """Return the address of a gateway's pages, as other machines can open it."""
    host, port = opened.getsockname()[:2]
    if host in _ANY:
        host = own_address()
    return f"http://[{host}]:{port}" if ":" in host else f"http://{host}:{port}"


def serve(
    app: ASGIApp, opened: socket.socket, stopping: Callable[[], bool], most_bytes: int = JOIN_BYTES
) -> None:
    """Serve pages until `stopping` returns True.

    Args:
        app: the gateway's application.
        opened: the port; see `listen`.
        stopping: called several times a second.
        most_bytes: longest message of a page; a longer one closes its connection.
    """
    asyncio.run(_serve(app, opened, stopping, most_bytes))


async def _serve(
    app: ASGIApp, opened: socket.socket, stopping: Callable[[], bool], most_bytes: int
) -> None:
    config = uvicorn.Config(
        app,
        http=PageRequests,
        ws=PageSocket,
        ws_max_size=most_bytes,
        ws_ping_interval=_PING_S,
        ws_ping_timeout=_GONE_S,
        ws_per_message_deflate=False,  # four times the work for a third of the bytes
        lifespan="on",
        log_config=None,
        access_log=False,
        server_header=False,
        date_header=False,
        proxy_headers=False,
        timeout_graceful_shutdown=2,
    )
    server = _Server(config)
    asking = asyncio.get_running_loop().create_task(_await_end(server, stopping))
    try:
        await server.serve(sockets=[opened])
    finally:
        asking.cancel()


async def _await_end(server: uvicorn.Server, stopping: Callable[[], bool]) -> None:
    while not stopping():
        await asyncio.sleep(_LOOK_S)
    server.should_exit = True


class _Server(uvicorn.Server):
    @contextlib.contextmanager
    def capture_signals(self) -> Iterator[None]:
        """Leave signals to `stop_signals`: uvicorn's handlers would end the process."""
        yield


def run(
    app: ASGIApp, opened: socket.socket, ready: Callable[[], None], most_bytes: int = JOIN_BYTES
) -> None:
    """Serve until Ctrl-C.

    Args:
        app: the gateway's application.
        opened: the port; see `listen`.
        ready: called once signals are handled; it prints where the pages are.
        most_bytes: longest message of a page; a longer one closes its connection.
    """
    with opened, stop_signals() as stopping:
        ready()
        serve(app, opened, stopping, most_bytes)
