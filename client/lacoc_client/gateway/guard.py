"""Decides who may talk to a gateway: browsers that opened its page, and no other site's pages.

Any web site can make a browser send requests to 127.0.0.1. So the Host must be a name of this
machine, or an IP address: another site's name could be made to point here, an IP address can't. And
a page of another origin gets no WebSocket.
"""

import ipaddress
import re
import socket
from collections.abc import Iterable
from urllib.parse import urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from lacoc_shared.words import LANGUAGES, Phrase, render, say
from lacoc_shared.words.render import Language

_POLICY = (
    "default-src 'self'; img-src 'self' data: blob:; style-src 'self' 'unsafe-inline'; "
    "worker-src 'self' blob:; object-src 'none'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors {ancestors}"
)
_HOST = re.compile(r"(\[(?P<number>[0-9A-Fa-f:.]+)\]|(?P<name>[^][:]+))(:[0-9]*)?")
_EMBEDDABLE = ("/overlay",)
"""Pages that other sites may embed: they take no input."""


def machine_names() -> frozenset[str]:
    """Return the names by which others know this machine."""
    name = socket.gethostname().lower()
    first = name.partition(".")[0]
    return frozenset({"localhost", name, first, f"{first}.local"}) - {""}


class Guard:
    """Checks each connection before the application gets it.

    Args:
        app: the application.
        names: further names of this machine.
    """

    def __init__(self, app: ASGIApp, names: Iterable[str] = ()) -> None:
        self._app = app
        self._names = machine_names() | {name.lower() for name in names}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Let a connection in, or refuse it."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        refusal = self._why_not(scope)

        async def send_safely(message: Message) -> None:
            if message["type"] in ("http.response.start", "websocket.http.response.start"):
                _add_headers(MutableHeaders(scope=message), scope["path"])
            await send(message)

        if refusal is not None:
            await answer(scope, refusal, 403)(scope, receive, send_safely)
        else:
            await self._app(scope, receive, send_safely)

    def _why_not(self, scope: Scope) -> Phrase | None:
        hosts = _all(scope, b"host")
        name = _name_of(hosts[0]) if len(hosts) == 1 else ""
        if not (_is_number(name) or name in self._names):
            return say("gateway.unknown-name", name=name[:80], host=name[:80] or "NAME")
        origins = _all(scope, b"origin")
        if scope["type"] == "websocket" and origins:
            origin = urlsplit(origins[0])
            same = origin.scheme in ("http", "https") and origin.netloc.lower() == hosts[0].lower()
            if len(origins) > 1 or not same:
                return say("gateway.other-site")
        return None


def answer(scope: Scope, said: Phrase, status: int) -> PlainTextResponse:
    """Answer a browser with a sentence in its language, instead of a page."""
    return PlainTextResponse(f"{render(said, language_of(scope))}\n", status_code=status)


def language_of(scope: Scope) -> Language:
    """Return the language that a browser wants most, of those that LACOC speaks."""
    wanted = Headers(scope=scope).get("accept-language", "").lower()
    # Browsers list the preferred language first.
    found = ((wanted.find(language), language) for language in LANGUAGES if language in wanted)
    return min(found, default=(0, LANGUAGES[0]))[1]


def _add_headers(headers: MutableHeaders, path: str) -> None:
    embeddable = path in _EMBEDDABLE
    headers["Content-Security-Policy"] = _POLICY.format(ancestors="*" if embeddable else "'none'")
    headers["X-Content-Type-Options"] = "nosniff"
    headers["Referrer-Policy"] = "no-referrer"
    headers["Cross-Origin-Resource-Policy"] = "same-origin"
    if not embeddable:
        headers["Cross-Origin-Opener-Policy"] = "same-origin"
    headers.setdefault("Cache-Control", "no-store")


def _all(scope: Scope, name: bytes) -> list[str]:
    return [value.decode("latin-1") for key, value in scope["headers"] if key.lower() == name]


def _name_of(host: str) -> str:
    """Return the host without its port; "" if this is no host."""
    match = _HOST.fullmatch(host)
    return (match["number"] or match["name"]).lower().rstrip(".") if match else ""


def _is_number(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True
