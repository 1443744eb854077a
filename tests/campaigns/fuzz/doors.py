"""A court that gets hostile packets: real network module, inbox, desk and match, but no Zenoh.

A second match, the twin, gets only inputs whose sender had the right to them: by a token, or by a
seal with the seat's secret. After every beat both matches must publish the same frame, bit for bit.
"""

import hashlib
from collections import deque
from collections.abc import Callable
from typing import Any

from stage import Stage

from lacoc_robots.library import find_robot, sample_gait_files
from lacoc_robots.limits import Limits
from lacoc_server.doors import network as court_network
from lacoc_server.doors.decision_desk import DecisionDesk
from lacoc_server.doors.inbox import Inbox
from lacoc_server.doors.network import Arrival, CourtNetwork
from lacoc_server.doors.sessions import Sessions, Why, _SeatHolder
from lacoc_server.match.entry import JoinCheck
from lacoc_shared import codec, seal
from lacoc_shared.decisions import DECISIONS, Adjust, Clock, Halt, Set, Start, TakeBack
from lacoc_shared.inputs import Decide, HeardSeat, JoinSeat, KeySeat, LeaveSeat, SilentSeat
from lacoc_shared.keyspace import KeySpace
from lacoc_shared.messages import (
    PROTOCOL,
    Command,
    DecisionReply,
    DecisionRequest,
    Done,
    Enter,
    Join,
    Joined,
    Refusal,
    SeatRequest,
    SentFile,
)
from lacoc_shared.messages.office import open_match
from lacoc_shared.seat import RESTART_KEY, Phase

KEYS = KeySpace("main")
SEATS = ("left", "right")
TOKENS = {"left": "the-left-team-has-this", "right": "the-right-team-has-this"}
REFEREE = "the-referee-has-this"
SESSIONS = (4_000_000_001, 4_000_000_002)
SECRETS = (b"left's secret...", b"right's secret..")
BATCH = 12
"""Packets that arrive together, before the court has its next beat."""
PHASES = (Phase.LOBBY, Phase.HALTED, Phase.PLAYING, Phase.READY, Phase.FINISHED)
_BEATS_A_MATCH = 1500


class StateChanged(AssertionError):
    """A message had an effect, though its sender had no right to it."""


class _Request:
    def __init__(self, key: str, payload: bytes) -> None:
        self.key, self.payload = key, payload
        self.answers: list[bytes] = []

    def reply(self, payload: bytes) -> None:
        self.answers.append(payload)

    def refuse(self, payload: bytes) -> None:
        codec.decode(payload, Refusal, 1 << 20)  # check that a client can read it
        self.answers.append(b"")


class _Queue:
    """A test's substitute for a ring or a desk: a queue of packets that have arrived."""

    def __init__(self, depth: int) -> None:
        self.waiting: deque[Any] = deque(maxlen=depth)

    def take(self) -> Any:
        return self.waiting.popleft() if self.waiting else None


class _Session:
    def __init__(self) -> None:
        self.queues: dict[str, _Queue] = {}

    def publisher(self, *_: Any) -> "_Session":
        return self

    def ring(self, key: str, depth: int) -> _Queue:
        return self.queues.setdefault(key, _Queue(depth))

    desk = ring

    def put(self, _: bytes) -> None: ...
    def announce(self, _: str) -> None: ...
    def close(self) -> None: ...

    def locators(self) -> tuple[str, ...]:
        return ()


class _Sessions(Sessions):
    """Gives the same session numbers and secrets each time, so that stored seeds stay valid."""

    def begin(self, seat: int) -> tuple[int, bytes]:
        self.end(seat, Why.REPLACED)
        self._held[SESSIONS[seat]] = _SeatHolder(seat, SECRETS[seat])
        return SESSIONS[seat], SECRETS[seat]


def command(seat: int, seq: int, level: int, key: int, match: int = 0, seen: int = 0) -> bytes:
    """Return a command with the seat's seal."""
    numbers = (SESSIONS[seat], seq, level, key, match, seen)
    mac = seal.command_mac(SECRETS[seat], KEYS.command(SEATS[seat]), *numbers)
    return codec.encode(Command(*numbers, mac))


def request(seat: int, what: str, ready: bool, seq: int) -> bytes:
    """Return a ready or leave request with the seat's seal."""
    mac = _request_mac(seat, what, ready, seq)
    return codec.encode(SeatRequest(session=SESSIONS[seat], seq=seq, ready=ready, mac=mac))


def _request_mac(seat: int, what: str, ready: bool, seq: int) -> bytes:
    key = KEYS.request(SEATS[seat], what)
    return seal.request_mac(SECRETS[seat], key, SESSIONS[seat], seq, ready)


def join(token: str, **more: Any) -> bytes:
    """Return a join request with this token."""
    return codec.encode(Join(protocol=PROTOCOL, token=token, name="Fuzzers", **more))


class Doors:
    """A court with two seated teams, which gets its packets in batches."""

    def __init__(self) -> None:
        robot, data = find_robot("hexapod")
        self._join_check = JoinCheck(
            SentFile(robot, data), *sample_gait_files("hexapod"), Limits(), (1,)
        )
        self._hashes = {seat: _hash(token) for seat, token in TOKENS.items()}
        self._courts = 0
        self._batch: list[tuple[str, bytes]] = []
        self.accepted = self.refused = 0
        self._open()

    def _open(self) -> None:
        self._session = _Session()
        real, court_network.open_court = court_network.open_court, lambda *_: self._session  # type: ignore[assignment,return-value]
        try:
            self._inbox = Inbox(KEYS, SEATS, self._join_check, bytes)
            self._inbox._sessions = _Sessions(bytes)
            self._inbox.admit(
                open_match({seat: [one] for seat, one in self._hashes.items()}), (0, 1)
            )
            self._desk = DecisionDesk([_hash(REFEREE)])
            self._network = CourtNetwork(KEYS, [], self._inbox, self._desk)
        finally:
            court_network.open_court = real
        phase = PHASES[self._courts % len(PHASES)]
        self._courts += 1
        self._match, self._twin = (Stage("othello").to(phase) for _ in range(2))
        self._now_s, self._beats = 100.0, 0
        for seat in (0, 1):
            self._inbox.seated(seat)

    def feed(self, key: str, payload: bytes) -> None:
        """Let a packet arrive under a key expression; a full batch starts a beat."""
        self._batch.append((key, payload))
        if len(self._batch) >= BATCH:
            self.beat()

    def beat(self) -> None:
        """Let the court handle the waiting packets, in as many beats as it needs.

        Raises:
            StateChanged: if a packet changed what its sender had no right to change.
        """
        batch, self._batch = self._batch, []
        desks: dict[str, int] = {}
        for key, payload in batch:
            if key.endswith("/key"):
                self._session.queues[key].waiting.append(payload)
                continue
            asked = KEYS.decision("*") if "/referee/" in key else key
            desks[asked] = desks.get(asked, 0) + 1
            self._session.queues[asked].waiting.append(_Request(key, payload))
        # A desk handles at most four requests a beat, and none after one that entered the match.
        beats = max(1, *desks.values()) if desks else 1
        for number in range(beats):
            self._one_beat()
            if number and not any(queue.waiting for queue in self._session.queues.values()):
                break

    def _one_beat(self) -> None:
        own = self._own_keys()
        before = self._state()
        self._now_s += 0.1
        self._beats += 1
        match = self._match.match
        self._network.hold([seat.coming or seat.join for seat in match.seats], match.has_begun)
        arrivals = self._network.poll(
            self._now_s,
            1,
            self._match.match.beats + 1,
            [seat.silent for seat in self._match.match.seats],
        )
        by_right = [item for item in arrivals if self._has_right(item)]
        if len(by_right) != len(arrivals):
            raise StateChanged(f"taken in without a right: {arrivals}")
        left = {a.input.seat for a in arrivals if isinstance(a.input, LeaveSeat)}
        own = {key for key in own if key.seat not in left}  # the robot of who leaves stands
        if not own <= {a.input for a in arrivals if isinstance(a.input, KeySeat)}:
            raise StateChanged(f"a seat's own new keys were lost: {own}")
        if not arrivals and self._state() != before:
            raise StateChanged("the doors' state changed")
        beat = self._match.beat(*(arrival.input for arrival in arrivals))
        twin = self._twin.beat(*(arrival.input for arrival in by_right))
        if codec.encode(beat.frame) != codec.encode(twin.frame):
            raise StateChanged("the match is another than its twin")
        self._network.publish_frame(codec.encode(beat.frame), self._now_s)
        for arrival, outcome in zip(arrivals, beat.outcomes, strict=True):
            if arrival.answer is not None:
                self.accepted += 1
                arrival.answer(outcome)
        for seat in (0, 1):  # a seat that was left gets its session back
            if self._inbox._sessions.holder(seat) != SESSIONS[seat]:
                self._inbox.seated(seat)
        over = self._match.phase in (Phase.OFFICIAL, Phase.VOID) or self._match.match.next_wanted
        if over or self._beats >= _BEATS_A_MATCH:
            self._open()

    def _own_keys(self) -> set[KeySeat]:
        """Queue commands of the seats' own controllers; return those that press a new key."""
        new: set[KeySeat] = set()
        for seat in (0, 1):
            key = KEYS.command(SEATS[seat])
            last = max(self._inbox._seats[seat].last_seq, _FIRST_OWN)
            # A court that has just begun has not sent a frame that could have been seen.
            seen = max(0, self._match.match.beats - seat) if self._beats else 0
            if self._beats % 10 == 5 * seat:
                last += 1
                item = KeySeat(seat, last, 1, last % 4, seen)
                new.add(item)
            # The newest command wins, so this one comes after the batch's packets for the seat.
            self._session.queues[key].waiting.append(command(seat, last, 1, last % 4, 1, seen))
        return new

    def _state(self) -> tuple[object, ...]:
        inbox = self._inbox
        return (
            tuple((seat.last_seq, seat.joined) for seat in inbox._seats),
            repr(inbox._sessions._held),
        )

    def _has_right(self, arrival: Arrival) -> bool:
        item = arrival.input
        if isinstance(item, SilentSeat | HeardSeat):
            return True  # these come from the clock, not from a packet
        if isinstance(item, KeySeat):
            own = (item.level, item.key) == (1, item.seq % 4) and item.seq > _FIRST_OWN - 1
            return own or (item.seat == 0 and (item.seq, item.level, item.key) in _SEALED)
        assert arrival.answer is not None
        payload = arrival.answer.args[0].payload  # type: ignore[attr-defined]
        if isinstance(item, JoinSeat):
            return TOKENS[SEATS[item.seat]].encode() in payload
        if isinstance(item, Decide):
            return REFEREE.encode() in payload
        what = "leave" if isinstance(item, LeaveSeat) else "ready"
        return any(
            _request_mac(item.seat, what, ready, seq) in payload
            for sealed, ready, seq in _REQUESTS
            if sealed == what
        )


_SEALED = {(1, 1, 2), (3, 1, RESTART_KEY), (2, 0, 3)}
"""Sequence number, level and key of the left seat's sealed seeds."""
_FIRST_OWN = 10
"""First sequence number of the seats' own controllers; the seeds have smaller ones."""
_REQUESTS = (("ready", True, 1), ("ready", False, 2), ("leave", True, 3), ("leave", False, 4))
"""Request, ready and sequence number of each seat's sealed seeds."""


def _hash(token: str) -> str:
    """Return the hash of a token as `seal.hash_token` does, but with a fixed salt."""
    digest = hashlib.blake2b(token.encode(), salt=bytes(16), digest_size=32, person=b"lacoc token")
    return f"{bytes(16).hex()}${digest.hexdigest()}"


def command_seeds() -> list[bytes]:
    """Return commands of both seats with good and bad seals, old numbers and nonsense."""
    seeds = [command(0, 1, 1, 2), command(0, 3, 1, RESTART_KEY), command(0, 2, 0, 3)]
    seeds += [command(1, 9, 1, 2), command(0, 0, 1, 2), command(0, 2**60, 1, 2)]
    seeds += [command(0, 7, 1, 2)[:-1] + b"\0", command(0, -5, 1, 2), command(0, 8, 9, 99)]
    seeds += [command(0, 0, 1, 2, 1, seen) for seen in (-1, 1, 10**6)]
    seeds += [command(0, 0, 1, 2, match, 3) for match in (-1, 2**63)]
    return [*seeds, codec.encode(Command(17, 1, 1, 2, 1, 3, bytes(8)))]


def request_seeds() -> list[bytes]:
    """Return ready and leave requests of both seats, each with its seal and with a broken seal."""
    good = [request(seat, *one) for seat in (0, 1) for one in _REQUESTS]
    return [*good, *(one[:-1] + b"\0" for one in good)]


def join_seeds() -> list[bytes]:
    """Return joins with all files and with none, with wrong tokens, and of another version."""
    robot = SentFile(*find_robot("hexapod"))
    postures, locomotion = sample_gait_files("hexapod")
    files = {"robot": robot, "postures": postures, "locomotion": locomotion}
    wrong = [join("guess", **files), join(TOKENS["right"]), join("", postures=postures)]
    other = codec.encode({"protocol": 2, "token": "x", "more": [1, {"a": None}]})
    return [join(TOKENS["left"], **files), join(TOKENS["left"]), *wrong * 2, other]


def decision_seeds() -> list[bytes]:
    """Return decisions with guessed tokens, and some with the referee's token."""
    made = (Start(), Halt(), Adjust("left", 5), Set("c2r3", "left"), TakeBack(3, True), Clock(9.5))
    seeds = [
        codec.encode(DecisionRequest(token=token, by="Kubota", reason="why", decision=one))
        for token in ("a-guess", "another", REFEREE)
        for one in made
    ]
    return [*seeds, codec.encode(Enter(token="guess")), codec.encode(Enter(token=REFEREE))]


def decision_key(payload: bytes) -> str:
    """Return the key expression of the decision in a payload; if there is none, that of `enter`."""
    name = next((name for name in DECISIONS if name.encode() in payload), "enter")
    return KEYS.decision(name)


def seat_key(what: str) -> Callable[[bytes], str]:
    """Return a function that gives the left seat's key expression for any payload."""
    return lambda _: KEYS.request("left", what) if what != "key" else KEYS.command("left")


def request_key(payload: bytes) -> str:
    """Return the key expression for a request; the sequence number decides: ready or leave.

    A sequence number that no seed request has counts as ready.
    """
    at = payload.find(b"seq") + 3
    asked = next((what for what, _, seq in _REQUESTS if payload[at : at + 1] == bytes((seq,))), "")
    return KEYS.request("left", asked or "ready")


ANSWERS = (Done, DecisionReply, Joined)
