"""Network sessions: addresses, clear errors, and processes that end without a hang."""

import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack

import pytest
from waiting import LIMIT_S, until

from lacoc_shared.keyspace import COMMAND_MAX_BYTES
from lacoc_shared.mistakes import UserError
from lacoc_shared.network import address
from lacoc_shared.network.session import NoReply, Refused, Session, TooLate, open_client, open_court


@pytest.fixture
def router() -> Iterator[Session]:
    with open_court(["127.0.0.1:0"]) as session:
        yield session


@pytest.mark.parametrize(
    ("text", "complete"),
    [
        ("192.168.1.5", "tcp/192.168.1.5:7447"),
        ("court.example.org:80", "tcp/court.example.org:80"),
        ("tls/localhost:7000", "tls/localhost:7000"),
        (" tcp/[::1]:7447 ", "tcp/[::1]:7447"),
        ("127.0.0.1:0", "tcp/127.0.0.1:0"),
    ],
)
def test_addresses_are_completed(text: str, complete: str) -> None:
    """An address may leave out the port and "tcp/"."""
    assert address.endpoint(text) == complete


@pytest.mark.parametrize(
    "text", ["", "a b", "http://x", "udp/x:1", "x:70000", "tcp/", "::1", "tcp/x:y", "x:٣"]
)
def test_what_is_no_address_is_said(text: str) -> None:
    """A text that is not an address is refused with a message."""
    with pytest.raises(UserError, match="is not an address"):
        address.endpoint(text)


def test_a_court_learns_its_free_port(router: Session) -> None:
    """A court that listens on port 0 can read which port it got."""
    (locator,) = router.locators()
    assert int(locator.rpartition(":")[2]) > 0
    with open_client([locator]):
        pass


def test_a_port_in_use_is_said(router: Session) -> None:
    """A court whose port is in use gets a message that says so."""
    with pytest.raises(UserError, match=r"Port \d+ is in use"):
        open_court(router.locators())


def test_an_address_that_is_not_ours_is_said() -> None:
    """A court that listens at another machine's address gets a message that says so."""
    with pytest.raises(UserError, match=r"does not have the address 192\.0\.2\.1"):
        open_court(["192.0.2.1:0"])


def test_where_nobody_listens_is_said() -> None:
    """A client gets the message "No program answers" for a closed port."""
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    with pytest.raises(UserError, match="No program answers at tcp/127"):
        open_client([f"127.0.0.1:{port}"], timeout_s=0.2)


def test_the_first_address_that_answers_is_used(router: Session) -> None:
    """A court that goes on at its second address is found there, also by who comes later."""
    with open_client(["tcp/127.0.0.1:1", *router.locators()]) as client:
        assert client.links()


def test_another_program_at_the_address_is_said() -> None:
    """A client gets a message if another program than a court listens at the address."""
    with socket.create_server(("127.0.0.1", 0)) as other:
        port = other.getsockname()[1]
        with pytest.raises(UserError, match="it refuses the connection"):
            open_client([f"127.0.0.1:{port}"], timeout_s=0.2)


def test_an_unknown_host_is_said() -> None:
    """A client gets a message that the name of a host is not known."""
    with pytest.raises(UserError, match=r"court\.invalid.* is not known"):
        open_client(["court.invalid:7447"], timeout_s=30)


def test_requests_are_answered_refused_or_in_vain(router: Session) -> None:
    """A request raises NoReply if no desk gets it, and TooLate if the answer takes too long."""
    desk = router.desk("lacoc/main/sheet", 1)
    with open_client(router.locators()) as client:

        def is_late() -> bool:
            """Send a request that gets no answer; return whether it reached a desk."""
            try:
                client.ask("lacoc/main/sheet", timeout_s=0.05)
            except NoReply as error:
                return isinstance(error, TooLate)
            raise AssertionError("nobody answers here")

        until(is_late)
        until(desk.take)
        with pytest.raises(NoReply) as nobody:
            client.ask("lacoc/main/scene", timeout_s=60.0)
        assert not isinstance(nobody.value, TooLate)
    with pytest.raises(NoReply):
        router.ask("lacoc/nothing")


def test_a_request_whose_asker_is_gone_can_be_answered(router: Session) -> None:
    """The court can answer a request whose client has ended."""
    desk = router.desk("lacoc/main/sheet", 1)
    arrived = []
    with open_client(router.locators()) as client:

        def arrives() -> bool:
            """Send a request and give up soon; return whether the desk has received any request."""
            with pytest.raises(NoReply):
                client.ask("lacoc/main/sheet", timeout_s=0.02)
            arrived.extend(filter(None, [desk.take()]))
            return bool(arrived)

        until(arrives)
    arrived[0].reply(b"too late")


def test_refusals_carry_their_payload(router: Session) -> None:
    """A refusal raises Refused with the payload of the court."""
    desk = router.desk("lacoc/main/referee/*", 4)
    code = (
        "import sys; from lacoc_shared.network.session import *\n"
        "with open_client([sys.argv[1]]) as c:\n"
        "    try: c.ask('lacoc/main/referee/start', b'please')\n"
        "    except Refused as refused: print(refused.payload)\n"
    )
    with _python(code, router.locators()[0]) as process:
        request = None
        while request is None:
            request = desk.take()
            time.sleep(0.001)
        assert (request.key, request.payload) == ("lacoc/main/referee/start", b"please")
        request.refuse(b"no")
        out, _ = process.communicate(timeout=LIMIT_S)
    assert out == "b'no'\n"
    assert issubclass(Refused, Exception)


def test_a_request_to_many_is_not_served(router: Session) -> None:
    """A request with a wildcard in its key expression reaches no desk."""
    left, right = (router.desk(f"lacoc/main/seat/{seat}/join", 4) for seat in ("left", "right"))
    with open_client(router.locators()) as client, pytest.raises(NoReply):
        client.ask("lacoc/main/seat/*/join", b"me", timeout_s=0.1)
    assert left.take() is None
    assert right.take() is None


def test_too_long_a_command_does_not_arrive(router: Session) -> None:
    """A command above 1 KiB is dropped, and the connection stays open."""
    ring = router.ring("lacoc/main/seat/left/key", 8)
    with open_client(router.locators()) as client:
        door = client.publisher("lacoc/main/seat/left/key")
        for size in (COMMAND_MAX_BYTES + 1, 60_000, 3_000_000):
            door.put(bytes(size))
        arrived: list[bytes] = []

        def one_arrives() -> bool:
            door.put(bytes(COMMAND_MAX_BYTES))  # dropped while 3 MB are on their way
            arrived.extend(filter(None, [ring.take()]))
            return bool(arrived)

        until(one_arrives)
    assert [len(payload) for payload in arrived] == [COMMAND_MAX_BYTES]


def test_a_mailbox_keeps_the_newest(router: Session) -> None:
    """A mailbox for one message keeps the newest one."""
    frames = router.publisher("lacoc/main/frame")
    with open_client(router.locators()) as client:
        newest, every = client.mailbox("lacoc/main/frame", 1), client.mailbox("lacoc/*/frame", 99)
        until(lambda: frames.put(b"first") or every.wait(0.01))
        for number in range(20):
            frames.put(b"%d" % number)
        last = b""
        while last != b"19":
            assert every.wait(5.0)
            mail = every.take()
            last = mail.payload if mail else last
        mail = newest.take()
        assert mail is not None
        assert mail.payload == b"19"
        assert newest.take() is None
        assert not newest.wait(0.01)


def test_presence_is_seen(router: Session) -> None:
    """A client sees that the court is present, and no client can announce another court."""
    router.announce("lacoc/main/live/court")
    with open_client(router.locators()) as client, open_client(router.locators()) as forger:
        forger.announce("lacoc/forged/live/court")
        with pytest.raises(NoReply):  # returns when the announcement above was handled
            forger.ask("lacoc/main/sheet")
        assert client.present("lacoc/*/live/court") == ("lacoc/main/live/court",)


def _python(code: str, *arguments: str) -> "subprocess.Popen[str]":
    return subprocess.Popen(
        [sys.executable, "-c", code, *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


@pytest.mark.slow
@pytest.mark.parametrize("end", ["raise SystemError('oops')", "pass", "sys.exit(3)"])
def test_a_program_that_forgets_to_close_still_ends(router: Session, end: str) -> None:
    """A process that does not close its sessions still ends, with its own exit code."""
    code = (
        "import sys; from lacoc_shared.network.session import *\n"
        "client = open_client([sys.argv[1]]); client.mailbox('lacoc/main/frame', 1)\n"
        "client.mailbox('lacoc/main/event', 9)\n"
        "court = open_court(['127.0.0.1:0']); court.desk('lacoc/main/sheet', 1)\n"
        f"court.ring('lacoc/main/seat/left/key', 9); {end}"
    )
    frames = router.publisher("lacoc/main/frame")
    with _python(code, router.locators()[0]) as process:
        while process.poll() is None:
            frames.put(b"frame")
            time.sleep(0.001)
        _, errors = process.communicate(timeout=LIMIT_S)
    assert process.returncode == {"pass": 0, "sys.exit(3)": 3}.get(end, 1), errors
    assert ("oops" in errors) == ("oops" in end)


@pytest.mark.slow
def test_silent_connections_keep_nobody_out() -> None:
    """While 256 connections have sent two bytes and no more, a newcomer is let in."""
    with open_court(["127.0.0.1:0"]) as session, ExitStack() as stack:
        (locator,) = session.locators()
        _, _, place = locator.partition("/")
        host, _, port = place.rpartition(":")
        for _ in range(256):
            silent = stack.enter_context(socket.create_connection((host, int(port)), LIMIT_S))
            silent.sendall(b"\x01\x02")
        with open_client([place], LIMIT_S) as newcomer:
            until(newcomer.links)
