"""Tests of the rules over evidence: they count right, and more evidence never makes less done."""

import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lacoc_client.workshop.phases.evidence import (
    SAMPLE,
    Answered,
    CheckedGait,
    Coached,
    Compared,
    Edited,
    Evidence,
    Guessed,
    Hand,
    JoinedClass,
    LegEdit,
    Named,
    TookStep,
    Tried,
    TriedNumber,
    Voted,
    WentToPhase,
    edited,
    from_json,
    to_json,
)
from lacoc_client.workshop.phases.facts import TrialFacts
from lacoc_client.workshop.phases.phases import PHASES
from lacoc_client.workshop.phases.predicates import (
    MET,
    All,
    Bound,
    LastOf,
    Outcome,
    Times,
    TriedWhere,
    once,
)
from lacoc_client.workshop.phases.progress import progress
from lacoc_client.workshop.phases.proof.work import VersionWork
from lacoc_shared.words import Phrase, faults, render

NUMBERS = st.floats(-1000, 1000) | st.sampled_from([0.0, 1.0, 2.0, 5.0, 15.0, 100.0, math.nan])
SHORT = st.sampled_from(["1", "2", SAMPLE])


@st.composite
def facts(draw: st.DrawFn) -> TrialFacts:
    """Draw facts of a trial that often meet the conditions of a phase."""
    good = st.sampled_from
    return TrialFacts(
        keys=draw(good([("A1", "A2"), ("B2",), ("A1",), ("B0",)])),
        postures=draw(good([1, 4])),
        cycles=draw(good([0, 5])),
        cycle_s=draw(good([None, 1.4])),
        forward_mm=draw(good([0.0, 200.0]) | NUMBERS),
        left_mm=draw(good([0.0]) | NUMBERS),
        speed_mm_s=draw(good([0.0, 60.0]) | NUMBERS),
        drift_deg_s=draw(good([0.0, 20.0, -20.0]) | NUMBERS),
        upright=draw(good([1.0, 0.5, -1.0])),
        belly_share=draw(good([0.0, 0.02, 0.5])),
        margin_mm=draw(good([None, 20.0])),
        clearance_mm=draw(good([20.0]) | NUMBERS),
        duty=(0.5,) * 6,
        tripod_s=draw(good([0.0, 2.5, 1.0])),
        same_feet_share=draw(good([0.0, 0.5, 1.0])),
        seam_deg=draw(good([0.0, 40.0])),
        stopped=draw(good([False, False, True])),
    )


LEG_EDITS = st.builds(
    LegEdit,
    st.integers(0, 2),
    st.just(0),
    st.integers(0, 2),
    st.sampled_from([(0,), (1, 2), (0, 1, 2)]),
    st.tuples(*[st.integers(-3, 3).map(lambda step: 10.0 * step)] * 3),
    st.just(()) | st.tuples(*[st.integers(-3, 3).map(lambda step: 10.0 * step)] * 3),
)
NUMBERS_TRIED = st.lists(
    st.builds(
        TriedNumber,
        st.integers(0, 2),
        st.just(0),
        st.integers(0, 2),
        st.integers(0, 2),
        st.integers(-3, 3).map(lambda step: 10.0 * step),
        st.just(5.0),
    ),
    max_size=4,
).map(tuple)
EVIDENCE = st.one_of(
    st.builds(JoinedClass),
    st.builds(WentToPhase, phase=st.integers(-1, 8)),
    st.builds(
        Edited,
        version=SHORT,
        by=st.sampled_from(["hand", "tool", "paste", "coach"]),
        legs=st.lists(LEG_EDITS, max_size=6).map(tuple),
    ),
    st.builds(
        Guessed,
        about=st.sampled_from(["foot", "foot", "pace"]),
        said=st.sampled_from(["up", "down"]),
        was=st.just(("up",)),
        leg=st.integers(-1, 2),
        level=st.integers(-1, 2),
        before_deg=st.sampled_from([0.0, 30.0]),
        after_deg=st.sampled_from([10.0, 20.0]),
        of_legs=st.just(6),
    ),
    st.builds(
        Tried,
        version=SHORT,
        facts=facts(),
        rows=st.sampled_from([(), (1, 2, 3, 4)]),
        numbers=NUMBERS_TRIED,
    ),
    st.builds(
        TookStep,
        step=st.integers(0, 9),
        robot=SHORT,
        question=st.integers(-1, 1),
        of=st.just(1),
        choice=st.just(0),
        right=st.booleans(),
    ),
    st.builds(
        Answered,
        phase=st.integers(0, 6),
        question=st.just("margin"),
        said=st.integers(0, 3),
        right=st.booleans(),
    ),
    st.builds(
        CheckedGait, version=SHORT, keys=st.sampled_from([1, 4]), mistakes=st.sampled_from([0, 3])
    ),
    st.builds(
        Compared,
        version=SHORT,
        against=SHORT,
        differs=st.sampled_from([(), ("speed",), ("lift", "duty")]),
    ),
    st.builds(Named, word=st.just("shy")),
    st.builds(Voted, poll=st.just("shy")),
    st.builds(Coached, version=SHORT, size=st.sampled_from(["cell", "table"])),
    st.builds(Hand, up=st.booleans()),
)
LISTS = st.lists(EVIDENCE, max_size=30)


@given(LISTS)
def test_evidence_takes_nothing_back(evidence: list[Evidence]) -> None:
    """One more piece of evidence never makes the share of any phase smaller."""
    for phase in PHASES:
        shares = [phase.look(evidence[:count])[0].share for count in range(len(evidence) + 1)]
        assert shares == sorted(shares)


@given(LISTS)
def test_every_outcome_is_whole(evidence: list[Evidence]) -> None:
    """A phase's share is from 0 to 1, and 1 only if nothing is missing. All phrases have texts."""
    for phase in PHASES:
        outcome, question = phase.look(evidence)
        assert 0 <= outcome.share <= 1
        assert (question is not None) == (outcome.missing == (Phrase("phases.answer"),))
        if question is not None:
            said = (question.ask, *question.choices, question.because)
            assert not [fault for phrase in said for fault in faults(phrase)]
            assert len({render(choice) for choice in question.choices}) == len(question.choices)
            assert set() < question.right <= set(range(len(question.choices)))
        assert outcome.met == (outcome.share == 1)
        assert not [fault for phrase in outcome.missing for fault in faults(phrase)]
        assert all(map(render, outcome.missing))


@given(LISTS)
def test_progress_never_locks(evidence: list[Evidence]) -> None:
    """A student is at the phase visited last; each skipped phase is before the highest visited."""
    now = progress(evidence)
    visited = [
        one.phase for one in evidence if isinstance(one, WentToPhase) and 0 <= one.phase <= 6
    ]

    assert now.phase == (visited[-1] if visited else 1)
    for number, (state, outcome) in enumerate(zip(now.states, now.outcomes, strict=True)):
        assert (state == "met") == outcome.met
        assert state != "skipped" or number < max(visited)


@given(EVIDENCE)
def test_evidence_survives_json(evidence: Evidence) -> None:
    """Evidence that is written as JSON and read again is the same, except for NaN."""
    data = to_json(evidence)
    if b"null" not in data:
        assert from_json(data) == evidence


def guess(said: str) -> Guessed:
    return Guessed(about="foot", said=said, was=("up",))


def lacks(count: int) -> Phrase:
    return Phrase("phases.more-guesses", {"left": count})


IS_HAND = Times(lambda one: isinstance(one, Hand), 2, lacks)
IS_VOTE = once(lambda one: isinstance(one, Voted), Phrase("phases.vote"))
HAND, VOTE = Hand(up=True), Voted(poll="x")


def test_a_count_says_how_much_is_left() -> None:
    """A rule that asks for two raised hands and sees one has share 0.5, and reports one missing."""
    assert IS_HAND.look([HAND, VOTE]) == Outcome(0.5, (lacks(1),))
    assert IS_HAND.look([HAND, VOTE, HAND]) == MET


@pytest.mark.parametrize(
    ("answers", "share"),
    [("", 0), ("r", 0.5), ("rr", 1), ("rwr", 1), ("rwwr", 0.5), ("wwwrwwrr", 1), ("rrwww", 1)],
)
def test_two_of_the_last_three(answers: str, share: float) -> None:
    """The rule is met once two of any three answers in a row were right."""
    right = LastOf(lambda one: one.right if isinstance(one, Guessed) else None, 2, 3, lacks)
    evidence = [guess("up" if answer == "r" else "down") for answer in answers]

    assert right.look(evidence).share == share


def test_all() -> None:
    """`All` is met only if each of its rules is met, and lists what every rule lacks."""
    assert All(IS_HAND, IS_VOTE).look([HAND]).missing == (lacks(1), Phrase("phases.vote"))
    assert All(IS_HAND, IS_VOTE).look([HAND, HAND, VOTE]) == MET


def a_trial(version: str, **numbers: Any) -> Tried:
    usual: dict[str, Any] = dict.fromkeys(
        ("left_mm", "speed_mm_s", "drift_deg_s", "belly_share", "clearance_mm", "seam_deg"), 0.0
    )
    usual |= {"tripod_s": 0.0, "same_feet_share": 0.0, "forward_mm": 0.0, "upright": 1.0}
    usual |= {"keys": ("B2",), "postures": 4, "cycles": 5, "cycle_s": 1.0, "margin_mm": None}
    return Tried(version=version, facts=TrialFacts(**usual | numbers, duty=(), stopped=False))


FORWARD = Bound(
    lambda facts: facts.forward_mm,
    lambda found: Phrase("phases.farther", {"found_mm": found, "least_mm": 100.0}),
    least=100.0,
)
STRAIGHT = Bound(
    lambda facts: facts.drift_deg_s,
    lambda found: Phrase("phases.turns", {"found_deg_s": found, "most_deg_s": 3.0}),
    most=3.0,
)


def test_the_best_trial_says_what_is_missing() -> None:
    """One trial must keep all limits; if none does, the nearest trial says what is missing."""
    tried = TriedWhere((FORWARD, STRAIGHT), Phrase("phases.try"))
    far = a_trial("1", forward_mm=150.0, drift_deg_s=9.0)
    straight = a_trial("2", forward_mm=10.0)

    assert tried.look([]).missing == (Phrase("phases.try"),)
    assert [p.values["found_deg_s"] for p in tried.look([straight, far]).missing] == [9.0]
    assert tried.look([far, straight, a_trial("3", forward_mm=100.0, drift_deg_s=3.0)]) == MET
    assert not tried.look([a_trial("1", forward_mm=math.nan)]).met


def test_one_version_must_show_everything() -> None:
    """Two rules in `VersionWork` are met only by trials of the same version of the table."""
    turned = Bound(lambda facts: facts.drift_deg_s, lambda found: Phrase("phases.tipped"), least=5)
    none = Phrase("phases.try")
    both = VersionWork(All(TriedWhere((FORWARD,), none), TriedWhere((turned,), none)), numbers=0)
    ahead, left = {"forward_mm": 200.0}, {"drift_deg_s": 20.0}

    def is_met(*tries: Tried) -> bool:
        return both.look(tries, 0, again=False).met

    assert not is_met(a_trial("1", **ahead), a_trial("2", **left))
    assert is_met(a_trial("1", **ahead), a_trial("2"), a_trial("1", **left))
    assert not both.look([a_trial("1", **ahead), a_trial("1", **left)], 1, again=False).met


def test_an_edit_is_what_differs_between_two_tables() -> None:
    """An edit lists each changed leg with the changed joints and all three angles of the leg."""
    before = {(1, 0): tuple(map(float, range(18)))}
    row = list(before[1, 0])
    row[2], row[14] = 50.0, 60.0
    after = {(1, 0): tuple(row)}

    change = edited(before, after, "2", "hand")

    assert change == Edited(
        version="2",
        by="hand",
        legs=(LegEdit(1, 0, 2, (0, 2), (50.0, 8.0, 60.0), (2.0, 8.0, 14.0)),),
    )
    assert edited(after, after, "2", "hand") is None
    added = edited(before, {**before, (2, 0): (0.0,) * 12}, "3", "tool")
    assert added is not None
    assert [(leg.leg, leg.before_deg) for leg in added.legs] == [(n, ()) for n in range(4)]
    assert edited(after, {}, "4", "tool") is None


@given(LISTS, st.integers(0, 30))
def test_progress_can_go_on_from_an_earlier_one(evidence: list[Evidence], seen: int) -> None:
    """Progress that goes on from that of earlier evidence equals progress computed anew."""
    assert progress(evidence, progress(evidence[:seen])) == progress(evidence)
