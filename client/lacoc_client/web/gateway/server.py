"""Runs a gateway: opens its port and serves until somebody asks it to end."""

import asyncio
import contextlib
import errno
import os
import re
import socket
from collections.abc import Callable, Iterator
from typing import Self

import uvicorn
from starlette.types import ASGIApp

from lacoc_client.play.stopping import stop_signals
from lacoc_client.web.gateway.guard import Guard
from lacoc_client.web.gateway.page_socket import PageRequests, PageSocket
from lacoc_client.web.gateway.wire import JOIN_BYTES
from lacoc_shared.command import log
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.address import own_address
from lacoc_shared.network.certificate import Certificate
from lacoc_shared.network.public import PublicAddress
from lacoc_shared.words import say

LOOPBACK = "127.0.0.1:0"
"""Where a gateway listens by default: on a free port, for this machine only."""

_LISTEN = re.compile(r"(?P<host>\[[0-9A-Fa-f:.]+\]|[A-Za-z0-9_.-]+):(?P<port>[0-9]{1,5})")
_LOOK_S = 0.1
_RENEW_S = 5.0
"""Time between two checks whether the certificate was renewed [s]."""
_ANY = ("0.0.0.0", "::")
_PING_S, _GONE_S = 3.0, 20.0
_BACKLOG = 512  # a whole hall opens its pages at once


class Port:
    """The port of a gateway, and how people reach its pages; used as a context manager.

    Args:
        opened: a socket that listens already.
        public: how others reach the pages.

    Raises:
        UserError: if the certificate can't be read; the socket is closed then.
    """

    def __init__(self, opened: socket.socket, public: PublicAddress) -> None:
        self.socket = opened
        self.public = public
        try:
            self.certificate = None if public.pair is None else Certificate(public.pair)
        except UserError:
            opened.close()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.socket.close()

    @property
    def listens(self) -> str:
        """The address at which the gateway listens: "HOST:PORT", with the real port number."""
        host, port = self.socket.getsockname()[:2]
        return f"[{host}]:{port}" if ":" in host else f"{host}:{port}"

    @property
    def url(self) -> str:
        """Address at which everybody opens the gateway's pages, without a slash at its end."""
        if self.public.pages:
            return self.public.pages
        host, port = self.socket.getsockname()[:2]
        if host in _ANY:
            host = own_address()
        host = f"[{host}]" if ":" in host else host
        return f"{self.public.scheme}://{host}:{port}"


def listen(where: str, public: PublicAddress | None = None) -> Port:
    """Open the port of a gateway.

    Args:
        where: "HOST:PORT"; port 0 chooses a free port.
        public: how others reach the pages; None: at the address of this machine.

    Raises:
        UserError: if the address is wrong, or can't be listened on; or if the certificate can't be
            read.
    """
    return Port(_opened(where), public or PublicAddress())


def _opened(where: str) -> socket.socket:
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


def serve(
    app: ASGIApp, port: Port, stopping: Callable[[], bool], most_bytes: int = JOIN_BYTES
) -> None:
    """Serve pages until `stopping` returns True.

    Args:
        app: the gateway's application.
        port: the port; see `listen`.
        stopping: called several times a second.
        most_bytes: longest message of a page; a longer message closes the page's connection.
    """
    asyncio.run(_serve(app, port, stopping, most_bytes))


async def _serve(app: ASGIApp, port: Port, stopping: Callable[[], bool], most_bytes: int) -> None:
    certificate, proxies = port.certificate, port.public.proxies
    config = uvicorn.Config(
        Guard(app, port.public),
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
        proxy_headers=bool(proxies),
        forwarded_allow_ips=[*proxies],
        ssl_context_factory=None if certificate is None else lambda *_: certificate.context,
        timeout_graceful_shutdown=2,
    )
    server = _Server(config)
    loop = asyncio.get_running_loop()
    tasks = [loop.create_task(_await_end(server, stopping))]
    if certificate is not None:
        tasks.append(loop.create_task(_renew(certificate)))
    try:
        await server.serve(sockets=[port.socket])
    finally:
        for task in tasks:
            task.cancel()


async def _await_end(server: uvicorn.Server, stopping: Callable[[], bool]) -> None:
    while not stopping():
        await asyncio.sleep(_LOOK_S)
    server.should_exit = True


async def _renew(certificate: Certificate) -> None:
    while True:
        await asyncio.sleep(_RENEW_S)
        try:
            if await asyncio.to_thread(certificate.renew):
                log.get().info("The certificate was renewed.", kind="certificate")
        except UserError as error:
            log.get().warning(f"The old certificate stays: {error}", kind="certificate")


class _Server(uvicorn.Server):
    @contextlib.contextmanager
    def capture_signals(self) -> Iterator[None]:
        """Let uvicorn catch no signals, because it would end the process; `stop_signals` does."""
        yield


def run(app: ASGIApp, port: Port, ready: Callable[[], None], most_bytes: int = JOIN_BYTES) -> None:
    """Serve pages until Ctrl-C or another signal that ends a program.

    Args:
        app: the gateway's application.
        port: the port; see `listen`.
        ready: called when signals are caught; it prints the address of the pages.
        most_bytes: longest message of a page; a longer message closes the page's connection.
    """
    with port, stop_signals() as stopping:
        ready()
        serve(app, port, stopping, most_bytes)
