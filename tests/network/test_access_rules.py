"""What a client may do at a court: watch and ask, but never speak for the court or overhear."""

from collections.abc import Iterator
from contextlib import ExitStack

import pytest
from court_stub import KEYS, TOKENS, CourtStub
from waiting import until

from lacoc_client.play.controller import Controller
from lacoc_client.play.spectator import Spectator
from lacoc_shared.codec import decode
from lacoc_shared.messages import Scene, Sheet
from lacoc_shared.network.session import Session, open_client


@pytest.fixture
def court() -> Iterator[CourtStub]:
    with CourtStub() as court:
        yield court


@pytest.fixture
def session(court: CourtStub) -> Iterator[Session]:
    with open_client([court.address]) as session:
        yield session


def test_everybody_watches(court: CourtStub, session: Session) -> None:
    """Every client receives frames, sheet, scene and health."""
    view = Spectator(session, "main")
    assert view.wait_frame(10) is not None
    assert view.scene() == court.scene
    until(lambda: view.poll() or view.health)


@pytest.mark.parametrize("what", ["frame", "event", "sheet", "health", "scene"])
def test_nobody_speaks_for_the_court(court: CourtStub, session: Session, what: str) -> None:
    """No client can publish, or answer requests, in the name of the court."""
    key = f"{KEYS.root}/{what}"
    with open_client([court.address]) as watching:
        box, court_box = watching.mailbox(key, 64), watching.mailbox(KEYS.frame, 1)
        session.publisher(key).put(b"forged")
        desk = session.desk(key, 4)
        session.announce("lacoc/forged/live/court")
        # Answered after all of the above.
        session.ask(KEYS.scene if what == "sheet" else KEYS.sheet)

        assert decode(watching.ask(KEYS.sheet), Sheet).court == "main"
        assert decode(watching.ask(KEYS.scene), Scene) == court.scene
        assert court_box.wait(10)
        heard = []
        while (mail := box.take()) is not None:
            heard.append(mail.payload)
        assert b"forged" not in heard
        assert desk.take() is None
        assert watching.present("lacoc/*/live/court") == (KEYS.alive,)


def test_nobody_hears_what_is_said_to_the_court(court: CourtStub, session: Session) -> None:
    """No client receives commands of others, not even with a subscription to everything."""
    boxes = [session.mailbox(key, 64) for key in (f"{KEYS.root}/seat/**", "lacoc/**", "**")]
    with ExitStack() as stack:
        sender = stack.enter_context(open_client([court.address]))
        controller = Controller(sender, "main", "left", TOKENS["left"], "Ants")
        controller.join()
        controller.press(1, 2)
        until(lambda: controller.poll(0.0) or court.keys(controller.index))
        session.ask(KEYS.sheet)  # everything that was sent before has passed
    assert [box.take() for box in boxes] == [None] * 3
