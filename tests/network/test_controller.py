"""A controller at a court for tests, over a real network."""

import threading
import time
from typing import Any

import msgspec
import pytest
from court_stub import BOOK, KEYS, SEATS, SLOW, TOKENS, WRONG, CourtStub
from slow_link import SlowLink
from waiting import until

from lacoc_client.play.asking import NotNow
from lacoc_client.play.controller import Controller, Hold
from lacoc_client.web.gateway.seat_thread import SeatThread
from lacoc_robots.seat_files import SeatFiles, to_send
from lacoc_server.doors.network import CourtNetwork
from lacoc_shared import seal
from lacoc_shared.codec import encode
from lacoc_shared.contest.access import Access
from lacoc_shared.contest.tokens import new_token_hash
from lacoc_shared.inputs import HeardSeat, JoinSeat, LeaveSeat, ReadySeat, SilentSeat
from lacoc_shared.keyspace import JOIN_MAX_BYTES
from lacoc_shared.messages import Command, SentFile
from lacoc_shared.mistakes import FILES_REFUSED, FileRefused, UserError
from lacoc_shared.network.session import Session, open_client
from lacoc_shared.seat import RESTART_KEY
from lacoc_shared.words import render, say

FULL_DISK = say("record.no-room", file="m.mcap", why="disk full")


def controller(session: Session, seat: str = "left", **changes: object) -> Controller:
    values: dict[str, object] = {"token": TOKENS[seat], "team": "Blue"} | changes
    return Controller(session, "main", seat, **values)  # type: ignore[arg-type]


def held(session: Session, seat: str = "left") -> Controller:
    one = controller(session, seat)
    one.join()
    return one


def test_a_join_travels_with_its_files(court: CourtStub, session: Session) -> None:
    """A join brings the team's name and files to the court, and the reply brings notes."""
    file = SentFile("mine.txt", b"20 20")
    one = controller(session, postures=file)
    assert one.join() == (say("note.next-match"),)
    assert one.hold is Hold.HELD
    join = court.inputs[0]
    assert isinstance(join, JoinSeat)
    assert (join.seat, join.team, join.postures) == (0, "Blue", file)


def test_a_join_that_takes_long_to_weigh_in_holds_nobody_up(
    court: CourtStub, session: Session, other_session: Session
) -> None:
    """While a join is weighed in for twenty beats, the other seat can join."""
    one = controller(session, postures=SLOW)
    waiting = threading.Thread(target=one.join)
    waiting.start()
    until(lambda: court.scales.asked > 0)
    held(other_session, "right")
    waiting.join()
    assert one.hold is Hold.HELD
    assert court.scales.asked == 20
    assert [item.seat for item in court.inputs if isinstance(item, JoinSeat)] == [1, 0]


def test_a_join_may_be_large_but_not_too_large(court: CourtStub, session: Session) -> None:
    """A join up to the limit arrives; a larger one is refused before it is sent."""
    room = JOIN_MAX_BYTES - 1024
    small = len(encode(controller(session, postures=SentFile("a", b""))._join))
    controller(session, postures=SentFile("a", bytes(room - small - 4))).join()
    with pytest.raises(UserError, match="too large: 63 KiB"):
        controller(session, postures=SentFile("a", bytes(room))).join()


HELD = JoinSeat(0, "Blue", SentFile("r.toml", b""), SentFile("mine.txt", b"20"), None, "hash")


def test_refused_files_are_not_sent_again(court: CourtStub, session: Session) -> None:
    """If a controller's files were refused in a match, its next join has no files."""
    court.held[0] = HELD
    one = controller(session, postures=WRONG)
    assert one.join()[0].code == FILES_REFUSED
    one.join()
    first, second = (item for item in court.inputs if isinstance(item, JoinSeat))
    assert first.postures == HELD.postures
    assert second.postures is None


@pytest.mark.parametrize("is_on", [True, False])
def test_a_page_joins_with_a_broken_workbook(court: CourtStub, is_on: bool) -> None:
    """A broken workbook's mistake reaches the page: as a note in a match, else as a refusal."""
    court.held[0] = HELD if is_on else None
    answers: list[tuple[Any, Exception | None]] = []
    thread = SeatThread(
        Access(court="main", connect=court.address, seat="left", token=TOKENS["left"]),
        "Blue",
        lambda noted: to_send(SeatFiles(postures=BOOK), None, noted),
        lambda: 0.0,
        lambda _: None,
        lambda value, error: answers.append((value, error)),
    )
    until(lambda: answers)
    thread.end()
    thread.join(10)
    (value, error), *_ = answers
    if is_on:
        files, mistake, last = value["notes"]
        assert (files.code, files.values["count"]) == (FILES_REFUSED, 1)
        assert "mine.xlsx" in render(mistake)
        assert last == say("note.next-match")
    else:
        assert isinstance(error, FileRefused)
        assert [one.file for one in error.mistakes] == ["mine.xlsx"]


def test_a_wrong_token_is_refused_and_disturbs_nobody(
    court: CourtStub, session: Session, other_session: Session
) -> None:
    """A join with a wrong token is refused and counted, and the seat's holder plays on."""
    holder = held(session)
    with pytest.raises(UserError, match="not valid for the left seat"):
        controller(other_session, token="guess").join()
    holder.press(1, 2)
    until(lambda: holder.poll(time.monotonic()) and holder.round_trip_ms)
    assert holder.hold is Hold.HELD
    assert court.refused["left"] == {"wrong-token": 1}


def test_mistakes_in_files_come_back_whole(session: Session) -> None:
    """Rules 2: the reply to a join with wrong files lists every mistake."""
    with pytest.raises(FileRefused) as refused:
        controller(session, postures=WRONG).join()
    assert [mistake.found for mistake in refused.value.mistakes] == ["a", "b"]


def test_a_join_that_the_match_refuses_makes_no_session(court: CourtStub, session: Session) -> None:
    """If the match refuses a join, no session begins."""
    with pytest.raises(UserError, match="Join when the next match opens"):
        controller(session, team="Nobody").join()
    assert court.network.seat_health(0.0)[0].session == 0


def test_an_unknown_seat_and_an_unknown_court_are_named(session: Session) -> None:
    """The message about an unknown seat or court lists those that exist."""
    with pytest.raises(UserError, match=r'no seat "middle". Its seats are left and right'):
        Controller(session, "main", "middle", "t", "Blue")
    with pytest.raises(UserError, match=r'no court "mian" at .* The courts there: main'):
        Controller(session, "mian", "left", "t", "Blue")


def test_a_key_is_applied_once_and_its_round_trip_is_known(
    court: CourtStub, session: Session
) -> None:
    """A key whose command is repeated takes effect once, and its round trip is measured."""
    one = held(session)
    assert one.press(1, 2) == 1
    until(lambda: one.poll(time.monotonic()) and one.round_trip_ms is not None)
    assert one.round_trip_ms is not None
    assert 0 < one.round_trip_ms < 1000
    one.press(1, RESTART_KEY)
    seats = court.network.seat_health
    until(lambda: one.wait_frame(0.05) and seats(time.monotonic())[0].commands_hz >= 5)
    assert court.keys() == [(1, 2), (2, RESTART_KEY)]
    assert court.refused["left"] == {}


def test_a_refused_key_is_said_in_a_sentence(court: CourtStub, session: Session) -> None:
    """A controller reports each refused key once, with the reason."""
    one = held(session)
    one.press(1, 9)
    until(lambda: one.poll(time.monotonic()) and court.keys())
    until(lambda: one.wait_frame(1.0) and one.round_trip_ms is not None)
    (refused,) = one.take_refused()
    assert (refused.level, refused.key) == (1, 9)
    assert refused.why == say("key.no-such-key")
    assert one.take_refused() == []


def test_ready_and_leave(court: CourtStub, session: Session) -> None:
    """Ready and leave reach the match; after leaving, the controller sends no keys."""
    one = held(session)
    one.ready()
    one.ready(False)
    one.leave()
    assert court.inputs[-3:] == [ReadySeat(0, True), ReadySeat(0, False), LeaveSeat(0)]
    assert one.hold is Hold.LEFT
    with pytest.raises(UserError, match="You do not hold the left seat now"):
        one.press(1, 2)


def test_a_new_window_takes_over_and_the_old_one_knows(
    court: CourtStub, session: Session, other_session: Session
) -> None:
    """A second window with the same token takes the seat over, and the first one is told.

    Sequence numbers go on in the second window.
    """
    old = held(session)
    old.press(1, 2)
    until(lambda: court.keys() == [(1, 2)])
    new = held(other_session)
    assert new.press(1, 3) == 2
    until(lambda: old.wait_frame(1.0) and old.hold is Hold.REPLACED)
    assert old.link(time.monotonic()) == say("hold.replaced")
    until(lambda: court.keys() == [(1, 2), (2, 3)])
    for _ in range(20):
        new.wait_frame(1.0)
    assert new.hold is Hold.HELD


def test_one_health_of_another_session_is_not_believed(court: CourtStub, session: Session) -> None:
    """A controller believes that it was replaced only when two health messages in a row say so."""
    one = held(session)
    until(lambda: one.poll(time.monotonic()) and one.view.health)
    court.silent = True
    true = one.view.health
    assert true is not None
    others = tuple(msgspec.structs.replace(seat, session=7) for seat in true.seats)
    stale = msgspec.structs.replace(true, seats=others)
    for told in (stale, true, stale):
        court.in_a_beat(lambda told=told: court.network.publish_health(told))  # type: ignore[misc]
        until(lambda told=told: one.poll(0.0) or one.view.health == told)  # type: ignore[misc]
        assert one.hold is Hold.HELD
    court.in_a_beat(lambda: court.network.publish_health(stale))
    until(lambda: one.poll(0.0) or one.hold is Hold.REPLACED)


def test_a_refusal_says_whether_to_ask_again(court: CourtStub, session: Session) -> None:
    """A refusal says whether the same request may succeed later (`NotNow`) or never."""
    one = controller(session)
    court.trouble = FULL_DISK
    with pytest.raises(NotNow, match="Make room"):
        one.join()
    still = one.wait_frame(5.0)
    assert still
    court.trouble = None
    until(lambda: (frame := one.wait_frame(1.0)) and frame.beat > still.beat)  # beats pass again
    for _ in range(5):
        one.join()
    with pytest.raises(NotNow, match="You tried to join too often"):
        one.join()
    with pytest.raises(UserError, match="not valid for") as refused:
        controller(session, token="guess").join()
    assert not isinstance(refused.value, NotNow)


@pytest.mark.parametrize("seat", ["", "a//b", "le?ft", "#"])
def test_a_seat_that_is_no_key_is_said(court: CourtStub, session: Session, seat: str) -> None:
    """If a seat's name can't be part of a key expression, the refusal lists the court's seats."""
    with pytest.raises(UserError, match=r"has no seat .* Its seats are left and right"):
        Controller(session, "main", seat, "t", "Blue")


def test_forged_commands_are_refused_and_counted(
    court: CourtStub, session: Session, other_session: Session
) -> None:
    """The court refuses and counts a command for another seat, and bytes that are no command."""
    left, right = held(session, "left"), held(other_session, "right")
    left.press(1, 2)
    until(lambda: court.keys())
    joined = right._joined
    assert joined is not None
    numbers = (joined.session, 5, 1, 3, 0, 0)
    mac = seal.command_mac(joined.secret, KEYS.command("right"), *numbers)
    forged = encode(Command(*numbers, mac))
    door = other_session.publisher(KEYS.command("left"))
    door.put(forged)
    door.put(b"rubbish")
    door.put(bytes(2000))  # too long: the transport drops it
    until(lambda: court.refused["left"] == {"not-your-seat": 1, "bad-bytes": 1})
    assert court.keys() == [(1, 2)]


def test_a_flood_on_one_seat_does_not_touch_the_other(
    court: CourtStub, session: Session, other_session: Session
) -> None:
    """During a flood on one seat, all keys of the other take effect, half of them within 200 ms."""
    one = held(session, "right")
    flood = other_session.publisher(KEYS.command("left"))
    trips = []
    for _ in range(20):
        for _ in range(500):
            flood.put(b"flood")
        one.round_trip_ms = None
        one.press(1, 2)
        until(lambda: one.wait_frame(0.2) and one.round_trip_ms is not None)
        trips.append(one.round_trip_ms)
    assert [key for _, key in court.keys(seat=1)] == [2] * 20
    assert court.refused["left"]["bad-bytes"] > 0
    assert court.refused["right"] == {}
    assert sorted(trips)[10] < 200


@pytest.mark.slow
def test_a_controller_that_stops_is_silent_and_heard_again(
    court: CourtStub, session: Session
) -> None:
    """Rules 3: a seat that is not heard for 1 s is silent, until its controller sends again."""
    one = held(session)
    until(lambda: SilentSeat(0) in court.inputs)
    one.poll(time.monotonic())
    until(lambda: court.inputs[-1] == HeardSeat(0))


@pytest.mark.slow
def test_a_controller_repeats_its_command_while_it_waits(
    court: CourtStub, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A controller repeats its command at least 8 times a second while it asks what it missed.

    It asks for events and the sheet again and again, and an answer takes nearly a second here. If
    it repeated nothing while it waits, it would be heard less than twice a second.
    """
    with SlowLink(court.address, delay_s=0.45) as link, open_client([link.address]) as session:
        one = held(session)
        asked: list[str] = []
        begin = Session.question

        def question(self: Session, key: str, payload: bytes = b"", timeout_s: float = 5.0) -> Any:
            asked.append(key)
            return begin(self, key, payload, timeout_s)

        monkeypatch.setattr(Session, "question", question)
        monkeypatch.setattr(CourtNetwork, "newest_event", 99)
        monkeypatch.setattr(CourtNetwork, "sheet_hash", b"another!")
        seats = court.network.seat_health
        until(lambda: one.wait_frame(0.05) and min(map(asked.count, (KEYS.event, KEYS.sheet))) > 2)
        until(lambda: one.wait_frame(0.05) and seats(time.monotonic())[0].commands_hz >= 8)


@pytest.mark.slow
def test_a_controller_comes_back_after_a_restart_of_the_court() -> None:
    """After a restart of the court, a controller takes its seat back by itself.

    It goes on with its sequence numbers, and gives up if the court no longer takes the token.
    """
    with CourtStub() as first:
        address = first.address
        session = open_client([address])
        one = held(session)
        one.press(1, 2)
        until(lambda: one.wait_frame(1.0) and one.round_trip_ms is not None)
    with session:
        until(lambda: not one.wait_frame(0.1) and one.link(time.monotonic()))
        assert one.link(time.monotonic()).code == "hold.silent"
        with CourtStub(address, last_seqs={"left": 1}, joined=("left",)) as second:
            until(lambda: one.wait_frame(0.1) and second.network.seat_health(0.0)[0].session)
            assert one.hold is Hold.HELD
            assert one.link(time.monotonic()) is None
            assert second.keys() == []
            assert one.press(1, 3) == 2
            until(lambda: one.wait_frame(0.1) and second.keys() == [(2, 3)])
        full = CourtStub(address)
        full.trouble = FULL_DISK
        with full:
            until(lambda: one.wait_frame(0.1) and one.hold is Hold.LOST and one.reason)
            assert one.link(time.monotonic()) == full.trouble
            full.trouble = None
            until(lambda: one.wait_frame(0.1) and one.hold is Hold.HELD)
            assert one.reason is None
            assert one.press(1, 4) == 1  # this court has no record of the seat's earlier numbers
            until(lambda: one.wait_frame(0.1) and full.keys() == [(1, 4)])
        others = {seat: new_token_hash("another token") for seat in SEATS}
        with CourtStub(address, token_hashes=others):
            until(lambda: one.wait_frame(0.1) and one.hold is Hold.REFUSED)
            assert one.link(time.monotonic()) == say("refused.wrong-token", seat="left")
