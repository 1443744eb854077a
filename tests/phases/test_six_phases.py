"""Tests of the six phases with facts of real trials: each task is met, or something is missing."""

import math
from collections.abc import Callable, Sequence

import pytest

from lacoc_client.workshop.phases.evidence import (
    SAMPLE,
    By,
    CheckedGait,
    Coached,
    Compared,
    Evidence,
    Guessed,
    Hand,
    Named,
    Rows,
    Tried,
    Voted,
    WentToPhase,
    edited,
)
from lacoc_client.workshop.phases.facts import TrialFacts, differences
from lacoc_client.workshop.phases.phases import (
    A_CYCLE,
    CONCEPT,
    CREATIVE,
    HALF_CYCLE,
    PHASES,
    THREE_LEGS,
)
from lacoc_client.workshop.phases.progress import progress
from lacoc_shared.gait.tables import SAMPLE_KEYS, Posture, PostureTable, to_locomotion
from lacoc_shared.words import faults, render

Tries = Callable[..., TrialFacts]
Sample = dict[int, Posture]

pytestmark = pytest.mark.slow


def rows(postures: dict[int, Posture]) -> Rows:
    """Return postures as a table in degrees."""
    return {(key, 0): tuple(map(math.degrees, angles)) for key, angles in postures.items()}


def edit(before: dict[int, Posture], after: dict[int, Posture], by: By = "hand") -> Evidence:
    """Return the evidence of an edit from one table to another."""
    change = edited(rows(before), rows(after), "v", by)
    assert change is not None
    return change


def standing(sample: Sample, keys: Sequence[int]) -> dict[int, Posture]:
    """Return a table in which all keys have the standing posture of key 0."""
    return dict.fromkeys(keys, sample[0])


def codes(evidence: Sequence[Evidence], phase: int) -> set[str]:
    """Return the codes of the phrases that say what a phase still lacks."""
    return {phrase.code for phrase in progress(evidence).outcomes[phase - 1].missing}


def test_phase_1_needs_postures_of_one_leg_and_right_guesses(sample: Sample) -> None:
    """Phase 1 needs six postures of a leg, all three joints, and two right guesses of three."""
    table = {1: list(sample[0])}
    evidence: list[Evidence] = []
    for step in range(6):
        before = {1: tuple(table[1])}
        table[1][(0, 6, 12)[step % 3]] += math.radians(10)
        evidence.append(edit(before, {1: tuple(table[1])}))
        if step < 5:
            assert "phases.more-leg-postures" in codes(evidence, 1)
    assert codes(evidence, 1) == {"phases.more-guesses", "phases.more-right-guesses"}

    evidence += [Guessed(about="foot", said="up", was=("forward",))] * 2
    assert codes(evidence, 1) == {"phases.more-guesses", "phases.more-right-guesses"}
    evidence += [Guessed(about="foot", said="up", was=("forward", "up"))] * 2
    assert progress(evidence).states == ("met", *["open"] * 5)


def test_phase_2_needs_an_own_tripod(try_gait: Tries, sample: Sample) -> None:
    """Phase 2 needs a trial on three feet, after the student has made the posture by hand."""
    start = standing(sample, range(5))
    own = start | {1: sample[1]}
    on_six = Tried(version="1", facts=try_gait(start, "A1", 3.0))
    on_three = Tried(version="2", facts=try_gait(own, "A1", 3.0))
    made = edit(start, own)

    assert codes([made, on_six], 2) == {"phases.stand-longer"}
    assert codes([on_three], 2) == {"phases.more-cells"}
    assert codes([edit(start, own, "paste"), on_three], 2) == {"phases.more-cells"}
    assert codes([on_three, made], 2) == {"phases.try"}
    assert THREE_LEGS.look([made, on_three]).met


def test_phase_3_needs_two_postures_on_the_same_feet(try_gait: Tries, sample: Sample) -> None:
    """Phase 3 is met if two postures move the robot forward while the same feet stay down."""
    table = {key: sample[key] for key in range(5)}
    made = edit(standing(sample, range(5)), table)

    def missing(keys: str) -> set[str]:
        return codes([made, Tried(version="1", facts=try_gait(table, keys, 1.5))], 3)

    assert missing("A1:1, A2") == set()
    assert HALF_CYCLE.look([made, Tried(version="1", facts=try_gait(table, "A3:1, A4", 1.5))]).met
    assert missing("A2:1, A1") == {"phases.farther"}
    assert missing("A2:1, A3") == {"phases.farther", "phases.same-feet"}
    assert missing("A2") == {"phases.two-postures"}


def test_phase_4_needs_a_gait_that_goes_on_and_on(try_gait: Tries, sample: Sample) -> None:
    """Phase 4 is met by the sample's walk, made by hand; not by standing or by turning."""
    start = standing(sample, range(5))
    own = {key: sample[key] for key in range(5)}
    turning = {0: sample[0], **{key: sample[key + 4] for key in range(1, 5)}}
    made = edit(start, own)

    def missing(table: dict[int, Posture]) -> set[str]:
        return codes([made, Tried(version="1", facts=try_gait(table, "B1"))], 4)

    assert missing(own) == set()
    assert missing(start) == {"phases.farther"}
    assert missing(turning) == {"phases.farther", "phases.turns"}
    assert not A_CYCLE.look([Tried(version="1", facts=try_gait(own, "B1"))]).met


def test_phase_5_needs_another_walk_a_word_and_a_vote(try_gait: Tries, sample: Sample) -> None:
    """Phase 5 needs a walk that differs from the sample, a word and a vote."""
    calm = {key: tuple(0.6 * angle for angle in angles) for key, angles in sample.items()}
    walk, known = try_gait(calm, "B1"), try_gait(sample, "B1")
    differs = differences(walk, known)
    tried = [
        Tried(version="1", facts=walk),
        Compared(version="1", against=SAMPLE, differs=differs),
    ]
    agreed = [Named(word="calm"), Voted(poll="calm")]

    assert len(differs) >= 2
    assert CONCEPT.look([*agreed, *tried]).met
    assert codes(tried, 5) == {"phases.name-word", "phases.vote"}
    same = Compared(version="1", against=SAMPLE, differs=differences(known, known))
    assert codes([*agreed, tried[0], same], 5) == {"phases.more-different"}
    other = Compared(version="1", against="2", differs=differs)
    assert codes([*agreed, tried[0], other], 5) == {"phases.more-different"}


def test_phase_6_needs_a_checked_file_with_four_keys_that_act(
    try_gait: Tries, sample: Sample
) -> None:
    """Phase 6 needs a check without mistakes, and a trial of each of the four keys of that file."""
    file = to_locomotion(PostureTable(sample), SAMPLE_KEYS)
    checked = CheckedGait(version="1", keys=4, mistakes=0)
    tries = [Tried(version="1", facts=try_gait(file, f"B{key}")) for key in range(4)]
    names = ["stand", "left", "forward", "right"]

    assert CREATIVE.look([checked, *tries]).met
    for key, name in enumerate(names):
        others = [one for index, one in enumerate(tries) if index != key]
        assert codes([checked, *others], 6) == {f"phases.key-{name}"}
    posture = Tried(version="1", facts=try_gait(sample, "A2", 1.0))
    assert len(CREATIVE.look([checked, posture]).missing) == 4  # each key is named once
    assert codes([CheckedGait(version="1", keys=4, mistakes=2), *tries], 6) == {"phases.check"}
    assert codes([CheckedGait(version="2", keys=4, mistakes=0), *tries], 6) == {"phases.check"}


def test_a_student_may_skip_and_come_back() -> None:
    """A student who goes to phase 4 skips phases 1 to 3, and may go back to phase 2."""
    evidence = [WentToPhase(phase=4), WentToPhase(phase=2), Hand(up=True)]
    now = progress(evidence)

    assert now.phase == 2
    assert now.states == ("skipped", "skipped", "skipped", "open", "open", "open")
    assert (now.hand_up, now.coached) == (True, False)
    later = progress([*evidence, Hand(up=False), Coached(version="2", size="cell")])
    assert (later.hand_up, later.coached) == (False, True)


def test_all_texts_are_in_both_languages() -> None:
    """Each text of a phase can be shown, and differs in English and Japanese."""
    for phase in PHASES:
        for phrase in (phase.title, phase.task, phase.question, phase.hint, phase.explanation):
            assert not faults(phrase)
            assert render(phrase, "ja") != render(phrase, "en")
    assert [phase.number for phase in PHASES] == [1, 2, 3, 4, 5, 6]


def test_evidence_that_no_task_asks_for_changes_no_task() -> None:
    """Progress that is updated after each piece of evidence equals progress computed anew."""
    evidence: list[Evidence] = [Named(word="calm")]
    before = progress(evidence)
    for one in (
        WentToPhase(phase=5),
        Hand(up=True),
        Voted(poll="calm"),
        Hand(up=False),
        WentToPhase(phase=2),
    ):
        evidence.append(one)
        before = progress(evidence, before)
        assert before == progress(evidence)
