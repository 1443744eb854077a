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

HASHES = [tokens.hash_token("other"), tokens.hash_token("whistle")]


def request(decision: d.Decision, token: str = "whistle", by: str = "Kubota") -> bytes:
    return encode(DecisionRequest(token=token, by=by, reason="foul", decision=decision))


def test_a_decision_becomes_an_input() -> None:
    """Rules 4: each decision with who and reason."""
    taken = DecisionDesk(HASHES).decision("adjust", request(d.Adjust("left", -2)))
    assert taken == Decide("Kubota", "foul", d.Adjust("left", -2))


@pytest.mark.parametrize(
    ("name", "payload", "words", "why"),
    [
        ("start", request(d.Start(), token="guess"), "not a referee's token", "wrong token"),
        ("halt", request(d.Start()), "no decision 'start' under 'halt'", "bad decision"),
        (
            "bribe",
            encode({"token": "whistle", "by": "K", "decision": {"type": "bribe"}}),
            "There are: ready (seat: str), start, halt",
            "bad decision",
        ),
        (
            "freeze",
            encode({"token": "whistle", "by": "K", "decision": {"type": "freeze", "seat": 3}}),
            "freeze (seat: str, seconds: float)",
            "bad decision",
        ),
        ("start", encode({"token": "whistle"}), "not understood", "bad decision"),
        ("start", request(d.Start(), by=" "), "who decides", "bad name"),
        ("clock", request(d.Clock(math.nan)), "beyond", "out of range"),
        ("clock", request(d.Clock(math.inf)), "beyond", "out of range"),
        ("adjust", request(d.Adjust("left", 2**40)), "beyond", "out of range"),
        ("start", b"\xc1", "not understood", "bad bytes"),
    ],
)
def test_a_request_is_refused_with_its_reason(
    name: str, payload: bytes, words: str, why: str
) -> None:
    """The answer says what was found and, where it helps, all that there is."""
    desk = DecisionDesk(HASHES)
    refusal = desk.decision(name, payload)
    assert isinstance(refusal, Refusal)
    assert words in refusal.reason
    assert desk.refused == {why: 1}


def test_a_wrong_token_learns_nothing() -> None:
    """What exists is told to referees only."""
    refusal = DecisionDesk(HASHES).decision("x", encode({"token": "guess", "decision": 3}))
    assert refusal == Refusal("This is not a referee's token of this court.")


def test_a_token_can_be_shown_without_deciding() -> None:
    """A page asks whether it may referee before it shows buttons."""
    desk = DecisionDesk(HASHES)
    assert desk.enter(encode(Enter(token="whistle"))) == Done()
    refusal = Refusal("This is not a referee's token of this court.")
    assert desk.enter(encode(Enter(token="guess"))) == refusal
    assert isinstance(desk.enter(encode({"token": "whistle", "more": 1})), Refusal)
    assert desk.refused == {"wrong token": 1, "bad bytes": 1}


@given(st.text(), st.binary(max_size=300))
def test_no_bytes_ever_raise(name: str, payload: bytes) -> None:
    """Failure policy: bad bytes are dropped and counted."""
    assert isinstance(DecisionDesk(HASHES).decision(name, payload), Refusal)
    assert isinstance(DecisionDesk(HASHES).enter(payload), Refusal)
