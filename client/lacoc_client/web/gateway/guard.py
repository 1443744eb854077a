"""Lets a gateway accept only connections of its own pages, and not too many of one machine.

Any web site can make a browser send requests to 127.0.0.1. So the Host of a request must be a name
of this machine, the name of its public address, or an IP address. (Another site's name could be
made to point here; an IP address can't.) A page of another origin gets no WebSocket. A proxy may
replace the Host by the gateway's own address; then the origin is still that of the public address.
"""

import re
import socket
from collections import Counter
from urllib.parse import urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import PlainTextResponse, RedirectResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from lacoc_shared.network.public import PublicAddress, is_loopback, is_number
from lacoc_shared.words import LANGUAGES, Phrase, render, say
from lacoc_shared.words.render import Language

_POLICY = (
    "default-src 'self'; img-src 'self' data: blob:; style-src 'self' 'unsafe-inline'; "
    "worker-src 'self' blob:; object-src 'none'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors {ancestors}"
)
_HOST = re.compile(r"(\[(?P<number>[0-9A-Fa-f:.]+)\]|(?P<name>[^][:]+))(:[0-9]*)?")
SOCKETS_MOST = 200
"""Most WebSockets of one machine: half of the pages that may watch. So a school of 35 behind one
address has five pages for each person, and no machine alone can take all places."""
_EMBEDDABLE = ("/overlay",)
"""Pages that other sites may embed, because one can't enter anything on them."""


def machine_names() -> frozenset[str]:
    """Return the host names by which others may reach this machine."""
    name = socket.gethostname().lower()
    first = name.partition(".")[0]
    return frozenset({"localhost", name, first, f"{first}.local"}) - {""}


class Guard:
    """Checks each connection before the application gets it, and removes the public path prefix.

    Args:
        app: the application; its paths begin at "/".
        public: how others reach the pages.
    """

    def __init__(self, app: ASGIApp, public: PublicAddress) -> None:
        self._app = app
        self._public = public
        self._names = machine_names() | ({public.host} - {""})
        self._held: Counter[str] = Counter()
        """Number of open WebSockets of each machine, by its address."""

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a connection on to the application, or refuse it."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return

        async def send_safely(message: Message) -> None:
            if message["type"] in ("http.response.start", "websocket.http.response.start"):
                _add_headers(MutableHeaders(scope=message), scope["path"])
            await send(message)

        app = self._instead(scope) or self._app
        if scope["type"] == "http":
            await app(scope, receive, send_safely)
            return
        machine = machine_of(scope)
        self._held[machine] += 1
        try:
            await app(scope, receive, send_safely)
        finally:
            self._held[machine] -= 1
            self._held += Counter()  # forgets those with none

    def _instead(self, scope: Scope) -> ASGIApp | None:
        """Return an answer that refuses or redirects the request; None: the application answers."""
        if (refusal := self._why_not(scope)) is not None:
            return answer_browser(scope, refusal, 403)
        below = self._public.path
        if below and scope["path"] == below and scope["type"] == "http":
            return RedirectResponse(f"{below}/")  # else the page would look for its parts beside it
        if below and scope["path"].startswith(f"{below}/"):  # a proxy may have taken it away
            scope["path"] = scope["path"].removeprefix(below)
        at_socket = scope["type"] == "websocket" or scope["path"].endswith("/ws")
        machine = machine_of(scope)
        # A proxy here that nobody named asks for all: a limit for one would be one for everybody.
        if at_socket and self._held[machine] >= SOCKETS_MOST and not is_loopback(machine):
            return answer_browser(scope, say("gateway.machine-full", most=SOCKETS_MOST), 429)
        if at_socket and scope["type"] == "http":
            return answer_browser(scope, say("gateway.no-websocket"), 426)
        return None

    def _why_not(self, scope: Scope) -> Phrase | None:
        hosts = _all(scope, b"host")
        name = name_of(hosts[0]) if len(hosts) == 1 else ""
        if not (is_number(name) or name in self._names):
            forwarded = _all(scope, b"x-forwarded-proto")  # only for what is advised
            scheme = forwarded[0] if forwarded in (["http"], ["https"]) else scope["scheme"]
            pages = f"{scheme}://{hosts[0][:80] if name else 'NAME'}"
            return say("gateway.unknown-name", name=name[:80] or "NAME", pages=pages)
        origins = _all(scope, b"origin")
        asks = scope["type"] == "websocket" or scope.get("method") == "POST"
        if asks and origins:
            origin = urlsplit(origins[0])
            same = origin.scheme in ("http", "https") and origin.netloc.lower() == hosts[0].lower()
            if len(origins) > 1 or not (same or origins[0].lower() == self._public.origin):
                return say("gateway.other-site", origin=origins[0][:80])
        return None


def machine_of(scope: Scope) -> str:
    """Return the address of the machine from which a request comes.

    Behind a trusted proxy, it is the address that the proxy names. "" if it is not known.
    """
    client = scope.get("client")
    return client[0] if client else ""


def answer_browser(scope: Scope, said: Phrase, status: int) -> PlainTextResponse:
    """Answer a browser with a sentence in its language, instead of a page."""
    return PlainTextResponse(f"{render(said, language_of(scope))}\n", status_code=status)


def language_of(scope: Scope) -> Language:
    """Return the language that a browser prefers, of those in which LACOC has texts."""
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


def name_of(host: str) -> str:
    """Return a host without its port; "" if the text is no host."""
    match = _HOST.fullmatch(host)
    return (match["number"] or match["name"]).lower().rstrip(".") if match else ""
