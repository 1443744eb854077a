"""The referee's desk: whom the court listens to."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lacoc_server.doors.decision_desk import DecisionDesk
from lacoc_shared import decisions as d
from lacoc_shared.codec import encode
from lacoc_shared.contest import tokens
from lacoc_shared.inputs import Decide
from lacoc_shared.messages import DecisionRequest, Done, Enter, Refusal
from lacoc_shared.words import Phrase, faults, render, say

HASHES = [tokens.hash_token("other"), tokens.hash_token("whistle")]


def request(decision: d.Decision, token: str = "whistle", by: str = "Kubota") -> bytes:
    return encode(DecisionRequest(token=token, by=by, reason="foul", decision=decision))


def test_a_decision_becomes_an_input() -> None:
    """Rules 4: each decision has the referee's name and the reason."""
    taken = DecisionDesk(HASHES).decision("adjust", request(d.Adjust("left", -2)))
    assert taken == Decide("Kubota", "foul", d.Adjust("left", -2))


@pytest.mark.parametrize(
    ("name", "payload", "code", "why"),
    [
        ("start", request(d.Start(), token="guess"), "refused.no-referee-token", "wrong-token"),
        ("halt", request(d.Start()), "refused.bad-decision", "bad-decision"),
        (
            "bribe",
            encode({"token": "whistle", "by": "K", "decision": {"type": "bribe"}}),
            "refused.bad-decision",
            "bad-decision",
        ),
        (
            "freeze",
            encode({"token": "whistle", "by": "K", "decision": {"type": "freeze", "seat": 3}}),
            "refused.bad-decision",
            "bad-decision",
        ),
        ("start", encode({"token": "whistle"}), "refused.bad-decision", "bad-decision"),
        ("start", request(d.Start(), by=" "), "refused.who-decides", "bad-name"),
        ("clock", request(d.Clock(math.nan)), "refused.decision", "out-of-range"),
        ("clock", request(d.Clock(math.inf)), "refused.decision", "out-of-range"),
        ("adjust", request(d.Adjust("left", 2**40)), "refused.decision", "out-of-range"),
        ("start", b"\xc1", "refused.bad-request", "bad-bytes"),
    ],
)
def test_a_request_is_refused_with_its_reason(
    name: str, payload: bytes, code: str, why: str
) -> None:
    """The answer says what was found and, if useful, all valid values."""
    desk = DecisionDesk(HASHES)
    refusal = desk.decision(name, payload)
    assert isinstance(refusal, Refusal)
    assert (refusal.why.code, faults(refusal.why)) == (code, [])
    assert desk.refused == {why: 1}


def test_a_decision_that_is_not_read_is_told_all_there_are() -> None:
    """The answer says what was wrong, and lists each decision with its arguments."""
    refusal = DecisionDesk(HASHES).decision("halt", request(d.Start()))
    assert isinstance(refusal, Refusal)
    words = render(refusal.why)
    assert "no decision 'start' under 'halt'" in words
    assert "ready (seat: str), start, halt" in words
    assert "freeze (seat: str, seconds: float)" in words


@pytest.mark.parametrize(
    ("reason", "taken"),
    [
        ("foul", True),
        (say("reason.stuck", note="left leg"), True),
        (say("reason.stuck", note=None), True),
        (say("event.heard", team="Ants"), False),
        (say("reason.stuck", note=say("reason.stuck", note="x")), False),
    ],
)
def test_a_reason_is_a_text_or_one_of_the_pages(reason: Phrase | str, taken: bool) -> None:
    """Nobody lets the court say another sentence in the record."""
    asked = DecisionRequest(token="whistle", by="Kubota", reason=reason, decision=d.Start())
    judged = DecisionDesk(HASHES).decision("start", encode(asked))
    assert isinstance(judged, Decide) == taken


def test_a_wrong_token_learns_nothing() -> None:
    """Only referees learn which values exist."""
    refusal = DecisionDesk(HASHES).decision("x", encode({"token": "guess", "decision": 3}))
    assert refusal == Refusal(say("refused.no-referee-token"))


def test_a_token_can_be_shown_without_deciding() -> None:
    """A page asks whether it may referee before it shows buttons."""
    desk = DecisionDesk(HASHES)
    assert desk.enter(encode(Enter(token="whistle"))) == Done()
    refusal = Refusal(say("refused.no-referee-token"))
    assert desk.enter(encode(Enter(token="guess"))) == refusal
    assert isinstance(desk.enter(encode({"token": "whistle", "more": 1})), Refusal)
    assert desk.refused == {"wrong-token": 1, "bad-bytes": 1}


@given(st.text(), st.binary(max_size=300))
def test_no_bytes_ever_raise(name: str, payload: bytes) -> None:
    """Failure policy: bad bytes are dropped and counted."""
    assert isinstance(DecisionDesk(HASHES).decision(name, payload), Refusal)
    assert isinstance(DecisionDesk(HASHES).enter(payload), Refusal)
