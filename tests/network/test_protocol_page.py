"""A program that uses only Zenoh can talk to a court as docs/protocol.md describes."""

import base64
import re
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
import trustme
import zenoh
from court_stub import CourtStub
from proxies import issue

from lacoc_shared.codec import decode, encode
from lacoc_shared.keyspace import JOIN_MAX_BYTES, KeySpace
from lacoc_shared.messages import Refusal
from lacoc_shared.network.session import Session, open_court
from lacoc_shared.words import say

PAGE = (Path(__file__).parents[2] / "docs" / "protocol.md").read_text(encoding="utf-8")
JOIN = KeySpace("main").request("left", "join")


def of_page(court: str, authority: bytes = b"") -> zenoh.Config:
    """Return the Zenoh configuration of docs/protocol.md for connecting to a court.

    Without an authority, the part for private ones is left out.
    """
    (text,) = re.findall(r"```json5\n(.*?)```", PAGE, re.DOTALL)
    for there, here in (
        ("tls/court.example.org:7447", court),
        ("LS0tLS1CRUdJTi...", base64.b64encode(authority).decode()),
    ):
        assert text.count(there) == 1
        text = text.replace(there, here)
    if not authority:
        text = re.sub(r"  transport: \{.*", "}", text, flags=re.DOTALL)
    return zenoh.Config.from_json5(text)


@pytest.fixture
def court() -> Iterator[Session]:
    with open_court(["127.0.0.1:0"]) as session:
        yield session


@pytest.fixture
def stranger(court: Session) -> Iterator[zenoh.Session]:
    with zenoh.open(of_page(court.locators()[0])) as session:
        yield session


def ask(stranger: zenoh.Session, payload: bytes, timeout_s: float = 10.0) -> list[bytes | None]:
    """Ask to join; return the payload of each error reply, and None for each other reply.

    Zenoh may report "Timeout" twice: on the stranger's side and on the court's.
    """
    replies = stranger.get(JOIN, payload=payload, timeout=timeout_s)
    return [reply.err and reply.err.payload.to_bytes() for reply in replies]


@pytest.mark.slow
def test_a_stranger_enters_an_encrypted_court(tmp_path: Path) -> None:
    """The configuration of docs/protocol.md opens a court with a certificate."""
    authority = trustme.CA()
    with CourtStub(certificate=issue(tmp_path, authority, "127.0.0.1")) as court:
        with zenoh.open(of_page(court.address, authority.cert_pem.bytes())) as stranger:
            (error,) = ask(stranger, b"no join")
            assert error is not None
            assert decode(error, Refusal).why
        with pytest.raises(zenoh.ZError):
            zenoh.open(of_page(court.address, trustme.CA().cert_pem.bytes()))


def is_not_answered(stranger: zenoh.Session, payload: bytes) -> None:
    """Repeat a request until it reaches a desk, and check that nobody answers it."""
    end_s = time.monotonic() + 30
    while not (replies := ask(stranger, payload, 0.3)):
        assert time.monotonic() < end_s, "the desk did not become known"
    assert set(replies) == {b"Timeout"}


def test_what_comes_back(court: Session, stranger: zenoh.Session) -> None:
    """Requests get a refusal, "Timeout" or no reply, as the table in docs/protocol.md says."""
    assert ask(stranger, b"") == []
    desk = court.desk(JOIN, 4)
    is_not_answered(stranger, b"x")
    assert (request := desk.take()) is not None
    assert request.payload == b"x"
    replies = stranger.get(JOIN, payload=b"y", timeout=10.0)
    while (request := desk.take()) is None or request.payload == b"x":  # it was asked repeatedly
        pass
    refusal = encode(Refusal(say("refused.left", seat="left")))
    request.refuse(refusal)
    assert [r.err and r.err.payload.to_bytes() for r in replies] == [refusal]


def test_a_join_that_is_too_long_is_dropped(court: Session, stranger: zenoh.Session) -> None:
    """A join above the limit never reaches the court, and gets no refusal."""
    desk = court.desk(JOIN, 4)
    is_not_answered(stranger, bytes(JOIN_MAX_BYTES))
    assert desk.take() is not None
    while desk.take() is not None:  # it was asked more than once
        pass
    assert ask(stranger, bytes(JOIN_MAX_BYTES + 1)) == []
    assert set(ask(stranger, bytes(JOIN_MAX_BYTES + 5000), 0.3)) == {b"Timeout"}
    assert desk.take() is None
