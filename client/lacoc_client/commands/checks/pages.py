"""Checks the public address of an event's pages: its name, certificate and WebSocket."""

import http.client
import socket
import ssl
import time
from collections.abc import Iterator, Mapping
from typing import NamedTuple
from urllib.parse import urlsplit

import msgspec
from websockets.exceptions import WebSocketException
from websockets.sync.client import connect
from websockets.typing import Origin

from lacoc_client.commands.checks.machine import Finding, Status
from lacoc_client.web.gateway.guard import name_of
from lacoc_client.web.gateway.health import GatewayHealth
from lacoc_shared.contest.courts import ContestCourt
from lacoc_shared.network.address import host as address_host
from lacoc_shared.network.public import PublicAddress, is_loopback
from lacoc_shared.words import say

_WAIT_S = 10.0
_SOON_DAYS = 14.0
_DAY_S = 86_400.0
_HOUR_S = 3600.0
_CADDY = "Caddy Local Authority"
"""First words of the name of the authority that Caddy makes for itself. Certificates of this
authority are valid for hours only."""


class _PageAnswer(NamedTuple):
    status: int
    body: bytes


def pages(public: PublicAddress, title: str) -> Iterator[Finding]:
    """Check the public address of an event's pages, as a browser reaches it.

    Args:
        public: how others reach the pages; it has an address.
        title: name of the contest; "" if there is none.
    """
    about = say("doctor.pages", pages=public.pages)
    try:
        socket.getaddrinfo(public.host, None)
    except (OSError, UnicodeError):  # a name of other form than names of machines have
        found = say("doctor.pages-unknown", host=public.host)
        yield Finding(about, Status.PROBLEM, found, say("doctor.pages-unknown-todo"))
        return
    try:
        if public.pages.startswith("https:"):
            yield _certificate(public)
        answer = _get(public, "/healthz")
    except ssl.SSLCertVerificationError as error:
        found = say("doctor.pages-not-proven", why=error.verify_message)
        yield Finding(about, Status.PROBLEM, found, say("doctor.pages-not-proven-todo"))
        return
    except (OSError, http.client.HTTPException) as error:
        if _is_answer(error):
            found = say("doctor.pages-garbled", why=str(error))
            yield Finding(about, Status.PROBLEM, found, say("doctor.pages-garbled-todo"))
            return
        found = say("doctor.pages-silent", why=str(error))
        yield Finding(about, Status.NOTE, found, say("doctor.pages-silent-todo"))
        return
    try:
        health = msgspec.json.decode(answer.body, type=GatewayHealth)
    except msgspec.MsgspecError:
        found = say("doctor.pages-other", status=answer.status)
        if answer.status >= 500:
            yield Finding(about, Status.NOTE, found, say("doctor.pages-behind-todo"))
            return
        other, name = say("doctor.pages-other-todo"), say("doctor.pages-name-todo")
        yield Finding(about, Status.PROBLEM, found, name if answer.status == 403 else other)
        return
    yield from _reached(public, title, health)
    yield _websocket(public)


def _is_answer(error: Exception) -> bool:
    """Return whether somebody answered, but encrypted instead of plain or the other way round."""
    if isinstance(error, ssl.SSLEOFError | ssl.SSLZeroReturnError | http.client.RemoteDisconnected):
        return False  # it hung up, as a proxy may whose gateway does not run yet
    return isinstance(error, ssl.SSLError | http.client.HTTPException)


def plain_courts(public: PublicAddress, courts: Mapping[str, ContestCourt]) -> Iterator[Finding]:
    """Report courts that others reach without encryption although the pages are encrypted.

    Args:
        public: how others reach the pages.
        courts: the courts of the contest file, by name.
    """
    if not public.pages.startswith("https:"):
        return
    for name, court in courts.items():
        ways = [one for one in court.listen if one.startswith("tcp/")]
        if plain := [one for one in ways if not is_loopback(address_host(one))]:
            found = say("doctor.plain-court", at=plain[0])
            todo = say("doctor.plain-court-todo", port=plain[0].rpartition(":")[2])
            yield Finding(say("doctor.court", court=name), Status.NOTE, found, todo)


def _reached(public: PublicAddress, title: str, health: GatewayHealth) -> Iterator[Finding]:
    about = say("doctor.pages", pages=public.pages)
    if title and health.contest != title:
        found = say("doctor.pages-another", contest=health.contest)
        yield Finding(about, Status.PROBLEM, found, say("doctor.pages-unknown-todo"))
        return
    name = health.contest or None
    found = say("doctor.pages-found", contest=name, version=health.version)
    yield Finding(about, Status.OK, found)
    if health.unnamed_proxy:
        found = say("doctor.pages-proxy")
        yield Finding(about, Status.PROBLEM, found, say("doctor.pages-proxy-todo"))
    if name_of(health.host) != public.host:
        found = say("doctor.pages-host", host=health.host)
        yield Finding(about, Status.NOTE, found, say("doctor.pages-host-todo"))


def _certificate(public: PublicAddress) -> Finding:
    """Check until when the certificate of an event's pages is valid.

    Raises:
        OSError: if there is no connection, or the certificate is not proven.
    """
    with (
        socket.create_connection((public.host, _port(public)), _WAIT_S) as raw,
        _context(public).wrap_socket(raw, server_hostname=public.host) as wrapped,
    ):
        shown = wrapped.getpeercert() or {}
    left_s = ssl.cert_time_to_seconds(str(shown["notAfter"])) - time.time()
    days = left_s / _DAY_S
    found = say("doctor.certificate-found", days=days)
    if days < 1:
        found = say("doctor.certificate-hours", hours=left_s / _HOUR_S)
    about = say("doctor.certificate")
    issuer = [pair[-1] for part in shown.get("issuer", ()) for pair in part]
    if any(str(name).startswith(_CADDY) for name in issuer):
        return Finding(about, Status.OK, say("doctor.certificate-caddy", left=found))
    if days > _SOON_DAYS:
        return Finding(about, Status.OK, found)
    return Finding(about, Status.NOTE, found, say("doctor.certificate-todo"))


def _websocket(public: PublicAddress) -> Finding:
    about = say("doctor.websocket")
    url = public.pages.replace("http", "ws", 1) + "/ws"
    try:
        with connect(
            url,
            origin=Origin(public.origin),
            open_timeout=_WAIT_S,
            close_timeout=1,
            ssl=_context(public) if url.startswith("wss:") else None,
        ):
            return Finding(about, Status.OK, say("doctor.websocket-found"))
    except (OSError, WebSocketException) as error:
        found = say("doctor.websocket-none", why=str(error))
        return Finding(about, Status.PROBLEM, found, say("doctor.websocket-todo"))


def _get(public: PublicAddress, path: str) -> _PageAnswer:
    """Request a path from an event's pages; return the HTTP status and the body.

    Raises:
        OSError: if nobody answers.
        HTTPException: if the answer is not HTTP.
    """
    host, port = public.host, _port(public)
    connection = http.client.HTTPConnection(host, port, timeout=_WAIT_S)
    if public.pages.startswith("https:"):
        connection = http.client.HTTPSConnection(
            host, port, timeout=_WAIT_S, context=_context(public)
        )
    try:
        connection.request("GET", f"{public.path}{path}")
        answer = connection.getresponse()
        return _PageAnswer(answer.status, answer.read(1 << 16))
    finally:
        connection.close()


def _context(public: PublicAddress) -> ssl.SSLContext:
    context = ssl.create_default_context()
    if authority := public.read_authority():
        context.load_verify_locations(cadata=authority)
    return context


def _port(public: PublicAddress) -> int:
    return urlsplit(public.pages).port or (443 if public.pages.startswith("https:") else 80)
