"""Connects a court to the network: takes in what arrives before a beat, sends what follows.

No message is handled on Zenoh's threads: once a beat, `poll` takes the messages and requests that
wait in queues, always in the same order. The inbox checks who sent them. A request is answered once
the match has taken it in and the record is written. An outbox sends the rest.
"""

from collections import deque
from collections.abc import Callable, Collection, Iterator, Sequence
from functools import partial
from typing import Any, NamedTuple, Self

from lacoc_server.doors.decision_desk import DecisionDesk
from lacoc_server.doors.inbox import LOOKED_AT_PER_BEAT, Door, Inbox
from lacoc_server.doors.office_desk import Answer, OfficeDesk
from lacoc_server.doors.outbox import Outbox
from lacoc_server.doors.team_desk import TeamDesk
from lacoc_shared.codec import encode, message_hash
from lacoc_shared.inputs import Decide, Input, JoinSeat, KeySeat, LeaveSeat
from lacoc_shared.keyspace import ENTER, EVENTS_LISTED, KeySpace
from lacoc_shared.messages import (
    Done,
    Event,
    Health,
    Joined,
    Outcome,
    Outlook,
    OutlookRequest,
    Refusal,
    Scene,
    SeatHealth,
    Sheet,
    TryOutReply,
    TryOutRequest,
)
from lacoc_shared.messages.office import Assigned, Copied, Whereabouts
from lacoc_shared.network.certificate import Pair
from lacoc_shared.network.session import Request, RequestQueue, Ring, open_court
from lacoc_shared.words import Phrase

_RING = LOOKED_AT_PER_BEAT
_DESK = 16
_FETCH_DESK = 256  # a crowd may arrive at once
_REFUSALS_PER_BEAT = 4  # of a desk; at most one request of a desk enters a beat
_FETCHES_PER_BEAT = 8


_Told = Done | Copied | Whereabouts | Outlook | TryOutReply
"""Answers to requests from which the match gets no input."""
_Judged = Input | _Told | Refusal
_Later = Callable[[], _Judged | None]
"""A function that is called in each beat until it returns the outcome of a request."""
_Judge = Callable[[Request], _Judged | _Later]

LookAhead = Callable[[OutlookRequest], Callable[[], Outlook | Refusal | None]]
"""Starts to play a copy of the match, beside the beats.

It returns a function that is called in each beat until it returns the outlook, or a refusal.
"""

TryOut = Callable[[int, TryOutRequest], Refusal | Callable[[], TryOutReply | Refusal | None]]
"""Lets the robot of a seat walk alone, beside the beats.

It returns a refusal, or a function that is called in each beat until it returns the reply.
"""


class Arrival(NamedTuple):
    """An input for the match, and the receiver of its outcome."""

    input: Input
    answer: Callable[[Outcome], None] | None
    """Called once the outcome is on disk; None: nobody waits for it."""


class _RequestDesk(NamedTuple):
    """Requests of one kind, and how they are judged."""

    queue: RequestQueue
    judge: _Judge
    looks: int = _REFUSALS_PER_BEAT
    """At how many of them the court looks in a beat, until one enters."""


class CourtNetwork:
    """Connects a court to the network; used as a context manager.

    Args:
        keys: the court's key expressions.
        listen: addresses to listen on; port 0 takes a free one.
        inbox: checks what comes for the seats.
        decision_desk: checks what comes from referees.
        certificate: what proves the court's name; None: nothing is encrypted.
        office_desk: checks what comes from the office; None: the court has no office.
        look_ahead: answers referees who ask for an outlook; None: nobody answers them.
        team_desk: answers whoever asks where to play, at a court without an office.
        try_out: lets players try their keys in the lobby; None: nobody answers them.

    Raises:
        UserError: if the court can't listen on an address.
    """

    def __init__(
        self,
        keys: KeySpace,
        listen: Sequence[str],
        inbox: Inbox,
        decision_desk: DecisionDesk,
        certificate: Pair | None = None,
        office_desk: OfficeDesk[Any] | None = None,
        look_ahead: LookAhead | None = None,
        team_desk: TeamDesk | None = None,
        try_out: TryOut | None = None,
    ) -> None:
        self._inbox = inbox
        self._decision_desk = decision_desk
        self._office_desk = office_desk
        self._team_desk = (team_desk or TeamDesk()) if office_desk is None else office_desk.teams
        self._session = session = open_court(listen, certificate, office_desk is not None)
        self._outbox = Outbox()
        self._frame = session.publisher(keys.frame)
        self._event = session.publisher(keys.event)
        self._sheet = session.publisher(keys.sheet)
        self._health = session.publisher(keys.health)
        self._commands = [session.ring(keys.command(seat), _RING) for seat in inbox.seats]
        self._desks = [
            _RequestDesk(session.desk(keys.request(seat, what), _DESK), _seat_judge(judge, index))
            for what, judge in (
                ("join", inbox.join),
                ("ready", inbox.ready),
                ("leave", inbox.leave),
            )
            for index, seat in enumerate(inbox.seats)
        ]
        if try_out is not None:
            self._desks += [
                _RequestDesk(
                    session.desk(keys.request(seat, "try"), _DESK),
                    _try_judge(inbox, try_out, index),
                )
                for index, seat in enumerate(inbox.seats)
            ]
        # A flood of wrong tokens must not push a decision out.
        decisions = session.desk(keys.decision("*"), LOOKED_AT_PER_BEAT)
        self._desks.append(_RequestDesk(decisions, self._judge_decision, LOOKED_AT_PER_BEAT))
        if look_ahead is not None:
            judge = _outlook_judge(decision_desk, look_ahead)
            self._desks.append(_RequestDesk(session.desk(keys.outlook, _DESK), judge))
        if office_desk is not None:
            self._desks.append(
                _RequestDesk(session.desk(keys.office("*"), _DESK), _office_judge(office_desk))
            )
        self._desks.append(
            _RequestDesk(session.desk(keys.where, _FETCH_DESK), _team_judge(self._team_desk))
        )
        self._waiting: dict[RequestQueue, tuple[Request, _Later]] = {}
        """By queue, the request that is still being judged; the requests behind it wait too."""
        self._sheet_desk = session.desk(keys.sheet, _FETCH_DESK)
        self._scene_desk = session.desk(keys.scene, _FETCH_DESK)
        self._log_desk = session.desk(keys.event, _FETCH_DESK)
        self._log: deque[Event] = deque(maxlen=EVENTS_LISTED)
        """The newest events of the match."""
        self._sheet_bytes = self._scene_bytes = b""
        session.announce(keys.alive)
        self.locators = session.locators()
        """Addresses to connect to, with the real ports."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._outbox.close()
        self._session.close()

    def admit(self, assigned: Assigned, staying: Collection[int]) -> None:
        """Open the seats of a match; see `Inbox.admit`."""
        self._inbox.admit(assigned, staying)

    def hold(self, held: Sequence[JoinSeat | None], has_begun: bool) -> None:
        """Take note of who has the seats of the match, for requests to join in the next `poll`.

        Args:
            held: for each seat the newest accepted request to join; None: nobody has the seat.
            has_begun: whether the match goes on with the files that it began with.
        """
        self._inbox.hold(held, has_begun)

    def poll(self, now_s: float, match: int, beat: int, silent: Sequence[bool]) -> list[Arrival]:
        """Take in what arrived since the last beat.

        A request that a door refuses is answered at once and is not among the arrivals. Nor is one
        that gives the match no input, such as a request of the office, or where a team plays. Nor
        is a key of a contestant who leaves in this beat: their robot is to stand.

        Args:
            now_s: monotonic time.
            match: number of the match.
            beat: number of the beat that begins now.
            silent: for each seat, whether it is silent in the match.
        """
        self._inbox.links.begin(now_s, match, beat)
        waiting = [_empty(ring) for ring in self._commands]
        inputs = self._inbox.commands(now_s, waiting, silent)
        arrivals = [Arrival(one, None) for one in inputs]
        for desk in self._desks:
            arrivals += self._let_in(*desk)
        self._serve_fetches()
        # Not left to the match: records of earlier versions have such keys, and they took effect.
        leave = {one.input.seat for one in arrivals if isinstance(one.input, LeaveSeat)}
        return [
            one
            for one in arrivals
            if not (isinstance(one.input, KeySeat) and one.input.seat in leave)
        ]

    def turn_away(self, why: Phrase) -> None:
        """Refuse requests that doors judge, because no beat passes; still answer who fetches data.

        Args:
            why: sentence for the senders.
        """
        refusal = encode(Refusal(why, again=True))
        for desk in self._desks:
            for _ in range(_REFUSALS_PER_BEAT):
                if (request := desk.queue.take()) is not None:
                    request.refuse(refusal)
        self._serve_fetches()

    def publish_frame(self, frame: bytes, now_s: float) -> None:
        """Send an encoded frame; a slow receiver may miss it.

        Args:
            frame: frame of the beat.
            now_s: monotonic time, from which round trips are measured.
        """
        self._inbox.links.sent(now_s)
        self._outbox.send_newest(self._frame, frame)

    def publish_again(self, frame: bytes) -> None:
        """Send a frame that was published before, as a sign of life."""
        self._outbox.send_newest(self._frame, frame)

    def publish_event(self, event: Event) -> None:
        """Send an event; keep the match's newest `EVENTS_LISTED` for clients that missed them."""
        if self._log and self._log[0].match != event.match:
            self._log.clear()
        self._log.append(event)
        self._outbox.send(self._event, encode(event))

    def publish_sheet(self, sheet: Sheet) -> None:
        """Send a changed sheet, and keep it for clients that ask."""
        self._sheet_bytes = encode(sheet)
        self._outbox.send(self._sheet, self._sheet_bytes)

    def publish_scene(self, scene: Scene) -> None:
        """Keep a changed scene for clients that ask; the hash in the frames shows the change."""
        self._scene_bytes = encode(scene)

    def publish_health(self, health: Health) -> None:
        """Send the court's health; it shows clients whether they missed an event or a sheet."""
        self._outbox.send_newest(self._health, encode(health))

    @property
    def newest_event(self) -> int:
        """Number of the newest event that was published; 0: none."""
        return self._log[-1].number if self._log else 0

    @property
    def sheet_hash(self) -> bytes:
        """Hash of the newest sheet that was published."""
        return message_hash(self._sheet_bytes)

    def seat_health(self, now_s: float) -> tuple[SeatHealth, ...]:
        """Return the health of each seat's link, in the arena's order."""
        return self._inbox.health(now_s)

    def doors(self) -> tuple[Door, ...]:
        """Return the counts of valid commands and refusals, for each seat."""
        return self._inbox.doors()

    @property
    def input_delay_ms(self) -> int:
        """The common delay of all seats' links [ms]; 0: none."""
        return self._inbox.links.delay_ms

    @property
    def dropped(self) -> dict[str, int]:
        """Number of refused messages that were not for a seat, by `Why`."""
        refused = self._decision_desk.refused + self._team_desk.refused
        if self._office_desk is not None:
            refused = refused + self._office_desk.refused
        return dict(refused)

    def _serve_fetches(self) -> None:
        if self._sheet_bytes:  # a client that asks earlier waits
            _serve(self._sheet_desk, lambda: self._sheet_bytes)
        if self._scene_bytes:
            _serve(self._scene_desk, lambda: self._scene_bytes)
        _serve(self._log_desk, lambda: encode(tuple(self._log)))

    def _let_in(self, desk: RequestQueue, judge: _Judge, looks: int) -> Iterator[Arrival]:
        refused = 0
        for _ in range(looks):
            if desk in self._waiting:
                request, later = self._waiting.pop(desk)
                judged: _Judged | _Later = later() or later
            elif (taken := desk.take()) is not None:
                request, judged = taken, judge(taken)
            else:
                return
            if callable(judged):
                self._waiting[desk] = request, judged
                return
            if isinstance(judged, Refusal):
                if refused < _REFUSALS_PER_BEAT:  # the senders of further ones hear nothing
                    request.refuse(encode(judged))
                refused += 1
            elif isinstance(judged, _Told):
                request.reply(encode(judged))
            else:
                yield Arrival(judged, partial(self._answer, request, judged))
                return

    def _answer(self, request: Request, judged: Input, outcome: Outcome) -> None:
        if isinstance(outcome, Refusal):
            request.refuse(encode(outcome))
            return
        reply: Outcome | Joined = outcome
        if isinstance(judged, JoinSeat):
            said = outcome.said if isinstance(outcome, Done) else None
            reply = self._inbox.seated(judged.seat, (said,) if said else ())
        elif isinstance(judged, LeaveSeat):
            self._inbox.left(judged.seat)
        request.reply(encode(reply))

    def _judge_decision(self, request: Request) -> Decide | Done | Refusal:
        name = request.key.rpartition("/")[2]
        if name == ENTER:
            return self._decision_desk.enter(request.payload)
        return self._decision_desk.decision(name, request.payload)


def _seat_judge(judge: Callable[[int, bytes], _Judged | _Later], seat: int) -> _Judge:
    return lambda request: judge(seat, request.payload)


def _try_judge(inbox: Inbox, try_out: TryOut, seat: int) -> _Judge:
    def judge(request: Request) -> Refusal | _Later:
        asked = inbox.try_out(seat, request.payload)
        return asked if isinstance(asked, Refusal) else try_out(seat, asked)

    return judge


def _outlook_judge(desk: DecisionDesk, look_ahead: LookAhead) -> _Judge:
    def judge(request: Request) -> Refusal | _Later:
        asked = desk.outlook(request.payload)
        return asked if isinstance(asked, Refusal) else look_ahead(asked)

    return judge


def _office_judge(desk: OfficeDesk[Any]) -> _Judge:
    def judge(request: Request) -> Answer:
        return desk.judge(request.key.rpartition("/")[2], request.payload)

    return judge


def _team_judge(desk: TeamDesk) -> _Judge:
    return lambda request: desk.where(request.payload)


def _empty(ring: Ring) -> list[bytes]:
    waiting: list[bytes] = []
    while len(waiting) < _RING and (payload := ring.take()) is not None:
        waiting.append(payload)
    return waiting


def _serve(desk: RequestQueue, payload: Callable[[], bytes]) -> None:
    """Answer at most 8 clients in a beat with data that they fetch, such as the sheet."""
    for _ in range(_FETCHES_PER_BEAT):
        request = desk.take()
        if request is None:
            return
        request.reply(payload())
