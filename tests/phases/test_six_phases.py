"""Tests of the phases with facts of real trials: each task is met, or something is missing."""

import math
from collections.abc import Callable, Sequence

import msgspec
import pytest
from pupil import QUESTIONS, START

from lacoc_client.workshop.phases.evidence import (
    SAMPLE,
    Answered,
    By,
    CheckedGait,
    Coached,
    Compared,
    Edited,
    Evidence,
    Guessed,
    Hand,
    LegEdit,
    Named,
    Rows,
    TookStep,
    Tried,
    TriedNumber,
    Voted,
    WentToPhase,
    edited,
)
from lacoc_client.workshop.phases.facts import TrialFacts, differences
from lacoc_client.workshop.phases.phases import CREATIVE, PHASES, THREE_LEGS
from lacoc_client.workshop.phases.progress import progress
from lacoc_client.workshop.phases.proof.numbers import foot_guesses
from lacoc_client.workshop.phases.proof.questions import seam_question
from lacoc_shared.gait.tables import SAMPLE_KEYS, Posture, PostureTable, to_locomotion
from lacoc_shared.words import faults, render

Tries = Callable[..., TrialFacts]
Sample = dict[int, Posture]

ANSWER = Answered(phase=1, question="other-side", said=0, right=True)

pytestmark = pytest.mark.slow


def rows(postures: dict[int, Posture]) -> Rows:
    """Return postures as a table in degrees."""
    return {(key, 0): tuple(map(math.degrees, angles)) for key, angles in postures.items()}


def edit(before: dict[int, Posture], after: dict[int, Posture], by: By = "hand") -> Evidence:
    """Return the evidence of an edit from one table to another."""
    change = edited(rows(before), rows(after), "v", by)
    assert change is not None
    return change


def tried(facts: TrialFacts, table: Sample, keys: Sequence[int], version: str = "1") -> Tried:
    """Return the evidence of a trial of some rows of a table."""
    numbers = [
        TriedNumber(key, 0, joint % 6, joint // 6, math.degrees(angle), START[joint])
        for key in keys
        for joint, angle in enumerate(table[key])
        if abs(math.degrees(angle) - START[joint]) > 0.01
    ]
    return Tried(version=version, facts=facts, rows=tuple(keys), numbers=tuple(numbers))


def standing(sample: Sample, keys: Sequence[int]) -> dict[int, Posture]:
    """Return a table in which all keys have the standing posture of key 0."""
    return dict.fromkeys(keys, sample[0])


def codes(evidence: Sequence[Evidence], phase: int) -> set[str]:
    """Return the codes of the phrases that say what a phase still lacks."""
    return {phrase.code for phrase in progress(evidence).outcomes[phase].missing}


def test_phase_0_needs_all_steps_of_the_lesson() -> None:
    """Phase 0 needs an answer to each question of the lesson, and its last step."""
    steps: list[Evidence] = [
        TookStep(step=step, robot="hexapod", question=question, of=of, choice=0)
        for step, of in enumerate(QUESTIONS, start=1)
        for question in range(of)
    ]
    end = TookStep(step=len(QUESTIONS), robot="hexapod")

    assert codes([], 0) == {"phases.go-to"}
    assert codes(steps, 0) == codes([*steps[1:], end], 0) == {"phases.more-steps"}
    assert codes([*steps, end], 0) == {"phases.answer"}
    assert progress([*steps, end]).lesson_step == len(QUESTIONS)


def test_phase_1_needs_postures_of_one_leg_and_right_guesses(sample: Sample) -> None:
    """Phase 1 needs six postures of a leg, all three joints, and two right guesses of three.

    A guess counts only for a move that was not seen before.
    """
    table = {1: list(sample[0])}
    evidence: list[Evidence] = []
    for step in range(6):
        before = {1: tuple(table[1])}
        table[1][(0, 6, 12)[step % 3]] += math.radians(10)
        evidence.append(edit(before, {1: tuple(table[1])}))
        if step < 5:
            assert "phases.more-leg-postures" in codes(evidence, 1)
    assert codes(evidence, 1) == {"phases.more-guesses", "phases.more-right-guesses"}

    def guess(said: str, leg: int, after_deg: float = 30.0) -> Guessed:
        angles = {"before_deg": 10.0, "after_deg": after_deg}
        return Guessed(about="foot", said=said, was=("up",), leg=leg, level=1, of_legs=6, **angles)

    seen = [guess("up", 0), guess("up", 1), guess("up", 1), guess("up", 2, 15.0)]
    evidence += seen
    assert codes(evidence, 1) == {"phases.more-guesses", "phases.more-right-guesses"}
    evidence += [guess("down", 3), guess("down", 4)]
    assert codes(evidence, 1) == {"phases.more-right-guesses"}
    evidence += [guess("up", 5), guess("up", 5, -30.0)]
    assert codes(evidence, 1) == {"phases.answer"}
    assert progress([*evidence, ANSWER]).states == ("open", "met", *["open"] * 5)


def test_there_is_always_a_move_to_guess() -> None:
    """Whoever has seen all moves may guess any that is not one of the last six."""
    nudges = [
        LegEdit(1, 0, leg, (0, 1, 2), (angle,) * 3, (30.0 - angle,) * 3)
        for angle in (30.0, 0.0)
        for leg in range(6)
    ]
    all_seen = Edited(version="1", by="hand", legs=tuple(nudges))
    right = Guessed(about="foot", said="up", was=("up",), after_deg=30.0, of_legs=6)
    guesses = [
        msgspec.structs.replace(right, leg=leg, level=level)
        for level in (0, 1, 2)
        for leg in range(3)
    ]
    assert foot_guesses([all_seen, *guesses]) == guesses
    assert foot_guesses([all_seen, *guesses[:6], *guesses[:6]]) == guesses[:6]
    small = msgspec.structs.replace(guesses[0], after_deg=5.0)
    assert foot_guesses([small, guesses[0]]) == guesses[:1]


@pytest.mark.parametrize(
    ("rows", "turn", "name", "right"),
    [
        (range(1, 5), 0, "seam", "from row 4 to row 1"),
        (range(1, 5), 1, "half", "row 3"),
        (range(1, 21), 0, "seam", "from row 20 to row 1"),
        (range(1, 21), 1, "half", "row 11"),
        (range(1, 6), 1, "seam", "from row 5 to row 1"),
        ((1, 2, 1, 2), 1, "seam", "from row 2 to row 1"),
    ],
)
def test_phase_4_asks_what_has_an_answer(
    try_gait: Tries, sample: Sample, rows: Sequence[int], turn: int, name: str, right: str
) -> None:
    """A cycle of many rows has few choices; only an even one is asked for its half."""
    trial = Tried(version="1", facts=try_gait(sample, "B1", 1.0), rows=tuple(rows))
    asked = seam_question([trial], turn)
    assert asked.name == name
    assert [render(asked.choices[at]) for at in asked.right] == [right]
    assert len(set(asked.choices)) == len(asked.choices) <= 6


def test_phase_2_needs_an_own_tripod(try_gait: Tries, sample: Sample) -> None:
    """Phase 2 needs a trial on three feet, of a posture that the student typed in the phase."""
    start = standing(sample, range(5))
    own = start | {1: sample[1]}
    go = WentToPhase(phase=2)
    on_six = tried(try_gait(start, "A1", 3.0), start, [1])
    on_three = tried(try_gait(own, "A1", 3.0), own, [1])
    made = edit(start, own)

    assert codes([made, on_three], 2) == {"phases.go-to"}
    assert codes([go, made, on_six], 2) == {"phases.more-numbers", "phases.stand-longer"}
    assert codes([go, on_three], 2) == {"phases.more-numbers", "phases.foreign"}
    assert codes([go, edit(start, own, "paste"), on_three], 2) == {
        "phases.more-numbers",
        "phases.foreign",
    }
    pasted = [go, edit(start, own, "paste"), on_three]
    lacks = {one.code: render(one) for one in THREE_LEGS.look(pasted)[0].missing}
    assert " in row 1, " in lacks["phases.foreign"]
    assert codes([made, go, on_three], 2) == {"phases.more-numbers"}
    assert codes([go, on_three, made], 2) == {"phases.more-numbers", "phases.foreign"}
    assert codes([go, made, on_three], 2) == {"phases.answer"}
    assert THREE_LEGS.look([go, made, on_three, msgspec.structs.replace(ANSWER, phase=2)])[0].met


def test_phase_3_needs_two_postures_on_the_same_feet(try_gait: Tries, sample: Sample) -> None:
    """Phase 3 asks once two postures move the robot forward while the same feet stay down."""
    table = {key: sample[key] for key in range(5)}
    made = [WentToPhase(phase=3), edit(standing(sample, range(5)), table)]

    def missing(keys: str, *rows: int) -> set[str]:
        return codes([*made, tried(try_gait(table, keys, 1.5), table, rows)], 3)

    assert missing("A1:1, A2", 1, 2) == {"phases.answer"}
    assert missing("A3:1, A4", 3, 4) == {"phases.answer"}
    assert missing("A2:1, A1", 2, 1) == {"phases.went-back"}
    assert missing("A2:1, A3", 2, 3) == {"phases.farther", "phases.same-feet"}
    assert missing("A2", 2) == {"phases.two-postures"}


def test_phase_4_needs_a_gait_that_goes_on_and_on(try_gait: Tries, sample: Sample) -> None:
    """Phase 4 asks once the sample's walk was typed by hand; not by standing or by turning."""
    start = standing(sample, range(5))
    own = {key: sample[key] for key in range(5)}
    turning = {0: sample[0], **{key: sample[key + 4] for key in range(1, 5)}}
    go = WentToPhase(phase=4)

    def missing(table: dict[int, Posture]) -> set[str]:
        made = [edit(start, table)] if table is not start else []
        return codes([go, *made, tried(try_gait(table, "B1"), table, [1, 2, 3, 4])], 4)

    assert missing(own) == {"phases.answer"}
    assert missing(start) == {"phases.more-numbers-or-tools", "phases.farther"}
    assert missing(turning) == {"phases.went-back", "phases.turns"}
    walk = tried(try_gait(own, "B1"), own, [1, 2, 3, 4])
    assert codes([go, walk], 4) == {"phases.more-numbers-or-tools", "phases.foreign"}


def test_a_tool_helps_from_phase_4_on(try_gait: Tries, sample: Sample) -> None:
    """The second half of a gait may be made with a tool from numbers that were typed."""
    start = standing(sample, range(5))
    half = start | {1: sample[1], 2: sample[2]}
    own = {key: sample[key] for key in range(5)}
    walk = tried(try_gait(own, "B1"), own, [1, 2, 3, 4])
    typed, made = edit(start, half), edit(half, own, "tool")

    assert codes([typed, WentToPhase(phase=4), made, walk], 4) == {"phases.answer"}
    assert codes([WentToPhase(phase=4), made, walk], 4) == {
        "phases.more-numbers-or-tools",
        "phases.foreign",
    }


def test_phase_5_needs_another_walk_a_word_and_a_vote(try_gait: Tries, sample: Sample) -> None:
    """Phase 5 needs a walk of one's own that differs from the sample, a word and a vote."""
    calm = {key: tuple(0.6 * angle for angle in angles) for key, angles in sample.items()}
    walk, known = try_gait(calm, "B1"), try_gait(sample, "B1")
    differs = differences(walk, known)
    begun: list[Evidence] = [WentToPhase(phase=5), edit(sample, calm)]
    trial = tried(walk, calm, [1, 2, 3, 4])
    shown: list[Evidence] = [trial, Compared(version="1", against=SAMPLE, differs=differs)]
    agreed: list[Evidence] = [Named(word="calm"), Voted(poll="calm")]

    assert len(differs) >= 2
    assert codes([*begun, *agreed, *shown], 5) == {"phases.answer"}
    assert codes([*begun, *shown], 5) == {"phases.name-word", "phases.vote"}
    assert codes([begun[0], *agreed, *shown], 5) == {"phases.more-numbers"}
    assert codes([begun[0], edit(sample, calm, "coach"), *agreed, *shown], 5) == {
        "phases.more-numbers"
    }
    same = Compared(version="1", against=SAMPLE, differs=differences(known, known))
    assert codes([*begun, *agreed, trial, same], 5) == {"phases.more-different"}
    other = Compared(version="1", against="2", differs=differs)
    assert codes([*begun, *agreed, trial, other], 5) == {"phases.more-different"}


def test_phase_6_needs_a_checked_file_with_four_keys_that_act(
    try_gait: Tries, sample: Sample
) -> None:
    """Phase 6 needs a check without mistakes, and a trial of each of the four keys of that file."""
    file = to_locomotion(PostureTable(sample), SAMPLE_KEYS)
    checked = CheckedGait(version="1", keys=4, mistakes=0)
    other = dict.fromkeys(sample, (0.0,) * 18)
    begun: list[Evidence] = [WentToPhase(phase=6), edit(other, sample)]
    tries = [tried(try_gait(file, f"B{key}"), sample, SAMPLE_KEYS[key]) for key in range(4)]
    names = ["stand", "left", "forward", "right"]

    assert codes([*begun, checked, *tries], 6) == {"phases.answer"}
    assert codes([begun[0], checked, *tries], 6) == {"phases.more-numbers"}
    for key, name in enumerate(names):
        others = [one for index, one in enumerate(tries) if index != key]
        assert codes([*begun, checked, *others], 6) == {f"phases.key-{name}"}
    posture = tried(try_gait(sample, "A2", 1.0), sample, [2])
    assert len(CREATIVE.look([*begun, checked, posture])[0].missing) == 4  # each key is named once
    wrong = CheckedGait(version="1", keys=4, mistakes=2)
    assert codes([*begun, wrong, *tries], 6) == {"phases.check"}
    old = CheckedGait(version="2", keys=4, mistakes=0)
    assert codes([*begun, old, *tries], 6) == {"phases.check"}


def test_a_student_may_skip_and_come_back() -> None:
    """A student who goes to phase 4 skips phases 1 to 3, and may go back to phase 2.

    Phase 0 can be left out: it is skipped only if the student was there.
    """
    evidence = [WentToPhase(phase=4), WentToPhase(phase=2), Hand(up=True)]
    now = progress(evidence)

    assert now.phase == 2
    assert now.states == ("open", "skipped", "skipped", "skipped", "open", "open", "open")
    assert (now.hand_up, now.coached) == (True, False)
    later = progress([*evidence, Hand(up=False), Coached(version="2", size="cell")])
    assert (later.hand_up, later.coached) == (False, True)


def test_all_texts_are_in_both_languages() -> None:
    """Each text of a phase can be shown, and differs in English and Japanese."""
    for phase in PHASES:
        for phrase in (phase.title, phase.task, phase.question, phase.hint, phase.explanation):
            assert not faults(phrase)
            assert render(phrase, "ja") != render(phrase, "en")
    assert [phase.number for phase in PHASES] == [0, 1, 2, 3, 4, 5, 6]


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
