"""The referee's desk: which requests become decisions, and which are refused."""

import math
import secrets
from typing import Any

import pytest
from court_stub import make_scene
from hypothesis import given
from hypothesis import strategies as st
from waiting import LIMIT_S, until

from lacoc_server.doors.decision_desk import DecisionDesk
from lacoc_server.doors.inbox import Inbox
from lacoc_server.doors.network import CourtNetwork
from lacoc_shared import decisions as d
from lacoc_shared.codec import encode
from lacoc_shared.contest import tokens
from lacoc_shared.inputs import Decide
from lacoc_shared.keyspace import KeySpace
from lacoc_shared.messages import DecisionRequest, Done, Enter, OutlookRequest, Refusal
from lacoc_shared.network.session import open_client
from lacoc_shared.words import Phrase, faults, render, say

HASHES = [tokens.new_token_hash("other"), tokens.new_token_hash("whistle")]


def request(decision: d.Decision, token: str = "whistle", by: str = "Kubota") -> bytes:
    return encode(DecisionRequest(token=token, by=by, reason="foul", decision=decision))


def test_a_decision_becomes_an_input() -> None:
    """A request with a referee's token becomes an input with the referee's name and the reason."""
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
        ("start", request(d.Start(), by="Kim\x1b[2J"), "refused.who-decides", "bad-name"),
        ("clock", request(d.Clock(math.nan)), "refused.decision", "out-of-range"),
        ("clock", request(d.Clock(math.inf)), "refused.decision", "out-of-range"),
        ("adjust", request(d.Adjust("left", 2**40)), "refused.decision", "out-of-range"),
        ("start", b"\xc1", "refused.bad-request", "bad-bytes"),
    ],
)
def test_a_request_is_refused_with_its_reason(
    name: str, payload: bytes, code: str, why: str
) -> None:
    """A wrong request is refused with a reason, and the desk counts the refusal."""
    desk = DecisionDesk(HASHES)
    refusal = desk.decision(name, payload)
    assert isinstance(refusal, Refusal)
    assert (refusal.why.code, faults(refusal.why)) == (code, [])
    assert desk.refused == {why: 1}


def test_a_name_may_have_the_wide_space_of_japanese() -> None:
    """A referee's name is taken in its usual form, whatever space was typed."""
    taken = DecisionDesk(HASHES).decision("start", request(d.Start(), by="\u3000山田\u3000太郎 "))
    assert taken == Decide("山田 太郎", "foul", d.Start())


def test_the_refusal_of_a_wrong_decision_lists_all_decisions() -> None:
    """If a request's name and content are different decisions, the refusal lists all decisions."""
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
    """A reason is a text or a phrase of `reason.*`; any other phrase is refused."""
    asked = DecisionRequest(token="whistle", by="Kubota", reason=reason, decision=d.Start())
    judged = DecisionDesk(HASHES).decision("start", encode(asked))
    assert isinstance(judged, Decide) == taken


def test_a_wrong_token_learns_nothing() -> None:
    """The refusal of a wrong token reveals nothing about the decision."""
    refusal = DecisionDesk(HASHES).decision("x", encode({"token": "guess", "decision": 3}))
    assert refusal == Refusal(say("refused.no-referee-token"))


def test_a_token_can_be_shown_without_deciding() -> None:
    """The request `enter` tells whether a token is a referee's, without making a decision."""
    desk = DecisionDesk(HASHES)
    assert desk.enter(encode(Enter(token="whistle"))) == Done()
    refusal = Refusal(say("refused.no-referee-token"))
    assert desk.enter(encode(Enter(token="guess"))) == refusal
    assert isinstance(desk.enter(encode({"token": "whistle", "more": 1})), Refusal)
    assert desk.refused == {"wrong-token": 1, "bad-bytes": 1}


@pytest.mark.parametrize(
    ("asked", "why"),
    [
        ({"token": "guess"}, "wrong-token"),
        ({"token": "whistle", "seconds": 31.0}, "bad-bytes"),
        ({"token": "whistle", "seconds": math.nan}, "bad-bytes"),
        ({"token": "whistle", "seconds": 0}, "bad-bytes"),
        ({"token": "whistle", "decision": {"type": "bribe"}}, "bad-bytes"),
        ({"token": "whistle", "decision": {"type": "clock", "gives_s": math.inf}}, "out-of-range"),
    ],
)
def test_an_outlook_is_refused_with_its_reason(asked: dict[str, Any], why: str) -> None:
    """A request for an outlook needs a referee's token, a real decision and sane numbers."""
    desk = DecisionDesk(HASHES)
    refusal = desk.outlook(encode(asked))
    assert isinstance(refusal, Refusal)
    assert faults(refusal.why) == []
    assert desk.refused == {why: 1}


def test_an_outlook_is_passed_on() -> None:
    """A request for an outlook has ten seconds and no decision if it names none."""
    asked = DecisionDesk(HASHES).outlook(encode({"token": "whistle"}))
    assert asked == OutlookRequest(token="whistle", decision=None, seconds=10.0)


@given(st.text(), st.binary(max_size=300))
def test_no_bytes_ever_raise(name: str, payload: bytes) -> None:
    """No bytes make the desk raise an exception; it answers with a refusal."""
    assert isinstance(DecisionDesk(HASHES).outlook(payload), Refusal)
    assert isinstance(DecisionDesk(HASHES).decision(name, payload), Refusal)
    assert isinstance(DecisionDesk(HASHES).enter(payload), Refusal)


def test_a_flood_of_wrong_tokens_pushes_no_decision_out() -> None:
    """Among the requests of two beats of a flood, the referee's is heard in the next beat."""
    keys = KeySpace("main")
    inbox = Inbox(keys, ["left", "right"], lambda join, held: (join, ()), secrets.token_bytes)
    with (
        CourtNetwork(keys, ["tcp/127.0.0.1:0"], inbox, DecisionDesk(HASHES)) as court,
        open_client([court.locators[0]]) as client,
    ):
        court.publish_scene(make_scene("a"))
        key = keys.decision("halt")
        wrong, right = (request(d.Halt(), token=token) for token in ("guess", "whistle"))
        asked = [
            client.question(key, one, LIMIT_S) for one in [*[wrong] * 25, right, *[wrong] * 35]
        ]
        scene = client.question(keys.scene, b"", LIMIT_S)

        def has_come() -> bool:
            court._serve_fetches()
            return scene.take() is not None

        until(has_come)  # requests come in their order: then all have come
        (arrival,) = court.poll(0.0, 1, 1, [True, True])
        assert isinstance(arrival.input, Decide)
        assert arrival.answer is not None
        arrival.answer(Done())
        assert asked[25].wait()
