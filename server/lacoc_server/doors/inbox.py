"""Checks what arrives at a court: tokens, sessions, sequence numbers, seals, floods.

Pure: bytes and the time come in, inputs and refusals come out. A join passes only with a token of
the seat, any other message only with proof that the seat's own controller sent it. A message can
be refused, but raises no exception. A beat looks at a limited number of messages.
"""

from collections import Counter, deque
from collections.abc import Callable, Collection, Mapping, Sequence
from functools import partial
from itertools import pairwise
from typing import NamedTuple, TypeVar

import msgspec

from lacoc_server.doors.links import Links
from lacoc_server.doors.openings import Openings, frozen_join
from lacoc_server.doors.sessions import Sessions, Why
from lacoc_shared import codec, seal
from lacoc_shared.contest.names import read_name, told_apart
from lacoc_shared.gait.tables import Level
from lacoc_shared.inputs import (
    HeardSeat,
    Input,
    JoinSeat,
    LeaveSeat,
    ReadySeat,
    SilentSeat,
)
from lacoc_shared.keyspace import COMMAND_MAX_BYTES, JOIN_MAX_BYTES, KeySpace
from lacoc_shared.messages import (
    PROTOCOL,
    TRY_OUT_ASKED_TICKS,
    Command,
    Done,
    Join,
    Joined,
    Refusal,
    SeatHealth,
    SeatRequest,
    TryOutRequest,
)
from lacoc_shared.messages.office import Assigned, AssignedSeat
from lacoc_shared.mistakes import FileRefused, printable
from lacoc_shared.network.allowance import Allowance
from lacoc_shared.seat import RESTART_KEY, SILENT_AFTER_S
from lacoc_shared.words import Phrase, say

COMMANDS_PER_BEAT = 16
"""Most commands of a seat that are used in one beat; older ones are dropped."""
LOOKED_AT_PER_BEAT = 64
"""Most messages for a seat that are checked in one beat, whoever sent them."""
COMMANDS_HZ = 200.0
"""Most commands of a seat per second, on average. A controller sends 10 repeats and the pressed
keys, a bot 60 in all.
"""
SEQ_JUMP_MAX = 2**16
"""Most sequence numbers that a command may skip. Without a bound, one command could use up all
numbers of a seat. This bound covers 20 minutes of keys that never arrived.
"""
NAME_MAX = 24
FILE_NAME_MAX = 100
"""Longest file name [characters]: each mistake in a file repeats its name."""

_JOINS_HZ, _JOINS_BURST = 1.0, 5  # a join may cost reading three files
_READYS_HZ, _READYS_BURST = 1.0, 5  # may build a model, and all see an event
_TRIES_HZ, _TRIES_BURST = 3.0, 6  # the robot walks for some seconds
_RATE_WINDOW_S = 2.0

_NO_SESSION = {
    Why.UNKNOWN_SESSION: say("refused.unknown-session", seat=""),
    Why.REPLACED: say("refused.replaced", seat=""),
    Why.LEFT: say("refused.left", seat=""),
    Why.NOT_YOUR_SEAT: say("refused.not-your-seat", seat=""),
    Why.OTHER_MATCH: say("refused.other-match", seat=""),
}


_Sealed = TypeVar("_Sealed", SeatRequest, TryOutRequest)

Later = Callable[[], JoinSeat | Done | Refusal | None]
"""A function for a request that takes longer than a beat: called each beat until it answers."""
CheckFiles = Callable[[Join, JoinSeat | None], tuple[Join, tuple[Phrase, ...]] | None]
"""Weighs in the files of a request to join.

It takes the request, and the one with which the seat was taken. It returns the request with the
robot file filled in, and notes on which files are used; or None while it needs more time. It raises
`FileRefused` for bad files.
"""


class Door(NamedTuple):
    """Counts of the messages for one seat since the court was started."""

    heard: int
    """Number of valid commands."""
    refused: Mapping[str, int]
    """Number of refusals by `Why`."""


class _SeatDoor:
    def __init__(self, index: int, name: str, last_seq: int, joined: bool) -> None:
        self.index = index
        self.name = name
        self.last_seq = last_seq
        self.joined = joined
        self.heard_s: float | None = None
        self.refused: Counter[str] = Counter()
        """Number of refusals by `Why`, since the court was started."""
        self.former: Counter[str] = Counter()
        """What `refused` was when the present team took the seat from another one."""
        self.team = ""
        """The team whose join the match accepted last; "": none since the court was started."""
        self.asking = ""
        """The team of the newest join; "": none since the seat was empty."""
        self.wanted = ""
        """The team's name as the newest join asked for it."""
        self.heard = 0
        """Number of valid commands."""
        self.notes: tuple[Phrase, ...] = ()
        """Notes on the files of the newest join."""
        self.valid_s: deque[float] = deque(maxlen=int(2 * COMMANDS_HZ * _RATE_WINDOW_S))
        self.commands = Allowance(COMMANDS_HZ, COMMANDS_PER_BEAT)
        self.joins = Allowance(_JOINS_HZ, _JOINS_BURST)
        self.readys = Allowance(_READYS_HZ, _READYS_BURST)
        self.tries = Allowance(_TRIES_HZ, _TRIES_BURST)

    def refuse(self, why: Why, said: Phrase, *, again: bool = False) -> Refusal:
        self.refused[why.value] += 1
        return Refusal(said, again=again)


MISTAKES_TOLD = 500  # a file of garbage has thousands, and an answer is one message


class Inbox:
    """Checks what arrives for the seats of a court, and knows who holds them.

    Args:
        keys: key expressions of the court; seals cover them.
        seats: the seats' names, in the arena's order.
        check_files: weighs in the files of a request to join.
        random_bytes: returns as many random bytes as asked, for numbers and secrets of sessions.
        last_seqs: for a restarted court, the newest sequence numbers in its record, by seat.
        joined: for a restarted court, the seats that are held.
        most_delay_ms: longest common delay; 0: keys are not delayed.
    """

    def __init__(
        self,
        keys: KeySpace,
        seats: Sequence[str],
        check_files: CheckFiles,
        random_bytes: Callable[[int], bytes],
        *,
        last_seqs: Mapping[str, int] | None = None,
        joined: Collection[str] = (),
        most_delay_ms: int = 0,
    ) -> None:
        self._keys = keys
        self._openings = Openings()
        self._check_files = check_files
        self._seats = [
            _SeatDoor(index, name, (last_seqs or {}).get(name, 0), name in joined)
            for index, name in enumerate(seats)
        ]
        self.links = Links(len(seats), most_delay_ms)
        """Round trips of the seats' links, and commands that are held."""
        self._sessions = Sessions(random_bytes)
        self._now_s = 0.0
        self._held: Sequence[JoinSeat | None] = [None] * len(seats)
        self._has_begun = False

    @property
    def seats(self) -> tuple[str, ...]:
        """The seats' names, in the arena's order."""
        return tuple(seat.name for seat in self._seats)

    def hold(self, held: Sequence[JoinSeat | None], has_begun: bool) -> None:
        """Take note of who has the seats of the match, before requests to join are checked.

        Args:
            held: for each seat the newest accepted request to join; None: nobody has the seat.
            has_begun: whether the match goes on with the files that it began with.
        """
        self._held, self._has_begun = held, has_begun

    def admit(self, assigned: Assigned, staying: Collection[int]) -> None:
        """Open the seats of a match; call it with each match that the court opens.

        Args:
            assigned: the match, as it is assigned.
            staying: the seats whose sessions go on. All others end.
        """
        self._openings.admit(assigned)
        for seat in self._seats:
            if seat.index not in staying:
                self._empty(seat, Why.OTHER_MATCH)
                seat.last_seq = 0  # the numbers of a seat last for a match

    def commands(
        self, now_s: float, arrived: Sequence[Sequence[bytes]], silent: Sequence[bool]
    ) -> list[Input]:
        """Check the commands that arrived for a beat; return the inputs that follow from them.

        Args:
            now_s: monotonic time.
            arrived: for each seat the payloads on its key expression, the newest last.
            silent: for each seat, whether it is silent in the match.

        Returns:
            For each seat up to three inputs, in this order: it fell silent or is heard again; the
            newest [x] that takes effect now; the newest digit that takes effect now (rules 3).
        """
        self._now_s = now_s
        inputs: list[Input] = []
        for seat, payloads, is_silent in zip(self._seats, arrived, silent, strict=True):
            for command in self._own(seat, payloads):
                self._take(seat, command)
            inputs += self._presence(seat, is_silent)
            newest = {key.key == RESTART_KEY: key for key in self.links.release(seat.index)}
            inputs += [newest[restart] for restart in (True, False) if restart in newest]
        return inputs

    def join(self, index: int, payload: bytes) -> JoinSeat | Refusal | Later:
        """Check a request to join; call `seated` once the match has accepted it.

        Returns:
            The input for the match, or a refusal, or a `Later` while the files are weighed in.
        """
        seat = self._seats[index]
        try:
            protocol = codec.protocol_of(payload, JOIN_MAX_BYTES)
            if protocol != PROTOCOL:
                said = say("refused.wrong-version", court=PROTOCOL, program=protocol)
                return seat.refuse(Why.WRONG_VERSION, said)
            join = codec.decode(payload, Join, JOIN_MAX_BYTES)
        except codec.BadMessage as error:
            return seat.refuse(Why.BAD_BYTES, say("refused.bad-join", error=str(error)))
        opened = self._openings.opened(seat.name, join.token)
        if opened is None:
            why, said = self._openings.why_closed(seat.name, join.token)
            return seat.refuse(why, said, again=why is Why.OTHER_MATCH)
        if not seat.joins.take(1, self._now_s):
            return seat.refuse(Why.FLOOD, say("refused.too-many-joins"), again=True)
        name = read_name(join.name, NAME_MAX)
        if name is None:
            said = say("refused.team-name", most=NAME_MAX, name=printable(join.name))
            return seat.refuse(Why.BAD_NAME, said)
        files = [one for one in (join.robot, join.postures, join.locomotion) if one is not None]
        if not all(0 < len(one.name) <= FILE_NAME_MAX and one.name.isprintable() for one in files):
            return seat.refuse(Why.BAD_NAME, say("refused.file-name", most=FILE_NAME_MAX))
        join = msgspec.structs.replace(join, name=self._own_name(seat, name))
        assigned, token_hash = opened
        if assigned.team:
            return self._frozen(seat, join, assigned, token_hash)
        return self._weighed(seat, join, token_hash) or partial(
            self._weighed, seat, join, token_hash
        )

    def _own_name(self, seat: _SeatDoor, name: str) -> str:
        """Add the seat's name to a team's name if the name of another seat's team looks like it.

        Otherwise readers could not tell the two teams apart in events and on pages.
        """
        seat.wanted = name
        held = [join.team if join is not None else "" for join in self._held]
        others = {
            named
            for one in self._seats
            if one is not seat
            for named in (one.asking, held[one.index])
            if named
        }
        return told_apart(name, others, seat.name, NAME_MAX)

    def _frozen(
        self, seat: _SeatDoor, join: Join, assigned: AssignedSeat, token_hash: str
    ) -> JoinSeat:
        """Return a team's request to join, with the name and files that the office fixed.

        The name and files that the team sent are ignored.
        """
        sent = (join.robot, join.postures, join.locomotion)
        differs = any(
            one is not None and (frozen is None or one.data != frozen.data)
            for one, frozen in zip(sent, assigned.files, strict=True)
        )
        seat.asking = assigned.team
        seat.notes = (say("note.files-frozen"),) if differs else ()
        return frozen_join(seat.index, assigned, token_hash)

    def _weighed(self, seat: _SeatDoor, join: Join, token_hash: str) -> JoinSeat | Refusal | None:
        """Weigh in the files of a request to join; return None until that is done.

        Bad files keep no team out of its seat in a match that has begun: the team then gets the
        files that the seat has, and notes say what is wrong.
        """
        held = self._held[seat.index]
        seat.asking = join.name
        try:
            checked = self._check_files(join, held)
        except FileRefused as refused:
            seat.refused[Why.BAD_FILES.value] += 1
            mistakes = refused.mistakes
            if held is not None and self._has_begun:
                seat.notes = refused.notes()
                return msgspec.structs.replace(held, team=join.name, token_hash=token_hash)
            first = MISTAKES_TOLD if len(mistakes) > MISTAKES_TOLD else None
            return Refusal(
                say("refused.mistakes", count=len(mistakes), first=first),
                tuple(mistakes[:MISTAKES_TOLD]),
            )
        if checked is None:
            return None
        whole, notes = checked
        renamed = join.name != seat.wanted
        seat.notes = (say("note.renamed", name=join.name), *notes) if renamed else notes
        assert whole.robot is not None, "check_files fills the robot file in"
        return JoinSeat(
            seat=seat.index,
            team=join.name,
            robot=whole.robot,
            postures=whole.postures,
            locomotion=whole.locomotion,
            token_hash=token_hash,
        )

    def seated(self, index: int, notes: tuple[Phrase, ...] = ()) -> Joined:
        """Give a seat to a sender whose request to join was accepted; end the seat's older session.

        Args:
            index: the seat.
            notes: remarks of the match; they follow those on the files.
        """
        seat = self._seats[index]
        number, secret = self._sessions.begin(index)
        if seat.team not in ("", seat.asking):
            seat.former = Counter(seat.refused)
            self.links.drop(index)
        seat.team = seat.asking
        seat.joined = True
        seat.heard_s = self._now_s
        told = (*seat.notes, *notes)
        return Joined(session=number, secret=secret, last_seq=seat.last_seq, notes=told)

    def ready(self, index: int, payload: bytes) -> ReadySeat | Refusal:
        """Check a request that says whether a team is ready."""
        request = self._request(index, payload, "ready", SeatRequest)
        if isinstance(request, Refusal):
            return request
        seat = self._seats[index]
        if not seat.readys.take(1, self._now_s):
            return seat.refuse(Why.FLOOD, say("refused.too-many-readys"), again=True)
        return ReadySeat(index, request.ready)

    def leave(self, index: int, payload: bytes) -> LeaveSeat | Refusal:
        """Check a request to leave a seat; call `left` once the match has accepted it."""
        request = self._request(index, payload, "leave", SeatRequest)
        return request if isinstance(request, Refusal) else LeaveSeat(index)

    def try_out(self, index: int, payload: bytes) -> TryOutRequest | Refusal:
        """Check a request to try keys in the lobby."""
        request = self._request(index, payload, "try", TryOutRequest)
        if isinstance(request, Refusal):
            return request
        seat = self._seats[index]
        ticks = [key.tick for key in request.keys]
        if not (
            0 <= request.until - request.first <= TRY_OUT_ASKED_TICKS
            and all(one < other for one, other in pairwise(ticks))
        ):
            said = say("refused.bad-request", error="ticks")
            return seat.refuse(Why.OUT_OF_RANGE, said)
        if not seat.tries.take(1, self._now_s):
            return seat.refuse(Why.FLOOD, say("refused.too-many-tries"), again=True)
        return request

    def left(self, index: int) -> None:
        """Free a seat after the match has accepted a request to leave it."""
        self._empty(self._seats[index], Why.LEFT)

    def _empty(self, seat: _SeatDoor, why: Why) -> None:
        self._sessions.end(seat.index, why)
        seat.joined = False
        seat.heard_s = None
        seat.asking = ""
        self.links.drop(seat.index)

    def doors(self) -> tuple[Door, ...]:
        """Return the counts of valid commands and refusals, for each seat."""
        return tuple(Door(seat.heard, seat.refused) for seat in self._seats)

    def health(self, now_s: float) -> tuple[SeatHealth, ...]:
        """Return the health of each seat's link."""
        return tuple(self._health(seat, now_s) for seat in self._seats)

    def _health(self, seat: _SeatDoor, now_s: float) -> SeatHealth:
        trip = self.links.trip(seat.index)
        recent = sum(at_s > now_s - _RATE_WINDOW_S for at_s in seat.valid_s)
        return SeatHealth(
            id=seat.name,
            joined=seat.joined,
            session=self._sessions.holder(seat.index),
            heard_ms=None if seat.heard_s is None else (now_s - seat.heard_s) * 1000,
            commands_hz=recent / _RATE_WINDOW_S,
            refused=dict(seat.refused - seat.former),
            round_trip_p50_ms=trip and trip.p50_s * 1000,
            round_trip_p95_ms=trip and trip.p95_s * 1000,
            late=self.links.late(seat.index),
        )

    def _own(self, seat: _SeatDoor, payloads: Sequence[bytes]) -> list[Command]:
        """Return the newest commands that the seat's holder sealed, the oldest of them first.

        Messages from other senders do not count towards `COMMANDS_HZ`.
        """
        allowed = seat.commands.left(self._now_s)
        own: list[Command] = []
        looked_at = 0
        for payload in reversed(payloads[-LOOKED_AT_PER_BEAT:]):
            if len(own) == allowed:
                break
            looked_at += 1
            command = self._proven(seat, payload)
            if isinstance(command, Why):
                seat.refused[command.value] += 1
            else:
                own.append(command)
        seat.commands.take(len(own), self._now_s)
        if looked_at < len(payloads):
            seat.refused[Why.FLOOD.value] += len(payloads) - looked_at
        return own[::-1]

    def _take(self, seat: _SeatDoor, command: Command) -> None:
        why = self._nonsense(seat, command)
        is_new = command.seq > seat.last_seq
        if why is None and not (self.links.heard(seat.index, command) or is_new):
            why = Why.STALE
        if why is not None:
            seat.refused[why.value] += 1
            return
        seat.heard_s = self._now_s
        seat.heard += 1
        seat.valid_s.append(self._now_s)
        if is_new:  # a repeat is only a sign of life
            seat.last_seq = command.seq
            self.links.hold(seat.index, command)

    def _proven(self, seat: _SeatDoor, payload: bytes) -> Command | Why:
        if len(payload) > COMMAND_MAX_BYTES:
            return Why.TOO_LONG
        try:
            command = codec.decode(payload, Command)
        except codec.BadMessage:
            return Why.BAD_BYTES
        secret = self._sessions.secret(seat.index, command.session)
        if isinstance(secret, Why):
            return secret
        *numbers, mac = msgspec.structs.astuple(command)
        expected = seal.command_mac(secret, self._keys.command(seat.name), *numbers)
        return command if seal.same(mac, expected) else Why.BAD_SEAL

    def _nonsense(self, seat: _SeatDoor, command: Command) -> Why | None:
        if command.level not in (Level.POSTURE, Level.LOCOMOTION):
            return Why.OUT_OF_RANGE
        if not 0 <= command.key <= RESTART_KEY:
            return Why.OUT_OF_RANGE
        if not 0 <= command.seq <= seat.last_seq + SEQ_JUMP_MAX:
            return Why.OUT_OF_RANGE
        if min(command.match, command.seen) < 0:
            return Why.OUT_OF_RANGE
        if self.links.is_ahead(command):
            return Why.AHEAD
        return Why.OLD if 0 < command.seq < seat.last_seq else None

    def _request(
        self, index: int, payload: bytes, what: str, kind: type[_Sealed]
    ) -> _Sealed | Refusal:
        seat = self._seats[index]
        try:
            request = codec.decode(payload, kind, COMMAND_MAX_BYTES)
        except codec.BadMessage as error:
            return seat.refuse(Why.BAD_BYTES, say("refused.bad-request", error=str(error)))
        secret = self._sessions.secret(index, request.session)
        if isinstance(secret, Why):
            return seat.refuse(secret, _NO_SESSION[secret].with_values(seat=seat.name))
        key_expression = self._keys.request(seat.name, what)
        expected = seal.request_mac(
            secret, key_expression, request.session, request.seq, *request.sealed
        )
        if not seal.same(request.mac, expected):
            return seat.refuse(Why.BAD_SEAL, say("refused.bad-seal", seat=seat.name))
        # A try-out changes nothing: it must not make an earlier "ready" an old one.
        of = "try" if what == "try" else ""
        if not self._sessions.is_next(request.session, request.seq, of):
            return seat.refuse(Why.OLD, say("refused.request-old"))
        return request

    def _presence(self, seat: _SeatDoor, is_silent: bool) -> list[Input]:
        """Return the input that corrects the match if it is wrong about a seat's silence.

        `is_silent` is the seat's state in the match. In a new match, or in one that goes on after a
        restart of the court, it may be the opposite of what the inbox has measured.
        """
        if not seat.joined:
            return []
        if seat.heard_s is None:  # held since before the court's restart
            if is_silent:
                return []
            seat.heard_s = self._now_s
        now_silent = self._now_s - seat.heard_s > SILENT_AFTER_S
        if now_silent == is_silent:
            return []
        return [SilentSeat(seat.index) if now_silent else HeardSeat(seat.index)]
