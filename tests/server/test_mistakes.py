"""Tests of reasons and repairs: a table with one mistake, of which it is known where it is."""

import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from every_third import every_third
from mistaken_tables import (
    GOOD,
    KEY,
    KINDS,
    Mistaken,
    beginners,
    change_of,
    mistaken,
    repaired,
    sequence_of,
    told,
)
from sample_walks import course_of, entry_of

from lacoc_server.studio.answers import try_gait
from lacoc_server.studio.coach.coach import task_of
from lacoc_server.studio.coach.goal import goal_score
from lacoc_server.studio.coach.harm import harm, worse
from lacoc_server.studio.coach.trials import try_table
from lacoc_server.trial.reasons.form import KeyForm
from lacoc_server.trial.reasons.goal import Goal
from lacoc_server.trial.reasons.likely import likely_mistake, weigh_repairs
from lacoc_shared.gait.tables import Gait, Level, PostureTable
from lacoc_shared.studio import Sentence
from lacoc_shared.words import render

BEGINNERS = list(beginners())
TABLES = ["sample", pytest.param("tripod", marks=pytest.mark.long)]


@pytest.mark.slow
@pytest.mark.parametrize(
    "index", every_third(range(len(BEGINNERS))), ids=[one.kind for one, _ in BEGINNERS]
)
def test_the_first_sentence_names_a_beginners_mistake(index: int) -> None:
    """The first sentence names the mistake of a beginner's table, and points at a wrong cell."""
    found = told(*BEGINNERS[index])
    assert found.named, found
    assert found.pointed, found


@pytest.mark.slow
@pytest.mark.parametrize(
    "kind",
    [
        "zeros",
        pytest.param("2nd -40", marks=pytest.mark.long),
        pytest.param("rows 2, 3 changed", marks=pytest.mark.long),
        pytest.param("left Roots' signs", marks=pytest.mark.long),
    ],
)
def test_the_coach_repairs_a_beginners_mistake(kind: str) -> None:
    """What the coach repairs, in physics, brings back nine tenths of the lost speed."""
    found = repaired(*next(one for one in BEGINNERS if one[0].kind == kind))
    assert found.lost
    assert found.back, found


LEFT = slice(3, 6)
ADVICE = {"dragged", "backward", "out-of-step"}
"""Sentences that tell what a single leg should do otherwise."""


@pytest.mark.parametrize("table", TABLES)
@pytest.mark.parametrize(
    ("kind", "change", "code"),
    [
        ("60 everywhere", lambda t: t[:, 1].fill(60), "none-reaches"),
        ("45 more", lambda t: np.add(t[:, 1], 45, out=t[:, 1]), "none-reaches"),
        (
            "60, and the left Roots' signs",
            lambda t: (t[:, 1].fill(60), np.negative(t[:, 0, LEFT], out=t[:, 0, LEFT])),
            "none-reaches",
        ),
        (
            "45 more, but not L,C",
            lambda t: np.add(t[:, 1], [45, 45, 45, 45, -60, 45], out=t[:, 1]),
            "few-reach",
        ),
    ],
)
def test_feet_that_never_reach_the_floor_are_named_first(
    table: str, kind: str, change: Any, code: str
) -> None:
    """If too few feet reach the floor, the first sentence says so and points at a 1st number.

    No sentence tells what feet in the air should do otherwise.
    """
    found = told(change_of(table, kind, change), (code,))
    assert found.named, found
    assert found.pointed, found
    assert found.level == 1, found
    assert not {"no-lift", "all-lifted", "unstable", *ADVICE} & set(found.codes), found
    if code == "none-reaches":
        assert "no-feet" in found.codes, found
        assert "belly" not in found.codes, found


@pytest.mark.parametrize("table", TABLES)
@pytest.mark.parametrize(
    ("kind", "change", "code"),
    [
        ("rows 1, 2 in the air", lambda t: np.add(t[:2, 1], 50, out=t[:2, 1]), "wrong-mirror"),
        ("row 1 in the air", lambda t: np.add(t[0, 1], 50, out=t[0, 1]), "odd-row"),
        ("left in the air", lambda t: t[:, 1, LEFT].fill(60), "odd-side"),
        ("1st signs", lambda t: np.negative(t[:, 1], out=t[:, 1]), "lift-sign"),
        ("left 1st signs", lambda t: np.negative(t[:, 1, LEFT], out=t[:, 1, LEFT]), "side-sign"),
        ("left Roots", lambda t: np.negative(t[:, 0, LEFT], out=t[:, 0, LEFT]), "side-sign"),
        ("rows 3, 4 copied", lambda t: np.copyto(t[2:], t[:2]), "wrong-mirror"),
    ],
)
def test_beside_a_mistake_of_many_numbers_no_leg_is_advised(
    table: str, kind: str, change: Any, code: str
) -> None:
    """What a leg does because of a mistake of many numbers is no advice beside that mistake."""
    found = told(change_of(table, kind, change), (code,))
    assert found.named, found
    assert found.pointed, found
    assert not ADVICE & set(found.codes), found
    # Opposite signs push a side back; it does not only push less.
    assert "turns" not in found.codes or kind != "left Roots", found
    assert "opposed" not in found.codes or kind == "left Roots", found


@pytest.mark.parametrize(
    ("first_deg", "second_deg", "hangs"),
    [(20, 40, False), (0, 80, False), (0, 90, False), (40, 40, True), (60, 40, True)],
)
def test_feet_that_stand_are_not_said_to_hang(first_deg: int, second_deg: int, hangs: bool) -> None:
    """A shank reaches the floor with all of its thickness, also if its axis ends too high."""
    posture = posture_of(first_deg, second_deg)
    mistake = likely_mistake(form_of("hexapod", posture[None], Level.POSTURE))
    assert (mistake is not None) == hangs


def test_a_body_that_leans_onto_its_feet_is_not_said_to_hang() -> None:
    """If feet stand in the trial, the table's few feet that reach the floor are no reason."""
    posture = posture_of(44, -5)
    lean_deg = (0, -25, 7, -12, 3, -4)
    posture[1] += lean_deg
    posture[2] -= lean_deg
    trial = try_gait(course_of("hexapod"), level_a(posture), "A1", 3.0)
    mistake = likely_mistake(form_of("hexapod", posture[None], Level.POSTURE))
    assert mistake is not None
    assert mistake.said.code == "explain.few-reach"
    assert trial.figures.belly_share < 0.5
    assert trial.figures.few_feet_share < 0.5
    assert "few-reach" not in codes_of(trial.explained)


@pytest.mark.parametrize(
    ("rows", "wrong", "others"),
    [
        (slice(None), (), ()),
        (LEFT, ("L,B", "L,F"), ("R,C",)),
        (slice(3), ("R,C",), ("L,B", "L,F")),
    ],
)
def test_feet_that_push_back_in_half_a_cycle_are_named(
    rows: slice, wrong: tuple[str, ...], others: tuple[str, ...]
) -> None:
    """From one posture of level A to the next, the feet that push the body back are named first."""
    half = GOOD["tripod"][1]()[:2]
    if wrong:
        half[:, 0, rows] *= -1
    explained = try_gait(course_of("hexapod"), level_a(*half), "A1:1, A2", 1.5).explained
    if not wrong:
        assert "half-back" not in codes_of(explained)
        return
    said = explained[0].said
    assert said.code == "explain.half-back"
    assert (said.values["legs"], said.values["others"]) == (wrong, others)
    assert explained[0].cell is not None
    assert explained[0].cell.joint in [entry_of("hexapod").robot.labels.index(leg) for leg in wrong]
    assert "row 1" in render(said)
    assert "row 2" in render(said)


@pytest.mark.parametrize("table", TABLES)
def test_two_postures_with_the_same_feet_have_no_wrong_number(table: str) -> None:
    """If the same feet carry in both postures, others are missing: nothing is to be changed."""
    good = GOOD[table][1]()
    found = told(Mistaken("hexapod", "rows", good[:2], set(), good), ("same-feet",))
    assert found.named, found
    assert not {"odd-row", "wrong-mirror", "swapped-rows", *ADVICE} & set(found.codes), found
    repairs = weigh_repairs(form_of("hexapod", good[:2]))
    assert [one.repair.form.angles_deg.tolist() for one in repairs] == [good[:2].tolist()]


@pytest.mark.parametrize("name", every_third(["sample", "tripod", "octopod"]))
@pytest.mark.parametrize("row", range(4))
def test_a_missing_posture_is_named(name: str, row: int) -> None:
    """Without one of four postures, the step in which it is left out is named first."""
    robot, make = GOOD[name]
    good = make()
    found = told(Mistaken(robot, "missing", np.delete(good, row, axis=0), set(), good), ())
    assert found.code == "missing-posture", found
    one, other = (row - 1) % 3 + 1, row % 3 + 1
    assert f"From posture {one} to posture {other} " in found.sentences[0], found


@pytest.mark.parametrize("name", GOOD)
def test_a_good_gait_misses_nothing(name: str) -> None:
    """In a good gait no posture is said to be missing, and no joint jumps at the seam."""
    robot, make = GOOD[name]
    found = told(Mistaken(robot, "good", make(), set(), make()), ())
    assert not {"missing-posture", "same-feet", "seam"} & set(found.codes), found


@pytest.mark.parametrize(
    ("table", "change", "code", "cell"),
    [
        ("tripod", lambda t: np.add(t[:, 0], -30, out=t[:, 0]), "unstable", "L,B 1st"),
        ("sample", lambda t: np.add(t[:, 1], 15, out=t[:, 1]), "belly", " 1st"),
    ],
)
def test_a_figure_has_a_number_behind_it(table: str, change: Any, code: str, cell: str) -> None:
    """A robot that loses balance, or rests on its body, has a number that can be changed."""
    found = told(change_of(table, code, change), ())
    assert cell in found.sentences[found.codes.index(code)], found


def test_no_space_is_between_japanese_words() -> None:
    """In Japanese sentences spaces are only beside Latin letters and digits."""
    for one, _ in BEGINNERS:
        mistake = likely_mistake(form_of(one.robot, one.table_deg))
        assert mistake is not None
        said = render(mistake.said, "ja")
        assert not re.search(r"[^ -~] [^ -~]", said), said


@pytest.mark.parametrize("kind", every_third(KINDS))
def test_most_mistakes_by_chance_are_found_in_the_table(kind: str) -> None:
    """In four of five tables or more, the mistake that is found has a wrong cell."""
    first = list(KINDS).index(kind)
    tables = [mistaken(seed) for seed in range(first, 150, len(KINDS))]
    found = [likely_mistake(form_of(one.robot, one.table_deg)) for one in tables]
    right = [
        mistake is not None and mistake.cell in one.cells
        for mistake, one in zip(found, tables, strict=True)
    ]
    # A joint that does too little is often no mistake: then nothing is found.
    assert sum(right) >= (0.5 if kind == "scale" else 0.8) * len(right)


@pytest.mark.parametrize("name", GOOD)
def test_a_good_table_has_no_mistake(name: str) -> None:
    """In a good table nothing is found, and there is nothing to repair."""
    robot, make = GOOD[name]
    form = form_of(robot, make())
    assert likely_mistake(form) is None
    assert weigh_repairs(form) == []


@pytest.mark.parametrize(("key", "goal"), [(1, Goal.LEFT), (3, Goal.RIGHT)])
def test_a_turn_is_no_mistake(key: int, goal: Goal) -> None:
    """The sample's keys for turning have no mistake, though their sides differ."""
    entry = entry_of("hexapod")
    sequence = entry.gait.sequence(1, key)  # type: ignore[arg-type]
    assert sequence is not None
    assert likely_mistake(KeyForm.of(entry.robot, sequence, goal, key)) is None


def test_what_became_worse_is_known() -> None:
    """A figure in sight that fell is named, and costs more than any gain."""
    entry = entry_of("hexapod")
    task = task_of(entry.robot, entry.gait, KEY, Goal.FORWARD, None)
    before = try_table(task, task.table.angles_deg)
    faster = replace(before, speed_mm_s=before.speed_mm_s + 20)
    assert worse(before, faster, Goal.FORWARD) == ()
    assert harm(before, faster, Goal.FORWARD, everything=True) == 0
    tilted = replace(faster, margin_mm=5.0, drift_deg_s=4.0)
    assert worse(before, tilted, Goal.FORWARD) == ("drift_deg_s", "margin_mm")
    assert harm(before, tilted, Goal.FORWARD, everything=True) > 1
    assert harm(before, tilted, Goal.FORWARD, everything=False) == 0
    # A better score with a lower speed is no gain, also for a robot that hardly walks.
    turning = replace(before, speed_mm_s=-1.0, drift_deg_s=40.0)
    slower = replace(before, speed_mm_s=-6.0)
    assert goal_score(slower, Goal.FORWARD) > goal_score(turning, Goal.FORWARD)
    assert harm(turning, slower, Goal.FORWARD, everything=False) >= 5


def form_of(robot: str, table_deg: np.ndarray, level: Level = Level.LOCOMOTION) -> KeyForm:
    """Return the form of a table that should go forward."""
    return KeyForm.of(entry_of(robot).robot, sequence_of(table_deg), Goal.FORWARD, KEY, level)


def posture_of(first_deg: int, second_deg: int) -> np.ndarray:
    """Return a posture of the hexapod in which all legs do the same, (3, legs)."""
    return np.array([[angle] * 6 for angle in (0, first_deg, second_deg)], float)


def level_a(*rows_deg: np.ndarray) -> Gait:
    """Return a gait that has these postures at the keys 1, 2, ... of level A."""
    postures = sequence_of(np.array(rows_deg))
    return Gait(PostureTable(dict(enumerate(postures, 1))), None)


def codes_of(explained: list[Sentence]) -> list[str]:
    """Return the codes of the sentences that explain a walk."""
    return [one.said.code.removeprefix("explain.") for one in explained]
