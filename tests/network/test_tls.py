"""Why a court with keys can't be entered: each case has a message that says what to do."""

import os
import re
import socket
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from datetime import timedelta
from pathlib import Path

import msgspec
import pytest
from court_stub import CourtStub
from keyed import KeyedCourt, keyed_file
from waiting import LIMIT_S, until

from lacoc_client.controller import Controller, Hold
from lacoc_server.doors.keys.certificates import LIFE, Authority, utc_now
from lacoc_shared.contest import entrances
from lacoc_shared.contest import file as contests
from lacoc_shared.contest.access import Access, invitation_text
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.session import open_client, open_court

SHORT_S = 0.3


@pytest.fixture(scope="module")
def keyed(tmp_path_factory: pytest.TempPathFactory) -> Iterator[KeyedCourt]:
    with KeyedCourt(keyed_file(tmp_path_factory.mktemp("keyed"))) as court:
        yield court


def refused(access: Access) -> str:
    """Return the message with which a connection fails."""
    with pytest.raises(UserError) as caught:
        open_client([access.connect], SHORT_S, access.credentials)
    return str(caught.value)


def test_the_right_invitation_gets_in(keyed: KeyedCourt) -> None:
    """An invitation works with the IP address and with the host name of the court."""
    port = keyed.address.rpartition(":")[2]
    for host in ("127.0.0.1", "localhost"):
        access = msgspec.structs.replace(keyed.people["left"], connect=f"tls/{host}:{port}")
        with open_client([access.connect], authority=access.authority) as session:
            assert session.ask("lacoc/main/sheet")


def test_a_court_that_comes_back_is_entered_again(tmp_path: Path) -> None:
    """After a restart of a court with keys, a controller takes its seat back by itself."""
    file = keyed_file(tmp_path)
    with ExitStack() as stack:
        with KeyedCourt(file) as court:
            address, left = court.address, court.people["left"]
            session = stack.enter_context(court.enter("left"))
            controller = Controller(session, "main", "left", left.token, "Ants")
            controller.join()
        until(lambda: controller.view.poll() or controller.view.silent_s(time.monotonic()) > 0.2)
        with KeyedCourt(file, address) as court:
            until(lambda: controller.poll(time.monotonic()) and court.inputs)
            until(lambda: controller.poll(time.monotonic()) and controller.hold is Hold.HELD)


def test_keys_of_another_contest(keyed: KeyedCourt, tmp_path: Path) -> None:
    """Whoever enters with another contest's invitation is warned that the court may be false."""
    other = contests.load(keyed_file(tmp_path))
    access = entrances.everybody(other, "main")["left"]
    why = refused(msgspec.structs.replace(access, connect=keyed.address))
    assert re.search(r"can't prove that it is the court.*Do not go on", why)


def test_a_name_that_is_not_in_the_certificate(keyed: KeyedCourt) -> None:
    """If a name is not in the certificate, the message says how an organiser adds it."""
    with _tunnel("127.0.0.2", int(keyed.address.rpartition(":")[2])) as port:
        there = msgspec.structs.replace(keyed.people["left"], connect=f"tls/127.0.0.2:{port}")
        assert "not made for the name 127.0.0.2" in refused(there)
        assert "lacoc contest keys --host 127.0.0.2" in refused(there)


@pytest.mark.parametrize(
    ("made", "said"),
    [
        (-LIFE - timedelta(days=2), r"has expired.*contest keys --renew"),
        (timedelta(days=3), r"not valid yet.*clock"),
    ],
)
def test_a_certificate_out_of_its_time(tmp_path: Path, made: timedelta, said: str) -> None:
    """A certificate that is expired or not valid yet gets a message about renewal or clocks."""
    file = keyed_file(tmp_path)
    folder = contests.load(file).keys
    assert folder is not None
    authority = Authority.new(utc_now() + made)
    pair = authority.issue(["127.0.0.1"], utc_now() + made)
    folder.ca.write_bytes(authority.pair().certificate)
    folder.certificate.write_bytes(pair.certificate)
    folder.private_key.write_bytes(pair.private_key)
    with KeyedCourt(file) as court:
        assert re.search(said, refused(court.people["left"]))


def test_keys_and_no_keys(keyed: KeyedCourt) -> None:
    """If only the court or only the client uses keys, the message says what is wrong."""
    left = keyed.people["left"]
    with CourtStub() as plain:
        there = plain.address.replace("tcp/", "tls/")
        assert "does not use encryption" in refused(msgspec.structs.replace(left, connect=there))
        assert "tls/127" in refused(msgspec.structs.replace(left, connect=plain.address))
    bare = Access(court="main", connect=keyed.address.replace("tls/", "tcp/"))
    assert re.search(r"only with an invitation.*--invitation", refused(bare))
    assert "--invitation" in refused(Access(court="main", connect=keyed.address))


def test_a_damaged_certificate_and_nobody_there(keyed: KeyedCourt) -> None:
    """A damaged certificate and a closed port each have their own message."""
    left = keyed.people["left"]
    damaged = left.ca.replace("BEGIN CERT", "BEGIN SERT")
    assert "damaged" in refused(msgspec.structs.replace(left, ca=damaged))
    by_mail = left.ca.replace("-----BEGIN", "\u2014\u2013BEGIN\u00a0")
    assert "damaged" in refused(msgspec.structs.replace(left, ca=by_mail))
    assert "No program answers" in refused(msgspec.structs.replace(left, connect="tls/127.0.0.1:1"))


def test_a_court_needs_keys_for_tls_and_tls_for_keys(keyed: KeyedCourt, tmp_path: Path) -> None:
    """A court at a TLS address needs keys, and a contest with keys needs TLS addresses."""
    with pytest.raises(UserError, match="lacoc contest keys"):
        open_court(["tls/127.0.0.1:0"])
    contest = keyed_file(tmp_path)
    contest.write_text(contest.read_text().replace('"127.0.0.1:0"', '"tcp/127.0.0.1:0"'))
    with pytest.raises(UserError, match=r"are encrypted.*Write tls/127"):
        contests.load(contest)


def test_passwords_are_on_disk_only_while_a_court_opens(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The file of passwords has mode 0600, and is deleted when the court is open."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "t"))
    (tmp_path / "t").mkdir()
    seen: list[tuple[str, int]] = []
    write = os.open

    def noted(path: str, flags: int, mode: int = 0o777, **more: int) -> int:
        seen.append((str(path), mode))
        return write(path, flags, mode, **more)

    file = keyed_file(tmp_path)
    monkeypatch.setattr(os, "open", noted)
    with KeyedCourt(file) as court, court.enter("left"):
        assert list((tmp_path / "t").iterdir()) == []
    assert [mode for path, mode in seen if path.endswith("users")] == [0o600]


def test_no_password_in_zenohs_own_log(keyed: KeyedCourt, tmp_path: Path) -> None:
    """Zenoh's log has no password and no token, even at level "trace"."""
    left = keyed.people["left"]
    invitation = tmp_path / "left.toml"
    invitation.write_text(invitation_text(left, "x"))
    code = (
        "import sys, pathlib; from lacoc_shared.contest.invitation import *\n"
        "from lacoc_shared.network.session import *\n"
        "left = read_invitation(pathlib.Path(sys.argv[1]))\n"
        "with open_client([left.connect], credentials=left.credentials) as session:\n"
        "    session.ask('lacoc/main/sheet')\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, str(invitation)],
        env=os.environ | {"RUST_LOG": "trace"},
        capture_output=True,
        timeout=LIMIT_S,
    )
    said = done.stdout + done.stderr
    assert done.returncode == 0, said
    assert b"DEBUG" in said
    assert left.credentials is not None
    assert left.credentials.password.encode() not in said
    assert left.token.encode() not in said


@contextmanager
def _tunnel(host: str, to_port: int) -> Iterator[int]:
    """Give a port at the address `host` that forwards connections to `to_port` of 127.0.0.1."""
    with ExitStack() as stack:
        door = stack.enter_context(socket.create_server((host, 0)))
        open_sockets: list[socket.socket] = []

        def carry(one: socket.socket, other: socket.socket) -> None:
            try:
                while data := one.recv(65_536):
                    other.sendall(data)
            except OSError:
                pass

        def accept() -> None:
            try:
                while True:
                    came, _ = door.accept()
                    gone = socket.create_connection(("127.0.0.1", to_port))
                    open_sockets.extend((came, gone))
                    for pair in ((came, gone), (gone, came)):
                        threading.Thread(target=carry, args=pair, daemon=True).start()
            except OSError:
                return

        threading.Thread(target=accept, daemon=True).start()
        yield door.getsockname()[1]
        for one in open_sockets:
            one.close()
