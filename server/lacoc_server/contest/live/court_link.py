"""The office's connection to one court: assigns matches, and reads their states and results.

Only `Asked.wait` waits; nothing else here does. A court's health messages say how new its sheet and
its events are. If they are newer than the copies here, the office asks for them. So after a lost
message, or a restart of court or office, the newest ones are here half a second later, and no
result is lost.
"""

import time
from collections.abc import Callable, Mapping, Sequence
from enum import Enum
from typing import Any, Generic, NamedTuple, TypeVar

from lacoc_server.contest.league.advice import advice
from lacoc_shared import codec
from lacoc_shared.codec import encode, message_hash
from lacoc_shared.keyspace import KeySpace
from lacoc_shared.messages import Done, Event, Frame, Health, Refusal, Sheet
from lacoc_shared.messages.office import (
    EARLIER_OFFICE,
    Assign,
    AssignedSeat,
    Copied,
    Copy,
    OfficeRequest,
    Retire,
    Tell,
    Whereabouts,
    Withdraw,
)
from lacoc_shared.network.session import Mailbox, NoReply, Question, Refused, Session
from lacoc_shared.seat import BEAT_S, Phase, SeatFlag
from lacoc_shared.words import Phrase

T = TypeVar("T")

ANSWER_S = 5.0
"""Longest wait for the answer to a request [s]: before it answers, a court weighs the files in."""
GONE_S = 2.0
"""A court that has sent no health message for this long counts as away [s]."""
_FETCH_S = 2.0
_MAX_BYTES = 1 << 20  # of a sheet, of the list of events, or of a part of a record


class Unanswered(Enum):
    """The court sent no readable answer.

    It may have done what was asked, so ask again with the same call.
    """

    NO_ANSWER = "no-answer"


class Asked(Generic[T]):
    """A request that was sent to a court, and its answer.

    Args:
        question: the request.
        kind: the kind of message with which the court answers.
        refused: called if the court refuses the request, with the refusal.
    """

    def __init__(
        self, question: Question, kind: type[T], refused: Callable[[Refusal], None]
    ) -> None:
        self._question = question
        self._kind = kind
        self._refused = refused

    def take(self) -> T | Refusal | Unanswered | None:
        """Return the court's answer, or None if it has not come yet; never blocks."""
        return self._read(wait=False)

    def wait(self) -> T | Refusal | Unanswered:
        """Wait for the court's answer."""
        found = self._read(wait=True)
        assert found is not None, "a question that is waited for has an answer"
        return found

    def _read(self, wait: bool) -> T | Refusal | Unanswered | None:
        try:
            answer = self._question.wait() if wait else self._question.take()
            return None if answer is None else codec.decode(answer, self._kind, _MAX_BYTES)
        except Refused as refused:
            try:
                refusal = codec.decode(refused.payload, Refusal, _MAX_BYTES)
            except codec.BadMessage:
                return Unanswered.NO_ANSWER
            self._refused(refusal)
            return refusal
        except (NoReply, codec.BadMessage):
            return Unanswered.NO_ANSWER


class CourtResult(NamedTuple):
    """How an assigned match ended."""

    call: str
    match_id: str
    """Id of the match; its record has the same name."""
    teams: tuple[str, ...]
    scores: tuple[int, ...]
    """Points by seat, with the referee's adjustments; zeros if the match is void."""
    outcome: str
    """Id of the seat that won officially, or "draw" or "void"."""
    advice: tuple[Phrase, ...] = ()
    """Why the court advised to play the match again; empty: it did not."""


class CourtLink:
    """The connection between the office and one court; only one thread may use it.

    Args:
        session: an open client session at the court's address.
        court: the court's name.
        token: the office's token.
        generation: how often the office has gone to another machine.
    """

    def __init__(self, session: Session, court: str, token: str, generation: int = 0) -> None:
        self.court = court
        self.is_superseded = False
        """Whether the court has refused a request because a later office had already asked it."""
        self._session = session
        self._token = token
        self._generation = generation
        self._keys = KeySpace(court)
        self._frames = session.mailbox(self._keys.frame, 1)
        self._healths = session.mailbox(self._keys.health, 1)
        self._heard_s: float | None = None
        self.health: Health | None = None
        """The newest health message; None: none has come."""
        self.frame: Frame | None = None
        """The newest frame, for phase, clock and scores; None: none has come."""
        self._sheet: _Fetched[Sheet] = _Fetched(session, self._keys.sheet, Sheet)
        self._events: _Fetched[tuple[Event, ...]] = _Fetched(
            session, self._keys.event, tuple[Event, ...]
        )

    def assign(
        self,
        call: str,
        fixture: Phrase,
        seats: Sequence[AssignedSeat],
        *,
        arena: str = "",
        arena_settings: dict[str, Any] | None = None,
        limits: dict[str, float] | None = None,
    ) -> Asked[Done]:
        """Assign a match to the court; the answer comes when the match is open and on disk.

        Args:
            call: id of the call. The same call twice opens one match.
            fixture: name of the match and game, a phrase of `fixture.*`.
            seats: a team for each seat of the court.
            arena: name of an installed arena; "": the court's own.
            arena_settings: entries that replace those of the arena file.
            limits: limits for robots, where they differ from the defaults.
        """
        request = Assign(
            token=self._token,
            generation=self._generation,
            call=call,
            fixture=fixture,
            seats=tuple(seats),
            arena=arena,
            arena_settings=arena_settings or {},
            limits=limits or {},
        )
        return self._ask("assign", request, Done)

    def withdraw(
        self, call: str, *, begun: bool = False, official: bool = False, why: Phrase | None = None
    ) -> Asked[Done]:
        """Tell the court to close an assigned match.

        Args:
            call: id of its call.
            begun: True: close it even if it has begun; False: the court refuses this.
            official: True: close it even if its result is official; False: the court refuses this.
            why: why, for those who play and watch; None: no reason is known.
        """
        request = Withdraw(
            token=self._token,
            generation=self._generation,
            call=call,
            begun=begun,
            official=official,
            why=why,
        )
        return self._ask("withdraw", request, Done)

    def copy(self, match_id: str, have: Mapping[str, int]) -> Asked[Copied]:
        """Ask for the next part of a match's record.

        Args:
            match_id: the match.
            have: length in bytes of each file of the record that the office has, by its name.
        """
        request = Copy(
            token=self._token, generation=self._generation, match_id=match_id, have=dict(have)
        )
        return self._ask("copy", request, Copied)

    def retire(self) -> Asked[Done]:
        """Tell the court's process to end, because the court goes on at another machine."""
        request = Retire(token=self._token, generation=self._generation)
        return self._ask("retire", request, Done)

    def tell(self, teams: Mapping[str, Whereabouts]) -> Asked[Done]:
        """Tell the court where each team of the contest plays, or what it waits for.

        Args:
            teams: where each team is, by the salted hash of the team's token.
        """
        request = Tell(token=self._token, generation=self._generation, teams=dict(teams))
        return self._ask("tell", request, Done)

    def poll(self) -> None:
        """Read the messages and answers that have arrived.

        If a health message says that the court has a newer sheet or newer events, ask for them.
        """
        frame = _newest(self._frames, Frame)
        self.frame = frame or self.frame
        health = _newest(self._healths, Health)
        if health is not None:
            self.health, self._heard_s = health, time.monotonic()
        match_id = self._sheet.value and self._sheet.value.match_id
        if self._sheet.take() and self._sheet.value and self._sheet.value.match_id != match_id:
            self._events.forget()  # a restarted court may count its matches from 1 again
        self._events.take()
        if self.health is None or not self.is_there:
            return
        if self.health.sheet != self._sheet.hash:
            self._sheet.ask()
        if not self._has_events:
            self._events.ask()

    @property
    def is_there(self) -> bool:
        """Whether the court has been heard in the last two seconds."""
        return self._heard_s is not None and time.monotonic() - self._heard_s < GONE_S

    @property
    def sheet(self) -> Sheet | None:
        """The court's newest sheet; None while the court is away, or a newer one is to come."""
        if self.health is None or not self.is_there or self.health.sheet != self._sheet.hash:
            return None
        return self._sheet.value

    @property
    def call(self) -> str | None:
        """Id of the call whose match the court has; "": it has no match; None: not known now."""
        sheet = self.sheet
        return None if sheet is None else sheet.call

    @property
    def phase(self) -> Phase | None:
        """Phase of the match that `sheet` describes; None: not known now."""
        sheet, frame = self.sheet, self.frame
        if sheet is None or frame is None or frame.match != sheet.match:
            return None
        return Phase(frame.phase)

    @property
    def missing(self) -> tuple[str, ...]:
        """Teams whose seats are empty or silent, in a match that has not begun."""
        if self.phase not in (Phase.LOBBY, Phase.READY):
            return ()
        assert self.frame is not None
        assert self.sheet is not None
        seats = zip(self.sheet.seats, self.frame.seats, strict=False)
        return tuple(
            seat.team
            for seat, now in seats
            if not now.flags & SeatFlag.JOINED or now.flags & SeatFlag.SILENT
        )

    @property
    def clock_s(self) -> float | None:
        """Time played in the match that `sheet` describes [s]; None: not known now."""
        if self.phase is None or self.frame is None:
            return None
        return self.frame.clock_ticks * BEAT_S

    @property
    def events(self) -> tuple[Event, ...]:
        """The newest events of the match that `sheet` describes; empty while they are not known."""
        if self.sheet is None or not self._has_events:
            return ()
        return self._events.value or ()

    @property
    def result(self) -> CourtResult | None:
        """The official result of the court's match; None: there is none, or it is not known."""
        sheet = self.sheet
        if sheet is None or not sheet.call:
            return None
        return result_of(sheet, self.events)

    @property
    def _has_events(self) -> bool:
        """Whether the office has the newest event that the court's health mentions.

        Also true if the court has no events.
        """
        health, events = self.health, self._events.value or ()
        if health is None or health.events == 0:
            return True
        newest = events[-1] if events else None
        return (
            newest is not None and newest.match == health.match and newest.number >= health.events
        )

    def _ask(self, what: str, request: OfficeRequest, kind: type[T]) -> Asked[T]:
        question = self._session.question(self._keys.office(what), encode(request), ANSWER_S)
        return Asked(question, kind, self._note)

    def _note(self, refusal: Refusal) -> None:
        self.is_superseded |= refusal.why == EARLIER_OFFICE


def result_of(sheet: Sheet, events: Sequence[Event]) -> CourtResult | None:
    """Read the official result from the events of a match; None if there is none yet."""
    phases = [event.data.get("after") for event in events if event.kind == "phase"]
    if not phases or phases[-1] not in (Phase.OFFICIAL.name, Phase.VOID.name):
        return None
    results = [event.data for event in events if event.kind == "result"]
    ruled = [
        event.data["arguments"]["winner"]
        for event in events
        if event.kind == "decision" and event.data.get("decision") == "declare"
    ]
    outcome, scores = "void", (0,) * len(sheet.seats)
    if phases[-1] == Phase.OFFICIAL.name:
        outcome = str(ruled[-1] if ruled else results[-1]["winner"])
        scores = tuple(results[-1]["scores"])
    return CourtResult(
        call=sheet.call,
        match_id=sheet.match_id,
        teams=tuple(seat.team for seat in sheet.seats),
        scores=scores,
        outcome=outcome,
        advice=advice(events),
    )


class _Fetched(Generic[T]):
    """Keeps the newest answer of a court to one kind of question, with the answer's hash."""

    def __init__(self, session: Session, key: str, kind: type[T]) -> None:
        self._session = session
        self._key = key
        self._kind = kind
        self._question: Question | None = None
        self.value: T | None = None
        self.hash = b""

    def ask(self) -> None:
        """Send the question, unless an answer to it is still awaited."""
        if self._question is None:
            self._question = self._session.question(self._key, timeout_s=_FETCH_S)

    def forget(self) -> None:
        """Drop the newest answer, and any that is still awaited."""
        self._question, self.value, self.hash = None, None, b""

    def take(self) -> bool:
        """Read an answer if one has come; return whether there is a new one that can be read."""
        try:
            answer = None if self._question is None else self._question.take()
            if answer is None:
                return False
            self.value, self.hash = (
                codec.decode(answer, self._kind, _MAX_BYTES),
                message_hash(answer),
            )
        except (NoReply, Refused, codec.BadMessage):  # whoever still needs it asks again
            self._question = None
            return False
        self._question = None
        return True


def _newest(mailbox: Mailbox, kind: type[T]) -> T | None:
    """Return the newest message in a mailbox; None: there is none, or it can't be decoded."""
    mail = mailbox.take()
    try:
        return None if mail is None else codec.decode(mail.payload, kind, _MAX_BYTES)
    except codec.BadMessage:
        return None
