"""What `lacoc doctor` finds at the public address of a contest's pages."""

import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime, timedelta
from pathlib import Path

import proxies
import pytest
import trustme
from ports import free_port
from starlette.applications import Starlette
from starlette.routing import WebSocketRoute
from starlette.websockets import WebSocket
from waiting import LIMIT_S

from lacoc_client.commands.checks import pages as looks
from lacoc_client.commands.checks.machine import Finding, Status, web_port
from lacoc_client.commands.checks.pages import _reached, pages, plain_courts
from lacoc_client.web.gateway import server
from lacoc_client.web.gateway.files import PageFiles
from lacoc_client.web.gateway.health import GatewayHealth
from lacoc_client.web.gateway.site import page_routes
from lacoc_shared.contest import file as contests
from lacoc_shared.network.public import PublicAddress
from lacoc_shared.words import Phrase

pytestmark = pytest.mark.slow
TITLE = "Spring Cup"


async def _page(websocket: WebSocket) -> None:
    await websocket.accept()
    await websocket.receive()


@contextmanager
def gateway(public: PublicAddress, port: int, host: str = "127.0.0.1") -> Iterator[None]:
    """Serve the pages of a contest."""
    files, ended = PageFiles(), threading.Event()
    app = Starlette(routes=page_routes(files, ["/"], [WebSocketRoute("/ws", _page)], TITLE))
    with server.listen(f"{host}:{port}", public) as opened:
        thread = threading.Thread(target=server.serve, args=(app, opened, ended.is_set))
        thread.start()
        try:
            yield
        finally:
            ended.set()
            thread.join(LIMIT_S)


@pytest.fixture
def authority(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> trustme.CA:
    """Give an authority that this process trusts."""
    made = trustme.CA()
    made.cert_pem.write_to_path(str(tmp_path / "authority.pem"))
    monkeypatch.setenv("SSL_CERT_FILE", str(tmp_path / "authority.pem"))
    monkeypatch.setattr(looks, "_WAIT_S", LIMIT_S)  # a busy machine may answer late
    return made


def found(public: PublicAddress, title: str = TITLE) -> dict[str, Status]:
    """Return what is found, by the code of its phrase."""
    return {code(one): one.status for one in pages(public, title)}


def code(finding: Finding) -> str:
    assert isinstance(finding.found, Phrase)
    return finding.found.code.removeprefix("doctor.")


def test_a_right_address_is_ok(tmp_path: Path, authority: trustme.CA) -> None:
    """Name, certificate, pages and WebSocket are looked at; another contest there is a problem."""
    port = free_port()
    pair = proxies.issue(tmp_path, authority, "localhost")
    public = PublicAddress.of(f"https://localhost:{port}", *pair)
    with gateway(public, port):
        assert found(public) == dict.fromkeys(
            ("certificate-found", "pages-found", "websocket-found"), Status.OK
        )
        assert found(public, "Other Cup")["pages-another"] is Status.PROBLEM


@pytest.mark.skipif(sys.platform != "linux", reason="needs two addresses of this machine")
@pytest.mark.parametrize("encrypted", [False, True])
@pytest.mark.parametrize("host", ["0.0.0.0", "127.0.0.2"])
def test_a_gateway_is_asked_at_its_own_address(tmp_path: Path, host: str, encrypted: bool) -> None:
    """Doctor recognises a gateway that listens at one address only, or that is encrypted."""
    port = free_port()
    pair = proxies.issue(tmp_path, trustme.CA(), "uni.example")
    public = PublicAddress.of("https://uni.example", *pair) if encrypted else PublicAddress()
    with gateway(public, port, host):
        finding = web_port(host, port, needed=True)
    assert (code(finding), finding.status) == ("pages-run", Status.OK)


@pytest.mark.parametrize(
    ("issuer", "hours", "expected", "status"),
    [
        ("A University", 9, "certificate-hours", Status.NOTE),
        ("A University", 30, "certificate-found", Status.NOTE),
        ("Caddy Local Authority - ECC Intermediate", 9, "certificate-caddy", Status.OK),
    ],
)
def test_a_certificate_that_ends_soon_is_noted_unless_caddy_renews_it(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    issuer: str,
    hours: int,
    expected: str,
    status: Status,
) -> None:
    """Less than a day is told in hours; Caddy's own authority issues for hours only."""
    authority = trustme.CA(organization_name=issuer)
    authority.cert_pem.write_to_path(str(tmp_path / "authority.pem"))
    monkeypatch.setenv("SSL_CERT_FILE", str(tmp_path / "authority.pem"))
    port, end = free_port(), datetime.now(UTC) + timedelta(hours=hours)
    pair = proxies.issue(tmp_path, authority, "localhost", not_after=end)
    public = PublicAddress.of(f"https://localhost:{port}", *pair)
    with gateway(public, port):
        assert found(public)[expected] is status


def test_a_certificate_of_nobody_is_a_problem(tmp_path: Path) -> None:
    """A certificate that no browser trusts is said."""
    port = free_port()
    public = PublicAddress.of(
        f"https://localhost:{port}", *proxies.issue(tmp_path, trustme.CA(), "localhost")
    )
    with gateway(public, port):
        assert found(public) == {"pages-not-proven": Status.PROBLEM}


@pytest.mark.parametrize(
    ("address", "expected", "status"),
    [
        ("https://no.such.name.invalid", "pages-unknown", Status.PROBLEM),
        ("https://contest..example.org", "pages-unknown", Status.PROBLEM),
        ("http://127.0.0.1:{port}", "pages-silent", Status.NOTE),
    ],
)
def test_an_address_that_leads_nowhere_is_told(address: str, expected: str, status: Status) -> None:
    """An unknown name is a problem; before the contest it is normal that nobody answers."""
    public = PublicAddress.of(address.format(port=free_port()))
    assert found(public) == {expected: status}


def test_pages_without_the_promised_encryption_are_a_problem() -> None:
    """A gateway without a certificate behind an address with https:// is no silence."""
    port = free_port()
    with gateway(PublicAddress.of(f"http://localhost:{port}"), port):
        assert found(PublicAddress.of(f"https://localhost:{port}")) == {
            "pages-garbled": Status.PROBLEM
        }


def test_pages_of_another_program_hold_the_port() -> None:
    """A class, or another contest, at the port of the pages is told."""
    port = free_port()
    assert web_port("a..b", port, needed=True).status is Status.PROBLEM
    with gateway(PublicAddress.of(f"http://localhost:{port}"), port):
        for title, status in (("", Status.OK), (TITLE, Status.OK), ("Other Cup", Status.PROBLEM)):
            assert web_port("127.0.0.1", port, needed=True, title=title).status is status


@pytest.mark.parametrize("wrong", ["nothing", "unnamed", "host", "upgrade", "path"])
def test_what_is_wrong_with_a_proxy_is_said(
    tmp_path: Path, authority: trustme.CA, monkeypatch: pytest.MonkeyPatch, wrong: str
) -> None:
    """Each mistake in a proxy's settings is found by itself."""
    port, inner = free_port(), free_port()
    pair = proxies.issue(tmp_path, authority, "localhost")
    named = () if wrong == "unnamed" else ("127.0.0.1",)
    public = PublicAddress.of(f"https://localhost:{port}/lacoc", proxies=named)
    # All is on one machine here, so somebody far away is invented.
    text = (proxies.EXAMPLES / "nginx.conf").read_text("utf-8").replace("$remote_addr", "192.0.2.7")
    lines = {"host": "proxy_set_header Host", "upgrade": "proxy_set_header Upgrade"}
    kept = [line for line in text.splitlines() if lines.get(wrong, "no line") not in line]
    if wrong == "path":
        kept = [line.replace("location /lacoc/", "location /other/") for line in kept]
    (tmp_path / "nginx.conf").write_text("\n".join(kept))
    monkeypatch.setattr(proxies, "EXAMPLES", tmp_path)
    place = tmp_path / "proxy"
    place.mkdir()
    with (
        gateway(public, inner),
        proxies.nginx(place, pair, "localhost", port, f"127.0.0.1:{inner}"),
    ):
        seen = found(public)
    bad = {name for name, status in seen.items() if status is not Status.OK}
    assert (
        bad
        == {
            "nothing": set(),
            "unnamed": {"pages-proxy"},
            "host": {"pages-host"},
            "upgrade": {"websocket-none"},
            "path": {"pages-other"},
        }[wrong]
    )


@pytest.mark.parametrize(
    ("pages_at", "host", "replaced"),
    [
        ("https://[::1]:8443", "[::1]:8443", False),
        ("https://lacoc.example:8443", "LACOC.example.:8443", False),
        ("https://lacoc.example", "127.0.0.1:8080", True),
    ],
)
def test_a_replaced_host_is_known(pages_at: str, host: str, replaced: bool) -> None:
    """The host counts, however it is written; its port does not."""
    health = GatewayHealth(version="", contest="", host=host, unnamed_proxy=False)
    codes = [code(one) for one in _reached(PublicAddress.of(pages_at), "", health)]
    assert ("pages-host" in codes) == replaced


def test_courts_in_plain_text_are_noted(tmp_path: Path) -> None:
    """A court that others reach in plain text is noted, if the pages are encrypted."""
    text = '[contest]\npages = "{}"\n'
    for name, listen in (("open", "0.0.0.0:7447"), ("closed", "127.0.0.1:7448")):
        text += f'[court.{name}]\narena = "othello"\nlisten = ["{listen}"]\n'
    for address, noted in (("https://x.example", ["open"]), ("http://x.example", [])):
        plan = contests.loads(text.format(address).encode(), tmp_path / "contest.toml")
        notes = [*plain_courts(plan.public, plan.courts)]
        assert [
            one.about.values["court"] for one in notes if isinstance(one.about, Phrase)
        ] == noted
