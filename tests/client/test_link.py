"""Tests of links, and of what commands learn from the pages behind them."""

import contextlib
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

import pytest
import trustme
from hypothesis import given
from hypothesis import strategies as st
from proxies import issue
from starlette.applications import Starlette
from waiting import LIMIT_S

from lacoc_client.play.link.event import find
from lacoc_client.web.gateway import server
from lacoc_client.web.gateway.home import Home
from lacoc_client.web.gateway.site import event_route
from lacoc_shared.contest.link import Link
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.certificate import fingerprint
from lacoc_shared.network.public import PublicAddress

Told = Mapping[str, tuple[str, ...]]
COURTS: Told = {"red": ("tls/lacoc.example.org:7447",), "blue": ()}


def refused(code: str) -> pytest.RaisesExc[UserError]:
    """Return a context manager that expects an error with the phrase of this code."""
    return pytest.raises(UserError, check=lambda error: error.phrase.code == code)


@given(
    pages=st.sampled_from(
        ["http://192.168.1.20:8080", "https://lacoc.example.org", "https://uni.example/a/lacoc"]
    ),
    page=st.sampled_from(["", "play", "referee", "office"]),
    court=st.from_regex("[a-z0-9-]{0,12}", fullmatch=True),
    token=st.from_regex("[a-z2-7]{26}", fullmatch=True),
    authority=st.sampled_from(["", "ab" * 32]),
)
def test_a_link_is_read_as_it_was_made(
    pages: str, page: str, court: str, token: str, authority: str
) -> None:
    """Whatever a link says is read from it, also below a path."""
    link = Link(pages=pages, page=page, court=court, token=token, authority=authority)
    assert Link.read(f" {link.text}\n") == link
    assert token not in repr(link)


@given(st.text())
def test_no_text_breaks(text: str) -> None:
    """Any text is a link, or is told to be none."""
    with contextlib.suppress(UserError):
        Link.read(text)


@pytest.mark.parametrize(
    "text",
    ["", "lacoc.example.org", "ftp://a/b", "https://", "https://a:99999/", "https://u@a/play"],
)
def test_what_is_no_link_is_told(text: str) -> None:
    """The message does not repeat a token."""
    with pytest.raises(UserError) as caught:
        Link.read(f"{text}#token=secret")
    assert "secret" not in str(caught.value)


@contextmanager
def pages(
    public: PublicAddress | None = None, authority: str = "", told: Told = COURTS
) -> Iterator[str]:
    """Serve what commands read of an event; give the address of the pages."""
    home = Home(courts={}, told=told, authority=authority, contest="Cup")
    ended = threading.Event()
    with server.listen(server.LOOPBACK, public) as port:
        app = Starlette(routes=[event_route(home)])
        thread = threading.Thread(target=server.serve, args=(app, port, ended.is_set))
        thread.start()
        try:
            scheme = port.public.scheme
            yield f"{scheme}://127.0.0.1:{port.socket.getsockname()[1]}"
        finally:
            ended.set()
            thread.join(LIMIT_S)


def test_a_command_learns_where_the_courts_are() -> None:
    """Courts without an address for others are not named; with none at all this is told."""
    with pages() as address:
        found = find(f"{address}/play#token=abc")
        assert (found.event.name, found.courts) == ("Cup", {"red": COURTS["red"]})
        assert found.link.token == "abc"
    with pages(told={"blue": ()}) as address, refused("link.only-pages"):
        _ = find(address).courts


def test_only_the_own_authority_of_an_event_is_trusted(tmp_path: Path) -> None:
    """With a fingerprint in the link, the pages must prove that they are those of the link."""
    authority, other = trustme.CA(), trustme.CA()
    pair = issue(tmp_path, authority, "127.0.0.1")
    public = PublicAddress.of(certificate=pair.certificate, private_key=pair.key)
    own, foreign = (one.cert_pem.bytes().decode() for one in (authority, other))
    with pages(public, own) as address:
        assert find(f"{address}/#authority={fingerprint(own)}").event.authority == own
        with refused("link.other-authority"):
            find(f"{address}/#authority={fingerprint(foreign)}")
        with refused("link.no-pages"):
            find(address)  # nobody says that this authority can be trusted
    with pages(public, foreign) as address, refused("link.no-pages"):
        find(f"{address}/#authority={fingerprint(foreign)}")


def test_an_authority_that_somebody_adds_to_the_own_one_is_not_trusted(tmp_path: Path) -> None:
    """The fingerprint in the link names one certificate, and only this one is believed."""
    other = trustme.CA()
    pair = issue(tmp_path, other, "127.0.0.1")
    public = PublicAddress.of(certificate=pair.certificate, private_key=pair.key)
    foreign = other.cert_pem.bytes().decode()
    for _ in range(50):  # only behind some certificates another one can hide
        own = trustme.CA().cert_pem.bytes().decode()
        if own.rpartition("\n-----END")[0].endswith("="):
            break
    with pages(public, own + foreign) as address, refused("link.no-pages"):
        find(f"{address}/#authority={fingerprint(own)}")


def test_what_is_wrong_with_the_pages_is_told() -> None:
    """No pages, other pages, and pages of another version are told apart."""
    with refused("link.no-pages"):
        find("http://127.0.0.1:1/play#token=abc")
    with pages() as address, refused("link.no-event"):
        find(f"{address}/below")
