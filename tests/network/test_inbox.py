"""The court's inbox; each test passes the time as an argument."""

import secrets
from collections.abc import Sequence
from typing import Any

import msgspec
import pytest
from court_stub import HASHES, KEYS, SEATS, TOKENS, opened
from hypothesis import given
from hypothesis import strategies as st

from lacoc_server.doors.inbox import (
    COMMANDS_HZ,
    COMMANDS_PER_BEAT,
    LOOKED_AT_PER_BEAT,
    SEQ_JUMP_MAX,
    Inbox,
)
from lacoc_shared import seal
from lacoc_shared.codec import encode
from lacoc_shared.contest import tokens
from lacoc_shared.inputs import (
    HeardSeat,
    Input,
    JoinSeat,
    KeySeat,
    LeaveSeat,
    ReadySeat,
    SilentSeat,
)
from lacoc_shared.messages import (
    PROTOCOL,
    Command,
    Join,
    Joined,
    Refusal,
    SeatRequest,
    SentFile,
    TriedKey,
    TryOutRequest,
)
from lacoc_shared.messages.office import WAITING, Assigned, AssignedSeat
from lacoc_shared.mistakes import FileRefused, Mistake
from lacoc_shared.seat import FRESH_BEATS, RESTART_KEY
from lacoc_shared.words import Phrase, faults, render, say

LEFT, RIGHT = 0, 1
CONTEST_ROBOT = SentFile("hexapod.toml", b"the contest's robot")


def check_files(join: Join, held: JoinSeat | None) -> tuple[Join, tuple[Phrase, ...]]:
    if join.postures is not None and join.postures.data == b"wrong":
        mistake = Mistake(file=join.postures.name, found="wrong", expected="right", row=1)
        raise FileRefused([mistake, mistake])
    robot = join.robot or (held.robot if held is not None else CONTEST_ROBOT)
    notes = () if held is None else (say("note.files-kept", files=[robot.name]),)
    return msgspec.structs.replace(join, robot=robot), notes


class Court(Inbox):
    """An inbox that remembers, in place of a match, which seats are silent."""

    silent = (False, False)

    def beat(self, now_s: float, arrived: Sequence[Sequence[bytes]]) -> list[Input]:
        inputs = self.commands(now_s, arrived, self.silent)
        for item in inputs:
            if isinstance(item, SilentSeat | HeardSeat):
                left, right = self.silent
                now = isinstance(item, SilentSeat)
                self.silent = (now, right) if item.seat == LEFT else (left, now)
        return inputs


def make(**more: Any) -> Court:
    return opened(Court(KEYS, SEATS, check_files, secrets.token_bytes, **more))


def join_bytes(seat: int = LEFT, **changes: Any) -> bytes:
    name = ("Blue", "Red")[seat]
    fields = {"protocol": PROTOCOL, "token": TOKENS[SEATS[seat]], "name": name} | changes
    return encode(Join(**fields))


def take_seat(inbox: Inbox, seat: int = LEFT) -> Joined:
    assert isinstance(inbox.join(seat, join_bytes(seat)), JoinSeat)
    return inbox.seated(seat)


def command(
    joined: Joined,
    seq: int,
    key: int = 2,
    level: int = 1,
    seat: int = LEFT,
    match: int = 0,
    seen: int = 0,
) -> bytes:
    numbers = (joined.session, seq, level, key, match, seen)
    mac = seal.command_mac(joined.secret, KEYS.command(SEATS[seat]), *numbers)
    return encode(Command(*numbers, mac))


def request(joined: Joined, what: str, ready: bool = True, seat: int = LEFT, seq: int = 1) -> bytes:
    key = KEYS.request(SEATS[seat], what)
    mac = seal.request_mac(joined.secret, key, joined.session, seq, ready)
    return encode(SeatRequest(session=joined.session, seq=seq, ready=ready, mac=mac))


def try_out(joined: Joined, seq: int = 1, ticks: Sequence[int] = (), **changes: int) -> bytes:
    fields = {"first": 0, "until": 100} | changes
    asked = TryOutRequest(
        session=joined.session,
        seq=seq,
        drawn=False,
        keys=tuple(TriedKey(tick, 1, 2) for tick in ticks),
        mac=b"",
        **fields,
    )
    key = KEYS.request("left", "try")
    mac = seal.request_mac(joined.secret, key, joined.session, seq, *asked.sealed)
    return encode(msgspec.structs.replace(asked, mac=mac))


def refusals(inbox: Inbox, seat: int = LEFT) -> dict[str, int]:
    return inbox.health(0.0)[seat].refused


WELCOME = say("note.next-match")


def test_a_join_gives_a_session_only_when_the_match_has_taken_it_in() -> None:
    """A session begins when the match has accepted the join, not when the inbox has."""
    inbox = make()
    taken = inbox.join(LEFT, join_bytes(name="  Blue ", postures=SentFile("a.txt", b"x")))
    assert taken == JoinSeat(
        LEFT, "Blue", CONTEST_ROBOT, SentFile("a.txt", b"x"), None, HASHES["left"]
    )
    assert inbox.health(0.0)[LEFT].session == 0
    joined = inbox.seated(LEFT, (WELCOME,))
    assert joined.last_seq == 0
    assert joined.notes == (WELCOME,)
    assert inbox.health(0.0)[LEFT].session == joined.session
    assert inbox.health(0.0)[RIGHT].session == 0


def test_a_join_waits_while_its_files_are_weighed_in() -> None:
    """While files are weighed in, the inbox returns a function that gives the outcome later."""
    whole = Join(protocol=PROTOCOL, token="", name="Blue", robot=CONTEST_ROBOT)
    answers = [None, None, (whole, ())]
    inbox = opened(Inbox(KEYS, SEATS, lambda *_: answers.pop(0), secrets.token_bytes))
    later = inbox.join(LEFT, join_bytes())
    assert callable(later)
    assert later() is None
    taken = later()
    assert taken == JoinSeat(LEFT, "Blue", CONTEST_ROBOT, None, None, HASHES["left"])
    assert refusals(inbox) == {}


def test_a_mistake_that_takes_long_to_find_is_told() -> None:
    """A robot whose stand test ends in a mistake is refused when the stand test is over."""
    known = False

    def weigh(*_: object) -> None:
        if known:
            raise FileRefused([Mistake(file="robot.toml", found="a leap", expected="rest")])

    inbox = opened(Inbox(KEYS, SEATS, weigh, secrets.token_bytes))
    later = inbox.join(LEFT, join_bytes())
    assert callable(later)
    assert later() is None
    known = True
    refused = later()
    assert isinstance(refused, Refusal)
    assert [mistake.found for mistake in refused.mistakes] == ["a leap"]
    assert refusals(inbox) == {"bad-files": 1}


def test_a_join_is_weighed_in_with_what_the_seat_has() -> None:
    """The check of a join's files is also given the join that the seat has now.

    The notes of this check come before the notes of the match.
    """
    inbox = make()
    mine = SentFile("mine.toml", b"a robot of our own")
    inbox.hold([JoinSeat(LEFT, "Blue", mine, None, None, HASHES["left"]), None], has_begun=False)
    taken = inbox.join(LEFT, join_bytes())
    assert isinstance(taken, JoinSeat)
    assert taken.robot == mine
    notes = inbox.seated(LEFT, (WELCOME,)).notes
    assert notes == (say("note.files-kept", files=["mine.toml"]), WELCOME)
    assert take_seat(inbox, RIGHT).notes == ()


@pytest.mark.parametrize(
    ("payload", "code", "why"),
    [
        (join_bytes(token="guess"), "refused.wrong-token", "wrong-token"),
        (join_bytes(token=TOKENS["right"]), "refused.wrong-token", "wrong-token"),
        (join_bytes(protocol=PROTOCOL + 1), "refused.wrong-version", "wrong-version"),
        (encode({"protocol": 99, "something": "new"}), "refused.wrong-version", "wrong-version"),
        (join_bytes(name="   "), "refused.team-name", "bad-name"),
        (join_bytes(name="x" * 25), "refused.team-name", "bad-name"),
        (join_bytes(name="a\x1b[31m"), "refused.team-name", "bad-name"),
        (join_bytes(postures=SentFile("a.txt", b"wrong")), "refused.mistakes", "bad-files"),
        (join_bytes(robot=SentFile("x" * 101, b"")), "refused.file-name", "bad-name"),
        (join_bytes(robot=SentFile("\x1b[2J", b"")), "refused.file-name", "bad-name"),
        (b"\xc1", "refused.bad-join", "bad-bytes"),
        (b"x" * 70_000, "refused.bad-join", "bad-bytes"),
    ],
)
def test_a_join_is_refused_with_its_reason(payload: bytes, code: str, why: str) -> None:
    """A wrong join is refused with a reason and counted, and the seat's holder plays on."""
    inbox = make()
    holder = take_seat(inbox)
    refusal = inbox.join(LEFT, payload)
    assert isinstance(refusal, Refusal)
    assert (refusal.why.code, faults(refusal.why)) == (code, [])
    assert len(refusal.mistakes) == (2 if why == "bad-files" else 0)
    assert refusals(inbox) == {why: 1}
    assert inbox.beat(0.1, [[command(holder, 1)], []]) == [KeySeat(LEFT, 1, 1, 2)]


BROKEN = join_bytes(name="Blues", postures=SentFile("a.txt", b"wrong"))


def test_a_broken_file_keeps_nobody_out_of_a_match_that_is_on() -> None:
    """A join with bad files after a match began is accepted: the seat keeps its former files."""
    inbox = make()
    files = (SentFile("mine.toml", b"a robot"), SentFile("mine.txt", b"a gait"), None)
    inbox.hold([JoinSeat(LEFT, "Blue", *files, "older hash"), None], has_begun=True)
    assert inbox.join(LEFT, BROKEN) == JoinSeat(LEFT, "Blues", *files, HASHES["left"])
    notes = inbox.seated(LEFT).notes
    assert [note.code for note in notes] == ["note.files-refused", "mistake.line", "mistake.line"]
    assert refusals(inbox) == {"bad-files": 1}
    assert render(notes[0]).startswith("Your new files have 2 mistakes.")
    assert render(notes[1]) == "a.txt, row 1: found wrong, expected right"


def test_a_broken_file_is_refused_where_it_would_be_used() -> None:
    """Bad files before a match, or for a seat that nobody has, are refused."""
    inbox = make()
    taken = JoinSeat(LEFT, "Blue", CONTEST_ROBOT, None, None, HASHES["left"])
    inbox.hold([taken, None], has_begun=False)
    assert isinstance(inbox.join(LEFT, BROKEN), Refusal)
    inbox.hold([None, None], has_begun=True)
    assert isinstance(inbox.join(LEFT, BROKEN), Refusal)


def test_the_counts_of_refusals_are_the_teams_own() -> None:
    """Health counts the refusals of the team in a seat; `doors` counts all refusals of the seat."""
    inbox = make()
    take_seat(inbox)
    inbox.join(LEFT, b"nonsense")
    take_seat(inbox)
    assert refusals(inbox) == {"bad-bytes": 1}
    inbox.join(LEFT, join_bytes(name="Green"))
    inbox.seated(LEFT)
    assert refusals(inbox) == {}
    inbox.join(LEFT, b"nonsense")
    assert refusals(inbox) == {"bad-bytes": 1}
    assert inbox.doors()[LEFT].refused == {"bad-bytes": 2}


def test_a_seat_without_a_token_is_closed() -> None:
    """A seat that has no token in the contest can't be joined."""
    inbox = opened(Inbox(KEYS, SEATS, check_files, secrets.token_bytes), {})
    assert isinstance(inbox.join(LEFT, join_bytes(token="")), Refusal)


@pytest.mark.parametrize("other", ["planner", "Planner", " planner ", "рlаnner"])
def test_two_teams_of_one_name_are_told_apart(other: str) -> None:
    """The second team whose name looks like the first one's gets its seat added, at each join."""
    inbox = make()
    inbox.join(LEFT, join_bytes(name="planner"))
    assert inbox.seated(LEFT).notes == ()
    for _ in range(2):
        taken = inbox.join(RIGHT, join_bytes(RIGHT, name=other))
        assert isinstance(taken, JoinSeat)
        assert taken.team == f"{other.strip()} (right)"
        assert inbox.seated(RIGHT).notes[0] == say("note.renamed", name=taken.team)
        again = inbox.join(LEFT, join_bytes(name="planner"))
        assert isinstance(again, JoinSeat)
        assert again.team == "planner"
    long = inbox.join(RIGHT, join_bytes(RIGHT, name="p" * 24))
    assert isinstance(long, JoinSeat)
    assert long.team == "p" * 24
    inbox.left(RIGHT)
    inbox.left(LEFT)
    assert inbox.join(RIGHT, join_bytes(RIGHT, name="planner")) == JoinSeat(
        RIGHT, "planner", CONTEST_ROBOT, None, None, HASHES["right"]
    )


def test_joins_can_not_flood_the_reading_of_files() -> None:
    """Even with the right token, a seat may join only five times at once, then once a second."""
    inbox = make()
    inbox.beat(10.0, [[], []])
    answers = [inbox.join(LEFT, join_bytes()) for _ in range(50)]
    assert sum(isinstance(answer, JoinSeat) for answer in answers) == 5
    inbox.beat(12.0, [[], []])
    answers = [inbox.join(LEFT, join_bytes()) for _ in range(50)]
    assert sum(isinstance(answer, JoinSeat) for answer in answers) == 2


def test_the_same_token_takes_the_seat_over() -> None:
    """After a second join with the same token, commands of the first session are refused."""
    inbox = make()
    old = take_seat(inbox)
    inbox.beat(0.1, [[command(old, 5)], []])
    new = take_seat(inbox)
    assert new.last_seq == 5
    assert inbox.beat(0.2, [[command(old, 6), command(new, 6, key=3)], []]) == [
        KeySeat(LEFT, 6, 1, 3)
    ]
    assert refusals(inbox) == {"replaced": 1}
    refusal = inbox.ready(LEFT, request(old, "ready"))
    assert isinstance(refusal, Refusal)
    assert refusal.why == say("refused.replaced", seat="left")


def test_a_command_counts_once_and_its_repetition_is_a_sign_of_life() -> None:
    """A repeated command enters the match once, and each repeat is a sign of life."""
    inbox = make()
    joined = take_seat(inbox)
    assert inbox.beat(0.1, [[command(joined, 1)], []]) == [KeySeat(LEFT, 1, 1, 2)]
    for beat in range(200):
        assert inbox.beat(0.2 + beat * 0.02, [[command(joined, 1)], []]) == []
    assert refusals(inbox) == {}
    assert inbox.health(4.2)[LEFT].commands_hz == pytest.approx(50, abs=1)


def test_the_newest_restart_comes_before_the_newest_digit() -> None:
    """In each beat, a seat's newest [x] enters the match first, and then its newest digit."""
    inbox = make()
    joined = take_seat(inbox)
    keys = (3, RESTART_KEY, 1, RESTART_KEY, 4)
    sent = [command(joined, seq, key) for seq, key in enumerate(keys, 1)]
    assert inbox.beat(0.1, [sent, []]) == [
        KeySeat(LEFT, 4, 1, RESTART_KEY),
        KeySeat(LEFT, 5, 1, 4),
    ]
    later = [command(joined, 6, 7), command(joined, 7, RESTART_KEY)]
    assert inbox.beat(0.2, [later, []]) == [
        KeySeat(LEFT, 7, 1, RESTART_KEY),
        KeySeat(LEFT, 6, 1, 7),
    ]


def altered(payload: bytes, field: str, value: object) -> bytes:
    whole = msgspec.msgpack.decode(payload, type=Command)
    return encode(msgspec.structs.replace(whole, **{field: value}))


@pytest.mark.parametrize(
    ("field", "value", "why"),
    [
        ("session", 1, "unknown-session"),
        ("seq", 11, "bad-seal"),
        ("level", 0, "bad-seal"),
        ("key", 3, "bad-seal"),
        ("match", 1, "bad-seal"),
        ("seen", 1, "bad-seal"),
        ("mac", b"12345678", "bad-seal"),
        ("mac", b"", "bad-seal"),
        ("key", "2", "bad-bytes"),
    ],
)
def test_an_altered_command_is_refused(field: str, value: object, why: str) -> None:
    """A command is refused if any part of it was changed after it was sealed."""
    inbox = make()
    joined = take_seat(inbox)
    assert inbox.beat(0.1, [[altered(command(joined, 10), field, value)], []]) == []
    assert refusals(inbox) == {why: 1}


@pytest.mark.parametrize(
    ("seq", "level", "key", "why"),
    [
        (9, 1, 2, "old"),
        (1, 1, 2, "old"),
        (11, 2, 2, "out-of-range"),
        (11, 1, 11, "out-of-range"),
        (11, 1, -1, "out-of-range"),
        (-1, 1, 2, "out-of-range"),
        (2**60, 1, 2, "out-of-range"),
    ],
)
def test_a_sealed_command_that_makes_no_sense_is_refused(
    seq: int, level: int, key: int, why: str
) -> None:
    """A command that is old or out of range is refused and counted, though its seal is right."""
    inbox = make()
    joined = take_seat(inbox)
    inbox.beat(0.1, [[command(joined, 10)], []])
    assert inbox.beat(0.2, [[command(joined, seq, key, level)], []]) == []
    assert refusals(inbox) == {why: 1}


def test_a_frame_that_is_not_there_yet_is_refused() -> None:
    """A command that names a future frame is refused and counted."""
    inbox = make()
    joined = take_seat(inbox)
    inbox.links.begin(0.08, 1, 6)
    inbox.links.sent(0.08)
    inbox.links.begin(0.1, 1, 7)
    early = [command(joined, 1, match=1, seen=7), command(joined, 1, match=2, seen=0)]
    assert inbox.beat(0.1, [early, []]) == []
    negative = [command(joined, 1, match=-1), command(joined, 1, match=1, seen=-5)]
    assert inbox.beat(0.1, [negative, []]) == []
    assert refusals(inbox) == {"ahead": 2, "out-of-range": 2}
    key = KeySeat(LEFT, 1, 1, 2, seen=6)
    assert inbox.beat(0.1, [[command(joined, 1, match=1, seen=6)], []]) == [key]


def test_held_keys_obey_the_rules_of_the_beat_in_which_they_take_effect() -> None:
    """Of held keys that fall due in one beat, the newest [x] and the newest digit take effect."""
    inbox = make(most_delay_ms=400)
    joined = take_seat(inbox)

    def beat(number: int, *sent: bytes) -> list[Input]:
        inbox.links.begin(number * 0.02, 1, number)
        inputs = inbox.beat(number * 0.02, [sent, []])
        inbox.links.sent(number * 0.02 + 0.002)
        return inputs

    for number in range(300):
        assert beat(number, command(joined, 0, match=1, seen=max(0, number - 10))) == []
    assert inbox.links.delay_ms == 200
    seen = 298
    first = [command(joined, 1, 3, match=1, seen=seen), command(joined, 2, 4, match=1, seen=seen)]
    assert beat(300, *first) == []
    again = command(joined, 3, RESTART_KEY, match=1, seen=seen)
    assert beat(301, again, again) == []
    for number in range(302, 308):
        assert beat(number, command(joined, 3, RESTART_KEY, match=1, seen=number - 1)) == []
    assert beat(308) == [
        KeySeat(LEFT, 3, 1, RESTART_KEY, seen=seen, held=7),
        KeySeat(LEFT, 2, 1, 4, seen=seen, held=8),
    ]
    assert beat(309) == []
    health = inbox.health(6.2)[LEFT]
    assert (health.round_trip_p95_ms, health.late) == (pytest.approx(198), 0)


def test_a_command_for_another_seat_is_refused() -> None:
    """A command of one seat's session for the other seat is refused; the seat's holder plays on."""
    inbox = make()
    left, right = take_seat(inbox, LEFT), take_seat(inbox, RIGHT)
    forged = command(left, 1, seat=RIGHT)
    stolen = command(left, 1, seat=LEFT)
    assert inbox.beat(0.1, [[], [forged, stolen, command(right, 1, seat=RIGHT)]]) == [
        KeySeat(RIGHT, 1, 1, 2)
    ]
    assert refusals(inbox, RIGHT) == {"not-your-seat": 2}
    assert refusals(inbox, LEFT) == {}


def test_a_flood_is_capped_a_beat_and_a_second_and_the_newest_wins() -> None:
    """A flood on a seat is limited; its newest command takes effect and the other seat plays on."""
    inbox = make()
    left, right = take_seat(inbox, LEFT), take_seat(inbox, RIGHT)
    inbox.beat(0.0, [[], []])
    seq = 0
    for beat in range(1, 101):  # 2 s
        flood = [command(left, seq + n, key=n % 10) for n in range(1, 65)]
        seq += 64
        taken = inbox.beat(beat * 0.02, [flood, [command(right, beat, seat=RIGHT)]])
        assert taken == [KeySeat(LEFT, seq, 1, 64 % 10), KeySeat(RIGHT, beat, 1, 2)]
    health = inbox.health(2.0)[LEFT]
    heeded = 6400 - health.refused["flood"]
    assert 2 * COMMANDS_HZ <= heeded <= 2 * COMMANDS_HZ + COMMANDS_PER_BEAT
    assert refusals(inbox, RIGHT) == {}


def test_a_flood_of_rubbish_costs_a_fixed_amount() -> None:
    """Of 1,000 invalid messages in a beat, only a fixed number is read."""
    inbox = make()
    inbox.beat(5.0, [[b"rubbish"] * 1000, []])
    looked_at = LOOKED_AT_PER_BEAT
    assert refusals(inbox) == {"flood": 1000 - looked_at, "bad-bytes": looked_at}


def test_rubbish_of_others_takes_nothing_of_what_a_seat_may_send() -> None:
    """Invalid messages of others under a seat's name do not use up the seat's own limit."""
    inbox = make()
    joined = take_seat(inbox)
    other = take_seat(inbox, RIGHT)
    rubbish = [b"rubbish", command(other, 7), altered(command(joined, 9), "seq", 10), b""] * 15
    seq = 0
    for beat in range(1, 501):  # 10 s, 3,000 pieces of rubbish a second
        now_s, own = beat * 0.02, []
        if beat % 5 == 0:
            seq += 1
            own = [command(joined, seq)]
        taken = inbox.beat(now_s, [[*rubbish[:30], *own, *rubbish[30:]], []])
        assert [item for item in taken if isinstance(item, KeySeat)] == [
            KeySeat(LEFT, seq, 1, 2)
        ] * len(own)
        assert SilentSeat(LEFT) not in taken
    assert inbox.doors()[LEFT].heard == 100
    assert "flood" not in refusals(inbox)


def test_an_overheard_command_does_not_keep_a_seat_alive() -> None:
    """A seat whose controller is gone falls silent, even if others repeat its last command."""
    inbox = make()
    joined = take_seat(inbox)
    newest = b""
    for beat in range(1, 1001):
        inbox.links.begin(beat * 0.02, 1, beat)
        sent = []
        if beat <= 500 and beat % 5 == 0:  # ten a second, each names the newest frame
            newest = command(joined, 1, match=1, seen=beat - 1)
            sent = [newest]
        taken = inbox.beat(beat * 0.02, [[*sent, newest] if newest else [], []])
        inbox.links.sent(beat * 0.02)
        if SilentSeat(LEFT) in taken:
            break
    assert 500 + 50 < beat <= 500 + 50 + FRESH_BEATS
    assert refusals(inbox)["stale"] > 0
    assert inbox.beat((beat + 1) * 0.02, [[command(joined, 2, match=1, seen=beat - 1)], []]) == [
        HeardSeat(LEFT),
        KeySeat(LEFT, 2, 1, 2, seen=beat - 1),
    ]


def test_a_controller_that_gets_no_frames_is_not_believed_for_long() -> None:
    """A controller that always names the same frame counts as silent 6 s after that frame."""
    inbox = make()
    joined = take_seat(inbox)
    for beat in range(1, 1001):
        inbox.links.begin(beat * 0.02, 1, beat)
        if SilentSeat(LEFT) in inbox.beat(beat * 0.02, [[command(joined, 1, match=1)], []]):
            break
        inbox.links.sent(beat * 0.02)
    assert 0 < beat - FRESH_BEATS - 50 <= 2


def test_silence_is_reported_until_the_match_knows_it() -> None:
    """The inbox reports a seat as silent or heard whenever the match believes the opposite."""
    inbox = make()
    joined = take_seat(inbox)
    assert inbox.commands(5.0, [[], []], (False, False)) == [SilentSeat(LEFT)]
    assert inbox.commands(5.02, [[], []], (True, False)) == []
    assert inbox.commands(5.04, [[], []], (False, False)) == [SilentSeat(LEFT)]  # another match
    assert inbox.commands(5.06, [[command(joined, 1)], []], (True, False))[0] == HeardSeat(LEFT)
    assert inbox.commands(5.08, [[], []], (False, False)) == []
    inbox.left(LEFT)
    assert inbox.commands(5.1, [[], []], (True, False)) == []
    take_seat(inbox)
    assert inbox.commands(5.12, [[], []], (True, False)) == [HeardSeat(LEFT)]


def test_ready_can_not_flood_the_log() -> None:
    """A seat may say ready or take it back five times at once, and then once a second."""
    inbox = make()
    joined = take_seat(inbox)
    inbox.beat(10.0, [[], []])
    answers = [inbox.ready(LEFT, request(joined, "ready", n % 2 > 0, seq=n)) for n in range(1, 50)]
    assert sum(isinstance(answer, ReadySeat) for answer in answers) == 5
    assert isinstance(answers[-1], Refusal)
    assert answers[-1].why == say("refused.too-many-readys")
    inbox.beat(12.0, [[], []])
    answers = [inbox.ready(LEFT, request(joined, "ready", seq=n)) for n in range(50, 60)]
    assert sum(isinstance(answer, ReadySeat) for answer in answers) == 2


def test_a_seat_is_silent_after_a_second_and_heard_again() -> None:
    """Rules 3: a seat that is not heard for 1 s is silent, until its next command."""
    inbox = make()
    joined = take_seat(inbox)
    assert inbox.beat(1.0, [[], []]) == []
    assert inbox.beat(1.02, [[], []]) == [SilentSeat(LEFT)]
    assert inbox.beat(1.04, [[], []]) == []
    assert inbox.beat(5.0, [[command(joined, 0)], []]) == [HeardSeat(LEFT)]
    assert inbox.beat(6.02, [[], []]) == [SilentSeat(LEFT)]
    assert inbox.beat(7.0, [[command(joined, 1)], []]) == [
        HeardSeat(LEFT),
        KeySeat(LEFT, 1, 1, 2),
    ]


def test_refused_commands_are_no_sign_of_life() -> None:
    """A command that is refused is no sign of life."""
    inbox = make()
    joined = take_seat(inbox)
    bad = altered(command(joined, 1), "key", 5)
    assert inbox.beat(1.02, [[bad], []]) == [SilentSeat(LEFT)]


def test_a_late_beat_makes_nobody_silent() -> None:
    """After a stall of the court, waiting commands are read before a seat is called silent."""
    inbox = make()
    joined = take_seat(inbox)
    inbox.beat(0.5, [[command(joined, 1)], []])
    assert inbox.beat(9.0, [[command(joined, 1)], []]) == []


def test_ready_and_leave_are_proven_by_the_session() -> None:
    """Each ready and each leave needs its own seal, made with the secret of the seat's session."""
    inbox = make()
    joined = take_seat(inbox)
    assert inbox.ready(LEFT, request(joined, "ready")) == ReadySeat(LEFT, True)
    assert inbox.ready(LEFT, request(joined, "ready", False, seq=2)) == ReadySeat(LEFT, False)
    assert isinstance(inbox.ready(LEFT, request(joined, "leave")), Refusal)  # sealed for leave
    assert isinstance(inbox.ready(RIGHT, request(joined, "ready", seat=RIGHT)), Refusal)
    assert isinstance(inbox.leave(LEFT, b""), Refusal)
    assert inbox.leave(LEFT, request(joined, "leave", seq=3)) == LeaveSeat(LEFT)
    inbox.left(LEFT)
    assert inbox.beat(9.0, [[command(joined, 1)], []]) == []
    assert refusals(inbox) == {"bad-seal": 1, "bad-bytes": 1, "left": 1}
    assert not inbox.health(9.0)[LEFT].joined


def test_a_request_counts_once() -> None:
    """A ready or leave that is sent a second time is refused as old."""
    inbox = make()
    joined = take_seat(inbox)
    ready, taken_back = request(joined, "ready"), request(joined, "ready", False, seq=2)
    assert inbox.ready(LEFT, ready) == ReadySeat(LEFT, True)
    assert inbox.ready(LEFT, taken_back) == ReadySeat(LEFT, False)
    for heard in (ready, taken_back, request(joined, "ready", seq=0)):
        assert isinstance(inbox.ready(LEFT, heard), Refusal)
    assert isinstance(inbox.leave(LEFT, request(joined, "leave", seq=2)), Refusal)
    assert refusals(inbox) == {"old": 4}
    assert inbox.ready(LEFT, request(joined, "ready", seq=9)) == ReadySeat(LEFT, True)
    again = take_seat(inbox)
    assert isinstance(inbox.ready(LEFT, request(joined, "ready", seq=10)), Refusal)
    assert inbox.ready(LEFT, request(again, "ready")) == ReadySeat(LEFT, True)


def test_a_restarted_court_knows_its_seats() -> None:
    """A restarted court goes on with its seats' sequence numbers; older sessions are unknown."""
    before = make()
    old = take_seat(before)
    after = make(last_seqs={"left": 41}, joined=("left",))
    assert after.beat(100.0, [[command(old, 42)], []]) == []
    assert refusals(after) == {"unknown-session": 1}
    assert after.beat(101.1, [[], []]) == [SilentSeat(LEFT)]
    assert after.health(101.1)[LEFT].joined
    assert after.health(101.1)[LEFT].session == 0
    new = take_seat(after)
    assert new.last_seq == 41
    assert after.beat(101.2, [[command(new, 41), command(new, 42)], []]) == [
        HeardSeat(LEFT),
        KeySeat(LEFT, 42, 1, 2),
    ]


def test_a_seat_that_was_silent_at_the_kill_is_silent_until_it_is_heard() -> None:
    """A seat that was silent before a restart of the court stays silent until it is heard."""
    after = make(last_seqs={"left": 41}, joined=("left",))
    for now_s in (100.0, 100.5, 105.0):
        assert after.commands(now_s, [[], []], (True, False)) == []
    new = take_seat(after)
    taken = after.commands(105.1, [[command(new, 42)], []], (True, False))
    assert taken == [HeardSeat(LEFT), KeySeat(LEFT, 42, 1, 2)]


ARBITRARY = st.binary(max_size=200) | st.recursive(
    st.none() | st.booleans() | st.integers(-(2**63), 2**64 - 1) | st.floats() | st.text()
    | st.binary(),
    lambda inner: st.lists(inner, max_size=5) | st.dictionaries(st.text(max_size=8), inner),
    max_leaves=8,
).map(encode)  # fmt: skip


@given(st.lists(ARBITRARY, max_size=20))
def test_no_bytes_ever_raise(payloads: list[bytes]) -> None:
    """No bytes make the inbox raise an exception, and none enter the match."""
    inbox = make()
    assert inbox.beat(0.0, [payloads, payloads]) == []
    for payload in payloads:
        for judge in (inbox.join, inbox.ready, inbox.leave):
            assert isinstance(judge(LEFT, payload), Refusal)


@given(
    st.tuples(
        st.integers(-(2**63), 2**63), st.integers(-(2**63), 2**63), st.integers(-(2**63), 2**63)
    ),
    st.binary(max_size=40),
)
def test_no_numbers_ever_raise(numbers: tuple[int, int, int], mac: bytes) -> None:
    """A command with random numbers and a random seal has no effect."""
    inbox = make()
    joined = take_seat(inbox)
    assert inbox.beat(0.0, [[encode(Command(joined.session, *numbers, 0, 0, mac))], []]) == []


def team(name: str, seat: int) -> AssignedSeat:
    """Return a team in a seat; its token is its name."""
    return AssignedSeat(
        id=SEATS[seat],
        team=name,
        token_hashes=(tokens.new_token_hash(name),),
        robot=CONTEST_ROBOT,
        locomotion=SentFile("own.txt", b"frozen"),
    )


def assigned(left: AssignedSeat, right: AssignedSeat) -> Assigned:
    return Assigned(call="c", fixture=say("fixture.final", stage=None), seats=(left, right))


def why_refused(inbox: Inbox, token: str, seat: int = LEFT) -> tuple[str, bool]:
    refusal = inbox.join(seat, join_bytes(seat, token=token))
    assert isinstance(refusal, Refusal)
    assert faults(refusal.why) == []
    return refusal.why.code, refusal.again


def test_an_assigned_seat_opens_for_its_team_alone() -> None:
    """An assigned team gets its name and frozen files; the court's own tokens open nothing then."""
    inbox = make()
    ants, bees = team("Ants", LEFT), team("Bees", RIGHT)
    inbox.admit(assigned(ants, bees), [])
    sent = join_bytes(token="Ants", name="X", postures=SentFile("a.txt", b"wrong"))
    taken = inbox.join(LEFT, sent)
    (ants_hash,) = ants.token_hashes
    assert taken == JoinSeat(LEFT, "Ants", CONTEST_ROBOT, None, ants.locomotion, ants_hash)
    assert inbox.seated(LEFT).notes == (say("note.files-frozen"),)
    assert isinstance(
        inbox.join(LEFT, join_bytes(token="Ants", locomotion=ants.locomotion)), JoinSeat
    )
    assert inbox.seated(LEFT).notes == ()
    assert why_refused(inbox, TOKENS["left"]) == ("refused.other-match", True)
    assert why_refused(inbox, "nobody") == ("refused.wrong-token", False)
    assert why_refused(inbox, "Bees") == ("refused.other-seat", True)
    assert refusals(inbox) == {"wrong-token": 1, "other-match": 2}


def test_sessions_of_other_teams_end_with_the_next_assignment() -> None:
    """A session ends when another team is assigned the seat; a team that stays keeps its own."""
    inbox = make()
    inbox.admit(assigned(team("Ants", LEFT), team("Bees", RIGHT)), [])
    joined = []
    for seat, name in enumerate(("Ants", "Bees")):
        inbox.join(seat, join_bytes(seat, token=name))
        joined.append(inbox.seated(seat))
    inbox.admit(assigned(team("Ants", LEFT), team("Cats", RIGHT)), [LEFT])
    assert isinstance(inbox.ready(LEFT, request(joined[LEFT], "ready")), ReadySeat)
    refusal = inbox.ready(RIGHT, request(joined[RIGHT], "ready", seat=RIGHT))
    assert refusal == Refusal(say("refused.other-match", seat="right"))
    assert [seat.joined for seat in inbox.health(0.0)] == [True, False]
    assert why_refused(inbox, "Bees", RIGHT) == ("refused.other-match", True)


NUMBERS = st.integers(-1, 2**64 - 1) | st.integers(SEQ_JUMP_MAX - 2, SEQ_JUMP_MAX + 2)


@given(st.lists(st.tuples(NUMBERS, NUMBERS, NUMBERS), max_size=8))
def test_no_team_can_silence_a_seat_for_the_next(sent: list[tuple[int, int, int]]) -> None:
    """Whatever a team sends, the next team of its seat plays with numbers from 1 on.

    So does a team that takes the seat over within the match, with the numbers that it is told.
    """
    inbox = make()
    inbox.admit(assigned(team("Ants", LEFT), team("Bees", RIGHT)), [])
    inbox.join(LEFT, join_bytes(token="Ants"))
    ants = inbox.seated(LEFT)
    inbox.links.begin(0.1, 1, 3)
    for seq, match, seen in sent:
        inbox.beat(0.1, [[command(ants, seq, match=match, seen=seen)], []])
    inbox.join(LEFT, join_bytes(token="Ants"))
    again = inbox.seated(LEFT)
    assert again.last_seq <= len(sent) * SEQ_JUMP_MAX
    key = KeySeat(LEFT, again.last_seq + 1, 1, 2)
    assert key in inbox.beat(0.2, [[command(again, key.seq)], []])
    inbox.admit(assigned(team("Cats", LEFT), team("Bees", RIGHT)), [])
    inbox.join(LEFT, join_bytes(token="Cats"))
    cats = inbox.seated(LEFT)
    assert cats.last_seq == 0
    assert KeySeat(LEFT, 1, 1, 2) in inbox.beat(0.3, [[command(cats, 1)], []])
    assert inbox.health(0.3)[LEFT].late == 0


def test_a_number_far_above_the_newest_is_refused() -> None:
    """A command may skip numbers, as those of keys that were lost, but only so many."""
    inbox = make()
    joined = take_seat(inbox)
    last = SEQ_JUMP_MAX
    assert inbox.beat(0.1, [[command(joined, last)], []]) == [KeySeat(LEFT, last, 1, 2)]
    assert inbox.beat(0.2, [[command(joined, 2 * last + 1)], []]) == []
    assert refusals(inbox) == {"out-of-range": 1}


def test_nobody_joins_while_the_court_waits() -> None:
    """While no match is assigned, each join is refused: the court waits for the office."""
    inbox = make()
    inbox.admit(WAITING, [])
    for token in (TOKENS["left"], "Ants"):
        assert why_refused(inbox, token) == ("refused.waits-for-office", True)
    opened(inbox)
    assert isinstance(inbox.join(LEFT, join_bytes()), JoinSeat)


def test_a_try_out_needs_the_seal_and_keys_in_their_order() -> None:
    """Only the seat's session asks, with rising ticks and a bounded number of pictures."""
    inbox = make()
    joined = take_seat(inbox)
    asked = inbox.try_out(LEFT, try_out(joined, ticks=[3, 9]))
    assert isinstance(asked, TryOutRequest)
    assert [key.tick for key in asked.keys] == [3, 9]
    forged = msgspec.structs.replace(joined, secret=bytes(16))
    wrong = [
        (try_out(forged, 2), "refused.bad-seal"),
        (try_out(joined, 1), "refused.request-old"),
        (try_out(joined, 3, [9, 9]), "refused.bad-request"),
        (try_out(joined, 4, until=151), "refused.bad-request"),
        (try_out(joined, 5, first=101), "refused.bad-request"),
        (try_out(joined, 6, first=3000, until=3000), "refused.bad-request"),
        (try_out(joined, 7, range(65)), "refused.bad-request"),
        (b"x" * 1025, "refused.bad-request"),
    ]
    for payload, code in wrong:
        refused = inbox.try_out(LEFT, payload)
        assert isinstance(refused, Refusal)
        assert refused.why.code == code


def test_a_try_out_makes_no_ready_an_old_one() -> None:
    """A request that overtakes another of another kind on the way refuses none of them."""
    inbox = make()
    joined = take_seat(inbox)
    assert isinstance(inbox.try_out(LEFT, try_out(joined, seq=2)), TryOutRequest)
    assert isinstance(inbox.ready(LEFT, request(joined, "ready", seq=1)), ReadySeat)
    again = inbox.ready(LEFT, request(joined, "ready", seq=1))
    assert isinstance(again, Refusal)
    assert again.why.code == "refused.request-old"


def test_try_outs_can_not_flood_a_court() -> None:
    """Six try-outs at once, then three a second; the seat is free to play meanwhile."""
    inbox = make()
    joined = take_seat(inbox)
    taken = [inbox.try_out(LEFT, try_out(joined, seq)) for seq in range(1, 9)]
    assert [isinstance(one, TryOutRequest) for one in taken] == [True] * 6 + [False] * 2
    assert taken[-1] == Refusal(say("refused.too-many-tries"), again=True)
    assert refusals(inbox) == {"flood": 2}
    assert isinstance(inbox.ready(LEFT, request(joined, "ready", seq=9)), ReadySeat)
    inbox.beat(1.0, [[], []])
    later = [inbox.try_out(LEFT, try_out(joined, seq)) for seq in range(10, 14)]
    assert [isinstance(one, TryOutRequest) for one in later] == [True] * 3 + [False]
