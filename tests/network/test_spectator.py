"""A spectator and a referee at a court for tests, over a real network."""

import threading
from contextlib import ExitStack

import pytest
from court_stub import KEYS, WHISTLE, CourtStub, make_event, make_scene
from waiting import until

from lacoc_client.play.asking import understand
from lacoc_client.play.referee import RefereeClient
from lacoc_client.play.spectator import Spectator
from lacoc_shared import decisions as d
from lacoc_shared.codec import decode, encode, message_hash
from lacoc_shared.inputs import Decide
from lacoc_shared.messages import Frame, Sheet
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.session import NoReply, Session, open_client
from lacoc_shared.words import say


def seen(spectator: Spectator, numbers: list[int]) -> None:
    until(lambda: spectator.wait_frame(1.0) and [e.number for e in spectator.events] == numbers)


def test_a_late_comer_is_complete_at_once(court: CourtStub, session: Session) -> None:
    """A spectator that connects late gets the sheet, the scene and all events so far."""
    for number in range(1, 301):
        court.network.publish_event(make_event(number))
    spectator = Spectator(session, "main")
    assert spectator.sheet.title == "Test"
    assert spectator.scene() == court.scene
    seen(spectator, list(range(1, 301)))
    court.network.publish_event(make_event(301))
    seen(spectator, list(range(1, 302)))
    assert [event.number for event in spectator.take_events()] == list(range(1, 302))
    assert spectator.take_events() == []


@pytest.mark.slow
def test_a_spectator_that_comes_while_events_are_sent_gets_them_all(court: CourtStub) -> None:
    """Spectators that connect while events are being published get each event once."""

    def send() -> None:
        for number in range(1, 301):
            court.network.publish_event(make_event(number))

    sending = threading.Thread(target=send)
    with ExitStack() as stack:
        sessions = [stack.enter_context(open_client([court.address])) for _ in range(20)]
        sending.start()
        spectators = [Spectator(session, "main") for session in sessions]
        sending.join()
        for spectator in spectators:
            seen(spectator, list(range(1, 301)))
            assert [event.number for event in spectator.take_events()] == list(range(1, 301))


def test_the_log_is_that_of_one_match(court: CourtStub, session: Session) -> None:
    """When the next match begins, the list of events begins again."""
    spectator = Spectator(session, "main")
    for event in (make_event(1), make_event(2), make_event(1, match=2)):
        court.network.publish_event(event)
    until(lambda: spectator.wait_frame(1.0) and [e.match for e in spectator.events] == [2])
    assert [event.match for event in spectator.take_events()] == [1, 1, 2]


@pytest.mark.slow
def test_what_a_restarted_court_sends_again_is_not_new() -> None:
    """Events that a restarted court publishes again are not taken as new."""
    with CourtStub() as first:
        address = first.address
        session = open_client([address])
        spectator = Spectator(session, "main")
        for number in (1, 2):
            first.network.publish_event(make_event(number))
        seen(spectator, [1, 2])
        spectator.take_events()
    with session:
        with CourtStub(address) as second:
            for number in (1, 2, 3):
                second.network.publish_event(make_event(number))
            seen(spectator, [1, 2, 3])
            assert [event.number for event in spectator.take_events()] == [3]
        with CourtStub(address) as third:
            third.network.publish_event(make_event(1, text="something else"))
            seen(spectator, [1])


def test_a_changed_scene_is_followed(court: CourtStub, session: Session) -> None:
    """When the scene changes, a spectator has the sheet and the scene that its frame names."""
    spectator = Spectator(session, "main")
    for name in ("one", "two", "three"):
        scene = make_scene(name)
        court.in_a_beat(lambda scene=scene: court.show(scene, title=scene.bodies[0].name))
        until(lambda name=name: spectator.wait_frame(1.0) and spectator.sheet.title == name)
        assert spectator.frame is not None
        assert spectator.frame.scene == spectator.sheet.scene == message_hash(encode(scene))
        assert spectator.scene() == scene


def test_a_court_whose_frames_do_not_fit_its_sheet_is_told_of(
    court: CourtStub, session: Session
) -> None:
    """If frames always name another scene than the sheet does, an error says so."""
    spectator = Spectator(session, "main")
    court.scene = make_scene("a scene that no sheet describes")
    with pytest.raises(UserError, match="do not fit the court's own description"):
        until(lambda: spectator.wait_frame(1.0) and False)
    court.network.publish_scene(court.scene)
    with pytest.raises(UserError, match="do not fit the court's own description"):
        spectator.scene()


def test_another_version_of_the_protocol_is_a_sentence(court: CourtStub, session: Session) -> None:
    """A court with another version of the protocol is refused with both version numbers."""
    court.in_a_beat(lambda: court.show(court.scene, protocol=99))
    until(lambda: decode(session.ask(KEYS.sheet), Sheet).protocol == 99)
    with pytest.raises(UserError, match=r"version 99 .* this program uses version 2"):
        Spectator(session, "main")


def test_events_that_nobody_takes_are_not_kept_for_ever(court: CourtStub, session: Session) -> None:
    """If no events are taken, only those of the current match and the last one are kept."""
    spectator = Spectator(session, "main")
    for match in range(1, 6):
        for number in (1, 2, 3):
            court.network.publish_event(make_event(number, match))
    until(lambda: spectator.wait_frame(1.0) and spectator.events[-1:] == (make_event(3, 5),))
    kept = [(event.match, event.number) for event in spectator.take_events()]
    assert kept == [(match, number) for match in (4, 5) for number in (1, 2, 3)]


def test_a_message_that_goes_astray_ends_nothing(court: CourtStub, session: Session) -> None:
    """A frame that can't be decoded is skipped, if the sheet has the same protocol version."""
    spectator = Spectator(session, "main")
    for _ in range(10):
        court.silent = True
        until(lambda: spectator.wait_frame(0.2) is None)
        court.in_a_beat(lambda: court.network.publish_frame(encode({"astray": 1}), 0.0))
        assert spectator.wait_frame(0.2) is None
        court.silent = False
        assert spectator.wait_frame(5.0)


def test_a_court_that_makes_no_sense_is_a_sentence(court: CourtStub, session: Session) -> None:
    """If no frame at all can be decoded, an error says so."""
    spectator = Spectator(session, "main")
    court.silent = True

    def speak() -> Frame | None:
        court.in_a_beat(lambda: court.network.publish_frame(b"\xc1", 0.0))
        return spectator.wait_frame(0.2)

    with pytest.raises(UserError, match="can't be read"):
        until(lambda: speak() and False)


def test_a_court_that_comes_back_with_another_version(court: CourtStub, session: Session) -> None:
    """If frames can't be decoded and the sheet has another version, an error has both versions."""
    spectator = Spectator(session, "main")
    assert spectator.wait_frame(1.0)
    court.in_a_beat(lambda: court.show(court.scene, protocol=99))
    until(lambda: decode(session.ask(KEYS.sheet), Sheet).protocol == 99)
    court.in_a_beat(lambda: court.network.publish_frame(encode({"version": 99}), 0.0))
    with pytest.raises(UserError, match=r"version 99 .* this program uses version 2"):
        until(lambda: spectator.wait_frame(1.0) and False)


def test_a_sheet_that_is_not_understood_is_a_sentence() -> None:
    """A sheet that can't be decoded raises a UserError."""
    with pytest.raises(UserError, match="can't be read"):
        understand(encode({"protocol": 1}), Sheet)


def test_a_request_where_no_court_is(court: CourtStub, session: Session) -> None:
    """A request to an unknown court gets no reply, and a spectator's error lists the courts."""
    with pytest.raises(NoReply):
        session.ask("lacoc/other/sheet")
    with pytest.raises(UserError, match=r'no court "other" .* The courts there: main'):
        Spectator(session, "other")


def test_nobody_but_the_court_sends_frames(
    court: CourtStub, session: Session, other_session: Session
) -> None:
    """A client can't publish frames, read commands, or answer requests to the referee's desk."""
    spectator = Spectator(session, "main")
    spied = session.mailbox("lacoc/main/seat/**", 10)
    for key in (KEYS.frame, KEYS.event, KEYS.sheet, KEYS.health):
        other_session.publisher(key).put(b"forged")
    desk = other_session.desk(KEYS.decision("*"), 4)
    other_session.publisher(KEYS.command("left")).put(b"rubbish")
    until(lambda: court.refused["left"].get("bad-bytes"))
    for _ in range(5):
        assert spectator.wait_frame(1.0)  # a forged frame could not be decoded
    assert spied.take() is None
    RefereeClient(session, "main", WHISTLE).decide(d.Start(), "", "Kubota")
    assert desk.take() is None


def test_the_referee_decides(court: CourtStub, session: Session) -> None:
    """A referee's decision enters the match with name and reason, and gets a reply."""
    reply = RefereeClient(session, "main", WHISTLE).decide(d.Start(), "all ready", "Kubota")
    assert reply.said == say("decision.start", seconds=3)
    assert court.inputs == [Decide("Kubota", "all ready", d.Start())]


def test_a_wrong_referee_token_is_refused(court: CourtStub, session: Session) -> None:
    """A decision with a wrong token is refused and counted, and does not enter the match."""
    with pytest.raises(UserError, match="not a referee's token"):
        RefereeClient(session, "main", "guess").decide(d.Start(), "", "K")
    assert court.network.dropped == {"wrong-token": 1}
    assert court.inputs == []


def test_health_reaches_everybody(court: CourtStub, session: Session) -> None:
    """A spectator receives the health of every seat."""
    spectator = Spectator(session, "main")
    until(lambda: spectator.wait_frame(1.0) and spectator.health)
    assert spectator.health is not None
    assert [seat.id for seat in spectator.health.seats] == ["left", "right"]


def test_a_silent_court_is_noticed(court: CourtStub, session: Session) -> None:
    """A spectator knows for how long the court has sent no frame."""
    spectator = Spectator(session, "main")
    assert spectator.wait_frame(1.0)
    court.silent = True
    until(lambda: spectator.wait_frame(0.05) is None)
    assert spectator.silent_s(spectator.frame_s + 3.0) == 3.0
