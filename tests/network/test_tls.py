"""Encrypted courts: who gets in, and why somebody does not; each case says what to do."""

import re
import time
from collections.abc import Iterator
from contextlib import ExitStack
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest
import trustme
from court_stub import TOKENS, CourtStub
from proxies import issue
from waiting import until

from lacoc_client.play.controller import Controller, Hold
from lacoc_shared.mistakes import UserError
from lacoc_shared.network import address
from lacoc_shared.network.certificate import Pair
from lacoc_shared.network.session import open_client, open_court

SHORT_S = 0.3
NAMES = ("127.0.0.1", "localhost")
DAYS = timedelta(days=30)


def pem(authority: trustme.CA) -> str:
    return authority.cert_pem.bytes().decode()


@pytest.fixture(scope="module")
def authority() -> trustme.CA:
    return trustme.CA()


@pytest.fixture(scope="module")
def pair(authority: trustme.CA, tmp_path_factory: pytest.TempPathFactory) -> Pair:
    return issue(tmp_path_factory.mktemp("tls"), authority, *NAMES)


@pytest.fixture(scope="module")
def court(pair: Pair) -> Iterator[CourtStub]:
    with CourtStub(certificate=pair) as court:
        yield court


def refused(at: str, authority: str = "") -> str:
    """Return the message with which a connection fails."""
    with pytest.raises(UserError) as caught:
        open_client([at], SHORT_S, authority)
    return str(caught.value)


@pytest.fixture
def far(monkeypatch: pytest.MonkeyPatch) -> None:
    """Treat all addresses as those of other machines, whose names are checked."""
    monkeypatch.setattr(address, "is_own", lambda _: False)


@pytest.mark.usefixtures("far")
def test_who_knows_the_authority_gets_in(court: CourtStub, authority: trustme.CA) -> None:
    """The certificate holds for the IP address and for the host name of the court."""
    port = court.address.rpartition(":")[2]
    for host in NAMES:
        with open_client([f"tls/{host}:{port}"], authority=pem(authority)) as session:
            assert session.ask("lacoc/main/sheet")


def test_a_court_that_comes_back_is_entered_again(pair: Pair, authority: trustme.CA) -> None:
    """After a restart of an encrypted court, a controller takes its seat back by itself."""
    with ExitStack() as stack:
        with CourtStub(certificate=pair) as court:
            at = court.address
            session = stack.enter_context(open_client([at], authority=pem(authority)))
            controller = Controller(session, "main", "left", TOKENS["left"], "Ants")
            controller.join()
        until(lambda: controller.view.poll() or controller.view.silent_s(time.monotonic()) > 0.2)
        with CourtStub(at, pair) as court:
            until(lambda: controller.poll(time.monotonic()) and court.inputs)
            until(lambda: controller.poll(time.monotonic()) and controller.hold is Hold.HELD)


def test_another_authority_proves_nothing(court: CourtStub) -> None:
    """Whoever knows only public authorities, or another private one, is warned."""
    for other in ("", pem(trustme.CA())):
        assert re.search(
            r"can't prove that it is the court.*Do not go on", refused(court.address, other)
        )


def test_a_name_is_checked_unless_the_court_is_at_this_machine(
    tmp_path: Path, authority: trustme.CA, monkeypatch: pytest.MonkeyPatch
) -> None:
    """At an address of this machine a public certificate, which names no such address, will do."""
    with CourtStub(certificate=issue(tmp_path, authority, "lacoc.example.org")) as court:
        with open_client([court.address], authority=pem(authority)) as session:
            assert session.ask("lacoc/main/sheet")
        assert "can't prove" in refused(court.address, pem(trustme.CA()))
        monkeypatch.setattr(address, "is_own", lambda _: False)
        said = refused(court.address, pem(authority))
    assert "not made for the name 127.0.0.1" in said
    assert "lacoc contest certificate --host 127.0.0.1" in said


def test_which_addresses_are_of_this_machine() -> None:
    """A host name is none, except "localhost": others could make it lead anywhere."""
    assert all(map(address.is_own, ("127.0.0.1", "::1", "localhost", address.own_address())))
    assert not any(map(address.is_own, ("192.0.2.1", "2001:db8::1", "lacoc.example.org")))


@pytest.mark.parametrize(
    ("begins", "ends", "said"),
    [
        (-2 * DAYS, -DAYS, r"has expired.*lacoc contest certificate"),
        (DAYS, 2 * DAYS, r"not valid yet.*clock"),
    ],
)
def test_a_certificate_out_of_its_time(
    tmp_path: Path, authority: trustme.CA, begins: timedelta, ends: timedelta, said: str
) -> None:
    """A certificate that is expired or not valid yet gets a message about renewal or clocks."""
    now = datetime.now(UTC)
    wrong = issue(tmp_path, authority, *NAMES, not_before=now + begins, not_after=now + ends)
    with CourtStub(certificate=wrong) as court:
        assert re.search(said, refused(court.address, pem(authority)))


def test_encrypted_and_not_encrypted(court: CourtStub, authority: trustme.CA) -> None:
    """A court with a certificate has no plain door, and the message says how to write addresses."""
    place = court.address.partition("/")[2]
    assert [one.partition("/")[0] for one in court.network.locators] == ["tls"]
    assert f"Write tls/{place}" in refused(f"tcp/{place}")
    with CourtStub() as plain:
        there = plain.address.replace("tcp/", "tls/")
        assert "does not use encryption" in refused(there, pem(authority))


def test_a_damaged_authority_and_nobody_there(court: CourtStub, authority: trustme.CA) -> None:
    """A damaged certificate of an authority and a closed port each have their own message."""
    right = pem(authority)
    assert "damaged" in refused(court.address, right.replace("BEGIN CERT", "BEGIN SERT"))
    by_mail = right.replace("-----BEGIN", "\u2014\u2013BEGIN\u00a0")
    assert "damaged" in refused(court.address, by_mail)
    assert "No program answers" in refused("tls/127.0.0.1:1", right)


def test_a_court_needs_a_certificate_for_tls_and_tls_for_a_certificate(pair: Pair) -> None:
    """A court at a TLS address needs a certificate, and one with a certificate a TLS address."""
    with pytest.raises(UserError, match="lacoc contest certificate"):
        open_court(["tls/127.0.0.1:0"])
    with pytest.raises(UserError, match=r"are encrypted.*Write tls/127"):
        open_court(["tcp/127.0.0.1:0"], pair)
