"""In a court with keys, each user has exactly the rights of its role."""

from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from court_stub import KEYS, SEEN, TOKENS, WHISTLE
from keyed import KeyedCourt, keyed_file
from waiting import until

from lacoc_client.controller import Controller
from lacoc_client.referee import RefereeClient
from lacoc_client.spectator import Spectator
from lacoc_shared.codec import decode, encode
from lacoc_shared.decisions import Start
from lacoc_shared.inputs import Decide, SilentSeat
from lacoc_shared.messages import Command, DecisionRequest, Scene, Sheet
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.access_rules import Credentials
from lacoc_shared.network.session import NoReply, Session, open_client
from lacoc_shared.seal import command_mac

EVERYBODY = ("left", "right", "referee", "gateway", "spectators")


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return keyed_file(tmp_path_factory.mktemp("keyed"))


@pytest.fixture
def court(file: Path) -> Iterator[KeyedCourt]:
    with KeyedCourt(file) as court:
        yield court


@pytest.fixture
def sessions(court: KeyedCourt) -> Iterator[dict[str, Session]]:
    with ExitStack() as stack:
        yield {who: stack.enter_context(court.enter(who)) for who in EVERYBODY}


def passed(session: Session) -> None:
    """Wait until the court's network has handled everything that the session sent before."""
    session.ask(KEYS.sheet)


def heard(court: KeyedCourt) -> int:
    """Return how many messages the court has accepted or refused."""
    refused = sum(sum(reasons.values()) for reasons in court.refused.values())
    told = [item for item in court.inputs if not isinstance(item, SilentSeat)]
    return len(told) + refused + sum(court.network.dropped.values())


@pytest.mark.parametrize("who", EVERYBODY)
def test_everybody_watches(court: KeyedCourt, sessions: dict[str, Session], who: str) -> None:
    """Every user receives frames, sheet, scene and health."""
    view = Spectator(sessions[who], "main")
    assert view.wait_frame(10) is not None
    assert view.scene() == court.scene
    until(lambda: view.poll() or view.health)


@pytest.mark.parametrize("seat", TOKENS)
def test_a_seat_is_steered_by_its_own_user(
    court: KeyedCourt, sessions: dict[str, Session], seat: str
) -> None:
    """A seat's own user can join, say ready, send keys and leave."""
    controller = Controller(sessions[seat], "main", seat, TOKENS[seat], "Ants")
    controller.join()
    controller.ready()
    controller.press(1, 2)
    until(lambda: controller.poll(0.0) or court.keys(controller.index))
    controller.leave()


@pytest.mark.parametrize("who", [one for one in EVERYBODY if one != "left"])
def test_a_seat_is_steered_by_nobody_else(
    court: KeyedCourt, sessions: dict[str, Session], who: str
) -> None:
    """Access rules keep other users from a seat, even if they have its token and its secret."""
    controller = Controller(sessions["left"], "main", "left", TOKENS["left"], "Ants")
    controller.join()
    joined = controller._joined
    assert joined is not None
    numbers = (joined.session, 7, 1, 2, 0, 0)
    mac = command_mac(joined.secret, KEYS.command("left"), *numbers)
    forged = encode(Command(*numbers, mac))

    sessions[who].publisher(KEYS.command("left")).put(forged)
    with pytest.raises(UserError, match="does not answer"):
        Controller(sessions[who], "main", "left", TOKENS["left"], "Thief").join(0.5)
    for what in ("ready", "leave"):
        with pytest.raises(NoReply):
            sessions[who].ask(KEYS.request("left", what), forged)
    passed(sessions[who])

    assert heard(court) == 1  # the join of its own user
    sessions["left"].publisher(KEYS.command("left")).put(forged)  # the same bytes, as a control
    until(lambda: court.keys() == [(7, 2)])


@pytest.mark.parametrize("who", [one for one in EVERYBODY if one != "referee"])
def test_only_the_referees_user_decides(
    court: KeyedCourt, sessions: dict[str, Session], who: str
) -> None:
    """Only the referee's user reaches the desk, and needs the referee's token there."""
    request = encode(DecisionRequest(token=WHISTLE, by="Kim", reason="", decision=Start()))
    for key in (KEYS.decision("start"), KEYS.outlook):
        with pytest.raises(NoReply):
            sessions[who].ask(key, request)
    assert heard(court) == 0

    referee = RefereeClient(sessions["referee"], "main", WHISTLE)
    referee.decide(Start(), "", "Kim")
    assert [type(one) for one in court.inputs] == [Decide]
    assert referee.look_ahead(None, 2.0) == SEEN
    assert len(court.inputs) == 1
    with pytest.raises(UserError, match="not a referee's token"):
        RefereeClient(sessions["referee"], "main", TOKENS["left"]).enter()


@pytest.mark.parametrize("who", EVERYBODY)
@pytest.mark.parametrize("what", ["frame", "event", "sheet", "health", "scene"])
def test_nobody_speaks_for_the_court(
    court: KeyedCourt, sessions: dict[str, Session], who: str, what: str
) -> None:
    """No user can publish, or answer requests, in the name of the court."""
    key = f"{KEYS.root}/{what}"
    watching = sessions["spectators" if who != "spectators" else "gateway"]
    box, court_box = watching.mailbox(key, 64), watching.mailbox(KEYS.frame, 1)
    forger = sessions[who]
    forger.publisher(key).put(b"forged")
    desk = forger.desk(key, 4)
    forger.announce("lacoc/forged/live/court")
    forger.ask(KEYS.scene if what == "sheet" else KEYS.sheet)  # answered after all of the above

    assert decode(watching.ask(KEYS.sheet), Sheet).court == "main"
    assert decode(watching.ask(KEYS.scene), Scene) == court.scene
    assert court_box.wait(10)
    heard = []
    while (mail := box.take()) is not None:
        heard.append(mail.payload)
    assert b"forged" not in heard
    assert desk.take() is None
    assert watching.present("lacoc/*/live/court") == (KEYS.alive,)


@pytest.mark.parametrize("who", EVERYBODY)
def test_nobody_hears_what_is_said_to_the_court(
    court: KeyedCourt, sessions: dict[str, Session], who: str
) -> None:
    """No user receives commands of other users, not even with a subscription to everything."""
    boxes = [sessions[who].mailbox(key, 64) for key in (f"{KEYS.root}/seat/**", "lacoc/**", "**")]
    sender = next(one for one in TOKENS if one != who)
    controller = Controller(sessions[sender], "main", sender, TOKENS[sender], "Ants")
    controller.join()
    controller.press(1, 2)
    until(lambda: controller.poll(0.0) or court.keys(controller.index))
    passed(sessions[who])
    assert [box.take() for box in boxes] == [None] * 3


def test_a_user_of_another_token_does_not_get_in(court: KeyedCourt, file: Path) -> None:
    """A wrong token, another person's token, an unknown user and an empty user are refused."""
    left, right = court.people["left"], court.people["right"]
    thief = left.of_seat("left", right.token)
    for access in (left.of_seat("left", "some other token"), thief, left.of_seat("top", "x" * 20)):
        with pytest.raises(UserError, match=r"does not accept this token.*invitation"):
            open_client([left.connect], 0.3, access.credentials)
    assert left.credentials is not None
    with pytest.raises(UserError, match="does not accept this token"):
        open_client([left.connect], 0.3, Credentials("", "", left.ca))


def test_a_password_says_nothing_of_others(court: KeyedCourt) -> None:
    """Users have different passwords, even with equal tokens, and none contains its token."""
    passwords = {who: access.credentials for who, access in court.people.items()}
    assert len({one.password for one in passwords.values() if one}) == len(EVERYBODY)
    same = court.people["left"].of_seat("right", TOKENS["left"]).credentials
    assert same is not None
    assert passwords["left"] is not None
    assert same.password != passwords["left"].password
    assert TOKENS["left"] not in passwords["left"].password
