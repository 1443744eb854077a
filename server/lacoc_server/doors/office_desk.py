"""The door for the office of a contest: it checks token and form of what the office assigns.

Pure: bytes come in, answers come out. What the office wants waits here until the court opens the
match. An answer comes only when the match is open and on disk, so the office may send a request
again whenever an answer did not arrive: the same call is accepted once.
"""

from collections import Counter, deque
from collections.abc import Callable, Sequence
from functools import partial
from typing import Annotated, Generic, NamedTuple, TypeVar

import msgspec

from lacoc_server.doors.inbox import FILE_NAME_MAX, NAME_MAX
from lacoc_server.doors.sessions import AnyToken, Why
from lacoc_server.doors.team_desk import TeamDesk
from lacoc_shared import codec, seal
from lacoc_shared.codec import encode
from lacoc_shared.keyspace import ASSIGN_MAX_BYTES
from lacoc_shared.messages import Done, Refusal
from lacoc_shared.messages.office import (
    EARLIER_OFFICE,
    Assign,
    AssignedSeat,
    Copied,
    Copy,
    Retire,
    Tell,
    Withdraw,
    call_is_over,
)
from lacoc_shared.mistakes import printable
from lacoc_shared.seat import Phase
from lacoc_shared.words import Phrase, faults, say

_PHRASE_BYTES = 2000
"""Most bytes of an encoded phrase of the office; every page gets it."""
_REMEMBERED = 256

_BEFORE = frozenset({Phase.CREATED, Phase.LOBBY, Phase.READY})
_OVER = frozenset({Phase.OFFICIAL, Phase.VOID})

T = TypeVar("T")

Prepare = Callable[[Assign], Callable[[], T | Refusal | None]]
"""Starts to load an arena and to weigh files in, beside the beats.

It returns a function that is called in each beat until it returns the prepared match, or a refusal.
"""
CopyPart = Callable[[Copy], Callable[[], Copied | Refusal | None]]
"""Starts to read a part of a record, beside the beats.

It returns a function that is called in each beat until it returns the part, or a refusal.
"""
_Reply = Done | Copied | Refusal
Answer = _Reply | Callable[[], _Reply | None]
"""An answer, or a function that is called in each beat until it returns one."""


class WantedMatch(NamedTuple, Generic[T]):
    """What the office wants the court to open next."""

    prepared: T | None
    """The prepared match; None: the court shall wait."""
    ends: bool = False
    """Whether to end a match that has begun; if False, only an unbegun match is replaced."""
    why: Phrase | None = None
    """Why the office takes the present match away; None: it gave no reason."""


class _OfficeToken(AnyToken):
    generation: Annotated[int, msgspec.Meta(ge=0)] = 0


class OfficeDesk(Generic[T]):
    """Checks and answers the requests of the office, one at a time.

    Args:
        token_hash: hash of the office's token.
        seats: names of the court's seats, in the arena's order.
        prepare: prepares a match.
        copy_part: reads a part of a record.
    """

    def __init__(
        self, token_hash: str, seats: Sequence[str], prepare: Prepare[T], copy_part: CopyPart
    ) -> None:
        self._token_hash = token_hash
        self._seats = tuple(seats)
        self._prepare = prepare
        self._copy_part = copy_part
        self.retired = False
        """Whether the court goes on at another machine, so that this process must end."""
        self.wanted: WantedMatch[T] | None = None
        """What the court shall open next, as soon as its match allows it; None: nothing."""
        self.teams = TeamDesk()
        """Answers teams with what the office tells."""
        self.refused: Counter[str] = Counter()
        """Number of refusals by `Why`."""
        self._generation = 0
        """Generation of the latest office that was heard."""
        self._call = ""
        self._phase = Phase.CREATED
        self._past: deque[str] = deque(maxlen=_REMEMBERED)
        """Calls whose matches this court has closed; a late request must not open one again."""

    def hold(self, call: str, phase: Phase) -> None:
        """Take note of the court's match, after each beat that is on disk.

        Args:
            call: call of the match; "": the office did not assign it.
            phase: phase of the match.
        """
        if self._call not in ("", call):
            self._past.append(self._call)
        if self._call != call:
            self.wanted = None  # it is open now
        self._call, self._phase = call, phase

    def judge(self, what: str, payload: bytes) -> Answer:
        """Judge a request.

        Args:
            what: the kind of the request, from its key expression: "assign", "withdraw", "tell",
                "copy" or "retire".
            payload: should be an `Assign`, a `Withdraw`, a `Tell`, a `Copy` or a `Retire`.
        """
        try:
            asking = codec.decode(payload, _OfficeToken, ASSIGN_MAX_BYTES)
            if not seal.verify_token(asking.token, self._token_hash):
                return self._refuse(Why.WRONG_TOKEN, say("refused.no-office-token"))
            if asking.generation < self._generation:
                self.refused[Why.OLD.value] += 1
                return Refusal(EARLIER_OFFICE, again=True)
            self._generation = asking.generation
            match what:
                case "assign":
                    return self._assign(codec.decode(payload, Assign, ASSIGN_MAX_BYTES))
                case "withdraw":
                    return self._withdraw(codec.decode(payload, Withdraw, ASSIGN_MAX_BYTES))
                case "tell":
                    self.teams.tell(codec.decode(payload, Tell, ASSIGN_MAX_BYTES).teams)
                    return Done()
                case "copy":
                    return self._copy_part(codec.decode(payload, Copy, ASSIGN_MAX_BYTES))
                case "retire":
                    codec.decode(payload, Retire, ASSIGN_MAX_BYTES)
                    self.retired = True
                    return Done()
        except codec.BadMessage as error:
            return self._refuse(Why.BAD_BYTES, say("refused.bad-request", error=str(error)))
        return self._refuse(Why.BAD_BYTES, say("refused.bad-request", error=what[:40]))

    def _assign(self, assign: Assign) -> Answer:
        if assign.call == self._call:
            return Done()
        if assign.call in self._past:
            return self._refuse(Why.OLD, call_is_over(assign.call))
        if (why := self._why_not(assign)) is not None:
            return self._refuse(Why.BAD_BYTES, why)
        if self._plays:
            return self._busy()
        return partial(self._prepared, assign.call, self._prepare(assign))

    def _prepared(
        self, call: str, prepared: Callable[[], T | Refusal | None]
    ) -> Done | Refusal | None:
        """Offer a match to the court (`wanted`) once it is prepared; return Done once it is open.

        Return None while the match is not open yet.
        """
        if self._call == call:
            return Done()
        if self._plays:  # it began while the next one was prepared
            self.wanted = None
            return self._busy()
        if self.wanted is None:
            found = prepared()
            if isinstance(found, Refusal):
                self.refused[Why.BAD_FILES.value] += 1
                return found
            self.wanted = None if found is None else WantedMatch(found)
        return None

    def _withdraw(self, request: Withdraw) -> Answer:
        why = request.why
        if why is not None and _wrong_phrase(why):  # the match must end all the same
            request = msgspec.structs.replace(request, why=None)
        return self._withdrawn(request) or partial(self._withdrawn, request)

    def _withdrawn(self, request: Withdraw) -> Done | Refusal | None:
        if self._call != request.call:
            return Done()
        if self._plays and not request.begun:
            self.wanted = None
            return self._busy()
        if self._phase is Phase.OFFICIAL and not request.official:
            return self._refuse(Why.OLD, call_is_over(request.call))
        self.wanted = WantedMatch(None, ends=request.begun, why=request.why)
        return None

    @property
    def _plays(self) -> bool:
        return self._phase not in _BEFORE and self._phase not in _OVER

    def _busy(self) -> Refusal:
        return Refusal(say("refused.match-is-played", phase=self._phase.word), again=True)

    def _why_not(self, assign: Assign) -> Phrase | None:
        """Say what is wrong with the form of an assignment; None if nothing is."""
        is_other = not assign.fixture.code.startswith("fixture.")
        if error := assign.fixture.code[:40] if is_other else _wrong_phrase(assign.fixture):
            return say("refused.bad-fixture", error=error)
        seats = [seat.id for seat in assign.seats]
        if sorted(seats) != sorted(self._seats):
            return say("refused.assigned-seats", found=seats[:20], seats=self._seats)
        hashes = [one for seat in assign.seats for one in {*seat.token_hashes}]
        teams = [seat.team for seat in assign.seats if seat.team]
        if len({*hashes}) < len(hashes) or len({*teams}) < len(teams):
            return say("refused.same-team-twice")
        return next(filter(None, map(_wrong_name, assign.seats)), None)

    def _refuse(self, why: Why, said: Phrase) -> Refusal:
        self.refused[why.value] += 1
        return Refusal(said)


def _wrong_phrase(phrase: Phrase) -> str:
    """Return what is wrong with a phrase of the office; "" if nothing is."""
    if len(encode(phrase)) > _PHRASE_BYTES:
        return phrase.code[:40]
    return next((fault[:200] for fault in faults(phrase)), "")


def _wrong_name(seat: AssignedSeat) -> Phrase | None:
    if (seat.team and not _is_name(seat.team, NAME_MAX)) or seat.team != seat.team.strip():
        return say("refused.team-name", most=NAME_MAX, name=printable(seat.team))
    if not all(_is_name(file.name, FILE_NAME_MAX) for file in seat.files if file is not None):
        return say("refused.file-name", most=FILE_NAME_MAX)
    return None


def _is_name(name: str, most: int) -> bool:
    return 0 < len(name) <= most and name.isprintable()
