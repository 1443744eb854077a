"""Tests of services that start before their court, or while a killed court is started again."""

import threading
import time
from collections.abc import Callable

import pytest
from ports import free_port

from lacoc_client.play.asking import NoCourt, NotNow, Patience
from lacoc_shared.command import cli
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.session import NotConnected, Session, open_client, open_court


def coming(*errors: UserError) -> Callable[[], str]:
    """Return a function that raises these errors one after another, and then succeeds."""
    left = list(errors)

    def do() -> str:
        if left:
            raise left.pop(0)
        return "there"

    return do


def test_it_waits_and_says_why_once(capsys: pytest.CaptureFixture[str]) -> None:
    """A waiting service prints the reason for waiting, and prints each reason only once."""
    errors = (NotConnected("No link."), NotConnected("No link."), NoCourt("None."), NotNow("Soon."))
    assert Patience(60.0).until(coming(*errors)) == "there"
    assert capsys.readouterr().err.splitlines() == [
        f"{why} Waiting up to 60 s." for why in ("No link.", "None.", "Soon.")
    ]


@pytest.mark.parametrize(
    ("wait_s", "error"),
    [(None, NotConnected("No link.")), (0.0, NoCourt("None.")), (60.0, UserError("Wrong token."))],
    ids=["a person", "the time is over", "for good"],
)
def test_it_does_not_wait_in_vain(wait_s: float | None, error: UserError) -> None:
    """A service fails at once if --wait is not given, its time is over, or the token is wrong."""
    with pytest.raises(type(error), match=str(error)):
        Patience(wait_s).until(coming(error))


def test_who_asks_it_to_end_is_heard() -> None:
    """A waiting service stops as soon as it is asked to end."""
    with pytest.raises(KeyboardInterrupt):
        Patience(60.0, stopping=lambda: True).until(coming(NotConnected("No link.")))


def test_a_court_that_is_opened_later_is_found() -> None:
    """A client that waits connects over the real network as soon as a court is opened."""
    port = free_port()
    refused = threading.Event()
    courts: list[Session] = []

    def open_later() -> None:
        assert refused.wait(60)
        courts.append(open_court([f"127.0.0.1:{port}"]))

    def connect() -> Session:
        try:
            return open_client([f"127.0.0.1:{port}"], timeout_s=0.2)
        except NotConnected:
            refused.set()
            raise

    opener = threading.Thread(target=open_later)
    opener.start()
    with Patience(60.0).until(connect) as session:
        opener.join()
        assert session.links()
    courts[0].close()


@pytest.mark.parametrize(
    "words",
    [("bot", "straight", "--token", "x"), ("referee", "start", "--token", "x")],
    ids=["bot", "referee"],
)
def test_services_take_the_option(
    words: tuple[str, ...], capsys: pytest.CaptureFixture[str]
) -> None:
    """With --wait 2.5, `bot` and `referee` try for 2.5 s, and then fail with the usual error."""
    begin_s = time.monotonic()
    where = ("--connect", f"tcp/127.0.0.1:{free_port()}", "--wait", "2.5")
    assert cli.main([*words, *where]) == 2
    assert time.monotonic() - begin_s > 2.5
    note, error = capsys.readouterr().err.splitlines()
    assert note.startswith("No program answers at tcp/127.0.0.1:")
    assert error.startswith("Error: No program answers at tcp/127.0.0.1:")
