"""A gateway at an address that is not its own: names, origins, paths, proxies, certificates."""

import contextlib
import socket
import ssl
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from http.client import HTTPConnection
from pathlib import Path

import pytest
import trustme
from hypothesis import given
from hypothesis import strategies as st
from proxies import issue
from starlette.requests import Request
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Receive, Scope, Send
from waiting import LIMIT_S, until
from websockets.exceptions import InvalidStatus
from websockets.sync.client import ClientConnection, connect

from lacoc_client.web.gateway import guard, page_socket, server
from lacoc_shared.contest import file as contests
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.certificate import Certificate, Pair
from lacoc_shared.network.public import _ADDRESS, PublicAddress
from lacoc_shared.words import render

PAGES = "https://uni.example/lacoc"


async def echo(scope: Scope, receive: Receive, send: Send) -> None:
    """Answer with what the gateway understood: the path, and who asks."""
    if scope["type"] == "websocket":
        await receive()
        await send({"type": "websocket.accept"})
        await send({"type": "websocket.send", "text": scope["path"]})
        await send({"type": "websocket.close"})
    elif scope["type"] == "http":
        request = Request(scope)
        assert request.client is not None
        said = f"{scope['path']} {request.client.host} {scope['scheme']}"
        await PlainTextResponse(said)(scope, receive, send)


@contextmanager
def served(public: PublicAddress, app: ASGIApp = echo) -> Iterator[server.Port]:
    """Serve an application at a public address; give the port."""
    ended = threading.Event()
    with server.listen(server.LOOPBACK, public) as port:
        thread = threading.Thread(target=server.serve, args=(app, port, ended.is_set))
        thread.start()
        try:
            yield port
        finally:
            ended.set()
            thread.join(LIMIT_S)


def ask(port: server.Port, path: str, method: str = "GET", **headers: str) -> tuple[int, str, str]:
    """Ask for a path; return status, body, and where the gateway sends the browser."""
    connection = HTTPConnection(*port.socket.getsockname(), timeout=LIMIT_S)
    try:
        connection.request(method, path, headers=headers)
        answer = connection.getresponse()
        return answer.status, answer.read().decode(), answer.getheader("Location", "")
    finally:
        connection.close()


def test_all_is_served_below_the_path_of_the_pages() -> None:
    """A proxy may take the path away or leave it; the name in Host may be its own or public."""
    with served(PublicAddress.of(PAGES + "/")) as port:
        assert port.url == PAGES
        for host in ("uni.example", "127.0.0.1:8080", "localhost"):
            for path in ("/lacoc/watch", "/watch"):
                assert ask(port, path, Host=host)[1].split()[0] == "/watch"
        assert ask(port, "/lacoc", Host="uni.example")[::2] == (307, "/lacoc/")
        status, said, _ = ask(port, "/watch", Host="other.example")
        assert status == 403
        assert 'pages = "http://other.example"' in said
        seen = {"Host": "other.example:8443", "X-Forwarded-Proto": "https"}
        assert 'pages = "https://other.example:8443"' in ask(port, "/watch", **seen)[1]


def test_only_the_own_pages_open_a_websocket() -> None:
    """The origin of the public address is let in, whatever a proxy writes into Host."""
    with served(PublicAddress.of(PAGES)) as port:
        at = "ws://{}:{}".format(*port.socket.getsockname())
        for origin in ("https://uni.example", at.replace("ws", "http")):
            with connect(f"{at}/lacoc/ws", origin=origin) as page:
                assert page.recv(LIMIT_S) == "/ws"
        with pytest.raises(InvalidStatus, match="403"):
            connect(f"{at}/ws", origin="https://other.example")


def test_a_proxy_that_passes_no_websocket_is_told() -> None:
    """A usual request at the address of a WebSocket gets 426 and a reason; a wrong origin 403."""
    with served(PublicAddress.of(PAGES)) as port:
        status, said, _ = ask(port, "/ws", "POST", Origin="https://uni.example")
        assert status == 426
        assert "docs/online.md" in said
        status, said, _ = ask(port, "/ws", "POST", Origin="https://lacoc.example")
        assert status == 403
        assert "https://lacoc.example" in said


@pytest.mark.parametrize(("proxies", "seen"), [((), "127.0.0.1"), (("127.0.0.0/8",), "192.0.2.9")])
def test_only_a_named_proxy_says_who_asks(proxies: tuple[str, ...], seen: str) -> None:
    """`X-Forwarded-For` and `X-Forwarded-Proto` count only from a proxy that is named."""
    headers = {"X-Forwarded-For": "198.51.100.7, 192.0.2.9", "X-Forwarded-Proto": "https"}
    with served(PublicAddress.of(PAGES, proxies=proxies)) as port:
        scheme = "https" if proxies else "http"
        assert ask(port, "/watch", **headers)[1] == f"/watch {seen} {scheme}"


def sit_down(port: server.Port, machine: str) -> ClientConnection:
    """Open a WebSocket as a machine behind a proxy."""
    at = "ws://{}:{}/ws".format(*port.socket.getsockname())
    return connect(at, additional_headers={"X-Forwarded-For": machine})


def test_no_machine_takes_the_places_of_others(monkeypatch: pytest.MonkeyPatch) -> None:
    """A machine has its share of WebSockets; a further one is told why, and others come in."""
    monkeypatch.setattr(guard, "SOCKETS_MOST", 3)

    async def held(scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "websocket":
            await send({"type": "websocket.accept"})
            while (await receive())["type"] != "websocket.disconnect":
                pass

    public = PublicAddress.of(PAGES, proxies=["127.0.0.1"])
    with served(public, held) as port, contextlib.ExitStack() as stack:
        pages = [stack.enter_context(sit_down(port, "192.0.2.1")) for _ in range(3)]
        with pytest.raises(InvalidStatus) as refused:
            sit_down(port, "192.0.2.1")
        assert refused.value.response.status_code == 429
        assert ask(port, "/ws", "POST", **{"X-Forwarded-For": "192.0.2.1"})[0] == 429
        stack.enter_context(sit_down(port, "192.0.2.2"))
        pages[0].close()
        until(lambda: ask(port, "/ws", "POST", **{"X-Forwarded-For": "192.0.2.1"})[0] == 426)
        stack.enter_context(sit_down(port, "192.0.2.1"))
        for _ in range(5):  # this machine itself, or a proxy here that nobody named
            stack.enter_context(sit_down(port, "127.0.0.1"))


def test_a_machine_holds_only_so_many_connections(monkeypatch: pytest.MonkeyPatch) -> None:
    """A further connection is closed at once, unless a proxy asks for others."""
    monkeypatch.setattr(page_socket, "CONNECTIONS_MOST", 3)
    monkeypatch.setattr(page_socket, "is_loopback", lambda _: False)

    def is_taken(one: socket.socket) -> bool:
        one.sendall(b"GET /watch HTTP/1.1\r\nHost: localhost\r\n\r\n")
        try:
            return one.recv(100).startswith(b"HTTP/1.1 200")
        except ConnectionResetError:
            return False

    for proxies, taken in (((), 3), (["127.0.0.0/8"], 5)):
        with (
            served(PublicAddress.of(PAGES, proxies=proxies)) as port,
            contextlib.ExitStack() as stack,
        ):
            at = port.socket.getsockname()
            many = [stack.enter_context(socket.create_connection(at, LIMIT_S)) for _ in range(5)]
            assert sum(map(is_taken, many)) == taken


def serial(port: server.Port, authority: trustme.CA) -> str:
    """Return the serial number of the certificate that the gateway shows."""
    context = ssl.create_default_context()
    authority.configure_trust(context)
    raw = socket.create_connection(port.socket.getsockname(), LIMIT_S)
    with context.wrap_socket(raw, server_hostname="uni.example") as wrapped:
        found = wrapped.getpeercert()
        assert found is not None
        return str(found["serialNumber"])


def test_a_certificate_is_renewed_while_pages_are_served(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The next connection gets the newer certificate; half of a new pair changes nothing."""
    monkeypatch.setattr(server, "_RENEW_S", 0.05)
    authority = trustme.CA()
    pair = issue(tmp_path, authority, "uni.example")
    with served(PublicAddress.of(PAGES, *pair)) as port:
        first = serial(port, authority)
        pair.key.write_text("half a ")
        assert serial(port, authority) == first
        issue(tmp_path, authority, "uni.example")
        until(lambda: serial(port, authority) != first)


def test_a_certificate_is_read_again_only_if_it_changed(tmp_path: Path) -> None:
    """A wrong pair is refused each time that it changes, and said once."""
    pair = issue(tmp_path, trustme.CA(), "uni.example")
    certificate = Certificate(pair)
    assert certificate.renew() is False
    pair.certificate.write_text("no certificate")
    with pytest.raises(UserError, match="PEM"):
        certificate.renew()
    assert certificate.renew() is False
    other = issue(tmp_path, trustme.CA(), "uni.example")
    assert certificate.renew() is True
    assert other == pair


@pytest.mark.parametrize("which", ["missing", "swapped", "others"])
def test_a_wrong_certificate_is_said_at_once(tmp_path: Path, which: str) -> None:
    """A gateway does not begin with a certificate and a key that do not belong together."""
    pair = issue(tmp_path, trustme.CA(), "uni.example")
    (tmp_path / "other").mkdir()
    other = issue(tmp_path / "other", trustme.CA(), "uni.example")
    wrong = {
        "missing": Pair(tmp_path / "none.pem", pair.key),
        "swapped": Pair(pair.key, pair.certificate),
        "others": Pair(pair.certificate, other.key),
    }[which]
    with pytest.raises(UserError) as refused:
        server.listen(server.LOOPBACK, PublicAddress.of(PAGES, *wrong))
    assert refused.value.phrase.code == "public.wrong-certificate"
    assert str(wrong.certificate) in render(refused.value.phrase)


@pytest.mark.parametrize(
    ("given_as", "kept_as"),
    [
        ("https://Lacoc.Example.org", "https://lacoc.example.org"),
        ("https://lacoc.example.org:443/", "https://lacoc.example.org"),
        (" http://10.0.0.1:8080 ", "http://10.0.0.1:8080"),
        ("https://uni.example/a/b//", "https://uni.example/a/b"),
        ("http://[::1]:8080/", "http://[::1]:8080"),
        ("", ""),
    ],
)
def test_an_address_is_kept_in_one_form(given_as: str, kept_as: str) -> None:
    """Case, standard ports and a slash at the end make no difference."""
    public = PublicAddress.of(given_as)
    assert public.pages == kept_as
    assert public.origin == kept_as.removesuffix(public.path)


@given(st.text() | st.from_regex(_ADDRESS, fullmatch=True))
def test_no_address_breaks(text: str) -> None:
    """Any text is refused with a sentence, or is an address that means the same in its one form."""
    with contextlib.suppress(UserError):
        public = PublicAddress.of(text)
        assert PublicAddress.of(public.pages) == public
        assert public.pages == f"{public.origin}{public.path}"


def test_a_contest_file_says_how_its_pages_are_reached(tmp_path: Path) -> None:
    """All mistakes about the public address are told at once; files stand beside the file."""
    text = '[contest]\npages = "{}"\n{}\n[court.main]\narena = "othello"\n'
    file = tmp_path / "contest.toml"
    with pytest.raises(UserError) as refused:
        contests.loads(text.format("lacoc.example", 'proxies = ["caddy"]').encode(), file)
    said = str(refused.value)
    assert '"lacoc.example"' in said
    assert '"caddy"' in said
    more = 'certificate = "tls/a.pem"\nprivate_key = "/etc/b.pem"'
    public = contests.loads(text.format(PAGES, more).encode(), file).public
    assert (public.certificate, public.private_key) == (tmp_path / "tls/a.pem", Path("/etc/b.pem"))
    with pytest.raises(UserError, match="belong together"):
        contests.loads(text.format(PAGES, more.partition("\n")[0]).encode(), file)
