"""The desk of the office: what it accepts and refuses, and when it answers."""

from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lacoc_server.doors.office_desk import OfficeDesk, WantedMatch
from lacoc_shared.codec import encode
from lacoc_shared.contest import tokens
from lacoc_shared.keyspace import ASSIGN_MAX_BYTES
from lacoc_shared.messages import Done, Refusal, SentFile
from lacoc_shared.messages.office import (
    EARLIER_OFFICE,
    Assign,
    AssignedSeat,
    Copied,
    Copy,
    Retire,
    Tell,
    Withdraw,
)
from lacoc_shared.seat import Phase
from lacoc_shared.words import Phrase, faults, say

OFFICE = "the token of the office"
HASH = tokens.new_token_hash(OFFICE)
SEATS = ("left", "right")
FINAL = say("fixture.final", stage=None)


def seat(name: str, team: str, **changes: Any) -> AssignedSeat:
    hashes = (tokens.new_token_hash(team),)
    return AssignedSeat(**({"id": name, "team": team, "token_hashes": hashes} | changes))


LEFT, RIGHT = seat("left", "Ants"), seat("right", "Bees")


def assign(call: str = "c1", **changes: Any) -> bytes:
    fields = {"token": OFFICE, "call": call, "fixture": FINAL, "seats": (LEFT, RIGHT)}
    return encode(Assign(**(fields | changes)))


def withdraw(
    call: str = "c1", token: str = OFFICE, begun: bool = False, official: bool = False
) -> bytes:
    return encode(Withdraw(token=token, call=call, begun=begun, official=official))


class Desk(OfficeDesk[str]):
    """A desk whose matches take as many beats to prepare as `takes` says."""

    def __init__(self, takes: int = 1, refusal: Refusal | None = None) -> None:
        super().__init__(HASH, SEATS, self._begin, lambda copy: lambda: Copied(file=copy.match_id))
        self.takes = takes
        self.prepared: list[str] = []
        self.hold("", Phase.LOBBY)
        self._refusal = refusal

    def _begin(self, assign: Assign) -> Callable[[], str | Refusal | None]:
        self.prepared.append(assign.call)
        left = iter(range(self.takes))
        return lambda: self._refusal or assign.call if next(left, None) is None else None

    def later(self, what: str, payload: bytes) -> Callable[[], Done | Copied | Refusal | None]:
        """Judge a request that gets no answer at once; return the function that gives one later."""
        answer = self.judge(what, payload)
        assert not isinstance(answer, Done | Copied | Refusal)
        return answer

    def refusal(self, what: str, payload: bytes) -> Phrase:
        """Judge a request that is refused at once, and return the reason."""
        answer = self.judge(what, payload)
        assert isinstance(answer, Refusal)
        assert faults(answer.why) == []
        return answer.why


def test_an_assignment_is_answered_when_its_match_is_open() -> None:
    """The desk waits for the files, then for the court's match, and only then answers `Done`."""
    desk = Desk(takes=2)
    answer = desk.later("assign", assign())
    assert [answer(), answer(), desk.wanted] == [None, None, None]
    assert answer() is None
    assert desk.wanted == WantedMatch("c1")
    assert answer() is None
    desk.hold("c1", Phase.LOBBY)
    assert (answer(), desk.wanted) == (Done(), None)


def test_a_call_that_comes_twice_is_prepared_once() -> None:
    """A call that is sent again is accepted at once, or refused if the court has another call."""
    desk = Desk()
    desk.hold("c1", Phase.LOBBY)
    for phase in (Phase.READY, Phase.PLAYING, Phase.OFFICIAL, Phase.VOID):
        desk.hold("c1", phase)
        assert desk.judge("assign", assign()) == Done()
    desk.hold("c2", Phase.LOBBY)
    assert desk.refusal("assign", assign()) == say("refused.call-is-over", call="c1")
    assert desk.prepared == []


def test_a_match_that_is_played_is_kept() -> None:
    """A match in play is neither replaced nor withdrawn, also if it began after the request."""
    desk = Desk(takes=0)
    desk.hold("c1", Phase.READY)
    replacing, withdrawing = desk.later("assign", assign("c2")), desk.later("withdraw", withdraw())
    assert replacing() is None
    desk.hold("c1", Phase.COUNTDOWN)
    busy = Refusal(say("refused.match-is-played", phase="countdown"), again=True)
    for answer in (replacing(), withdrawing()):
        assert (answer, desk.wanted) == (busy, None)
    assert desk.judge("assign", assign("c3")) == busy
    assert desk.judge("withdraw", withdraw()) == busy


def test_a_match_that_is_played_ends_if_the_office_says_so() -> None:
    """A match in play is withdrawn where the office asks for it; the court has to end it."""
    desk = Desk()
    desk.hold("c1", Phase.PLAYING)
    answer = desk.later("withdraw", withdraw(begun=True))
    assert (answer(), desk.wanted) == (None, WantedMatch(None, ends=True))
    desk.hold("", Phase.LOBBY)
    assert (answer(), desk.wanted) == (Done(), None)


def test_a_match_is_withdrawn() -> None:
    """A match that has not begun is withdrawn; the answer comes when the court has no match."""
    desk = Desk()
    desk.hold("c1", Phase.READY)
    answer = desk.later("withdraw", withdraw())
    assert (answer(), desk.wanted) == (None, WantedMatch(None))
    desk.hold("c1", Phase.VOID)
    assert (answer(), desk.wanted) == (None, WantedMatch(None))
    desk.hold("", Phase.LOBBY)
    assert (answer(), desk.wanted) == (Done(), None)
    assert desk.judge("withdraw", withdraw()) == Done()


def test_an_official_match_is_not_withdrawn() -> None:
    """A match with an official result can't be withdrawn, but another match can be assigned."""
    desk = Desk()
    desk.hold("c1", Phase.OFFICIAL)
    assert desk.refusal("withdraw", withdraw()) == say("refused.call-is-over", call="c1")
    desk.later("assign", assign("c2"))


def test_files_with_mistakes_are_refused() -> None:
    """If the files of a match are refused, the office gets this refusal, and it is counted."""
    refusal = Refusal(say("refused.assigned-files", team="Ants", count=1))
    desk = Desk(takes=0, refusal=refusal)
    answer = desk.later("assign", assign())
    assert (answer(), desk.wanted, desk.refused) == (refusal, None, {"bad-files": 1})


NAMELESS = SentFile("", b"")


@pytest.mark.parametrize(
    ("payload", "code"),
    [
        (assign(token="a guess"), "refused.no-office-token"),
        (assign(call=""), "refused.bad-request"),
        (assign(call="x" * 65), "refused.bad-request"),
        (assign(fixture=say("over.time")), "refused.bad-fixture"),
        (assign(fixture=Phrase("fixture.no-such")), "refused.bad-fixture"),
        (assign(fixture=say("fixture.named", name="x" * 3000)), "refused.bad-fixture"),
        (assign(seats=(LEFT,)), "refused.assigned-seats"),
        (assign(seats=(LEFT, seat("middle", "Bees"))), "refused.assigned-seats"),
        (assign(seats=(LEFT, seat("right", "Ants"))), "refused.same-team-twice"),
        (
            assign(seats=(LEFT, seat("right", "Bees", token_hashes=LEFT.token_hashes))),
            "refused.same-team-twice",
        ),
        (assign(seats=(LEFT, seat("right", "x" * 25))), "refused.team-name"),
        (assign(seats=(LEFT, seat("right", "Be\nes"))), "refused.team-name"),
        (assign(seats=(LEFT, seat("right", "Bees", robot=NAMELESS))), "refused.file-name"),
        (assign(seats=(LEFT, seat("right", "Bees", token_hashes=()))), "refused.bad-request"),
        (assign(seats=(LEFT, seat("right", "Bees", token_hashes=("x",)))), "refused.bad-request"),
        (assign(seats=(LEFT, seat("right", "Bees", colour="red"))), "refused.bad-request"),
        (encode({"token": OFFICE, "call": "c1", "more": 1}), "refused.bad-request"),
        (encode({"token": OFFICE}), "refused.bad-request"),
        (b"\xc1", "refused.bad-request"),
        (bytes(ASSIGN_MAX_BYTES + 1), "refused.bad-request"),
    ],
)
def test_a_wrong_assignment_is_refused_and_counted(payload: bytes, code: str) -> None:
    """A request with a wrong token or form is refused with the reason, and counted."""
    desk = Desk()
    assert desk.refusal("assign", payload).code == code
    assert desk.refused.total() == 1
    assert desk.prepared == []


def test_a_wrong_token_withdraws_nothing() -> None:
    """A wrong token withdraws nothing, and an unknown request is refused."""
    desk = Desk()
    desk.hold("c1", Phase.READY)
    assert desk.refusal("withdraw", withdraw(token="a guess")) == say("refused.no-office-token")
    assert desk.refusal("no-such", withdraw()).code == "refused.bad-request"
    assert desk.wanted is None


def test_the_reason_for_a_withdrawal_is_a_phrase_that_pages_can_say() -> None:
    """The reason of the office is kept for the court, without one that no page could say."""
    desk = Desk()
    desk.hold("c1", Phase.READY)
    long = say("recalled.decided", what=say("recalled.moved"), reason="x" * 2000)
    for wrong in (Phrase("no.such-phrase"), long):
        desk.later("withdraw", encode(Withdraw(token=OFFICE, call="c1", why=wrong)))()
        assert desk.wanted == WantedMatch(None)
    why = say("recalled.moved")
    desk.later("withdraw", encode(Withdraw(token=OFFICE, call="c1", why=why)))()
    assert desk.wanted == WantedMatch(None, why=why)


def test_an_official_match_is_closed_if_the_office_says_so() -> None:
    """The office that has the result closes the match, so that its record ends."""
    desk = Desk()
    desk.hold("c1", Phase.OFFICIAL)
    answer = desk.later("withdraw", withdraw(official=True))
    assert (answer(), desk.wanted) == (None, WantedMatch(None))
    desk.hold("", Phase.LOBBY)
    assert answer() == Done()


def test_only_the_office_copies_and_retires() -> None:
    """Parts of records, and the request to end, need the office's token."""
    desk = Desk()
    for what, request in (
        ("copy", Copy(token="a guess", match_id="m")),
        ("retire", Retire(token="x")),
    ):
        assert desk.refusal(what, encode(request)) == say("refused.no-office-token")
    assert not desk.retired
    assert desk.later("copy", encode(Copy(token=OFFICE, match_id="m")))() == Copied(file="m")
    assert desk.judge("retire", encode(Retire(token=OFFICE))) == Done()
    assert desk.retired


def test_an_earlier_office_is_refused() -> None:
    """From the first request of a later office on, the earlier one can't do anything.

    Whoever has no token changes nothing with a later generation.
    """
    desk = Desk()
    stranger = encode(Withdraw(token="a guess", call="c1", generation=9))
    assert desk.refusal("withdraw", stranger) == say("refused.no-office-token")
    answer = desk.later("assign", assign())
    later = encode(Withdraw(token=OFFICE, call="c9", generation=1))
    assert desk.judge("withdraw", later) == Done()
    requests = {
        "assign": assign("c2"),
        "withdraw": withdraw(),
        "tell": encode(Tell(token=OFFICE, teams={})),
        "copy": encode(Copy(token=OFFICE, match_id="m")),
        "retire": encode(Retire(token=OFFICE)),
    }
    for what, request in requests.items():
        assert desk.judge(what, request) == Refusal(EARLIER_OFFICE, again=True)
    assert not desk.retired
    assert desk.prepared == ["c1"]
    assert answer() is None


@given(st.sampled_from(["assign", "withdraw", "copy", "retire", "x"]), st.binary(max_size=300))
def test_no_bytes_ever_raise(what: str, payload: bytes) -> None:
    """No bytes make the desk raise an exception; it answers with a refusal."""
    assert isinstance(Desk().judge(what, payload), Refusal)
