"""Tests of reasons and repairs: a table with one mistake, of which it is known where it is."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from mistaken_tables import (
    GOOD,
    KEY,
    KINDS,
    beginners,
    change_of,
    mistaken,
    repaired,
    sequence_of,
    told,
)
from sample_walks import entry_of

from lacoc_server.studio.coach.coach import task_of
from lacoc_server.studio.coach.goal import goal_score
from lacoc_server.studio.coach.harm import harm, worse
from lacoc_server.studio.coach.trials import try_table
from lacoc_server.trial.reasons.form import KeyForm
from lacoc_server.trial.reasons.goal import Goal
from lacoc_server.trial.reasons.likely import likely_mistake, weigh_repairs

BEGINNERS = list(beginners())


@pytest.mark.slow
@pytest.mark.parametrize("index", range(len(BEGINNERS)), ids=[one.kind for one, _ in BEGINNERS])
def test_the_first_sentence_names_a_beginners_mistake(index: int) -> None:
    """The first sentence names the mistake of a beginner's table, and points at a wrong cell."""
    found = told(*BEGINNERS[index])
    assert found.named, found
    assert found.pointed, found


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["zeros", "2nd -40", "rows 2, 3 changed", "left Roots' signs"])
def test_the_coach_repairs_a_beginners_mistake(kind: str) -> None:
    """What the coach repairs, in physics, brings back nine tenths of the lost speed."""
    found = repaired(*next(one for one in BEGINNERS if one[0].kind == kind))
    assert found.lost
    assert found.back, found


LEFT = slice(3, 6)
ADVICE = {"dragged", "backward", "out-of-step"}
"""Sentences that tell what a single leg should do otherwise."""


@pytest.mark.parametrize("table", ["sample", "tripod"])
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


@pytest.mark.parametrize("table", ["sample", "tripod"])
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


@pytest.mark.parametrize("kind", KINDS)
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


def form_of(robot: str, table_deg: np.ndarray) -> KeyForm:
    """Return the form of a table that should go forward."""
    return KeyForm.of(entry_of(robot).robot, sequence_of(table_deg), Goal.FORWARD, KEY)
