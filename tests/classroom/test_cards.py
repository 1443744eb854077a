"""Tests of a student's card: who needs help, how fast, and when each foot was down."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lacoc_client.workshop.classroom.cards import (
    QUIET_S,
    SeenStudent,
    best_speed,
    card,
    failure,
    foot_runs,
    hand_times,
    stuck,
)
from lacoc_client.workshop.phases.evidence import (
    Edited,
    Evidence,
    Hand,
    LegEdit,
    Tried,
    TriedNumber,
    WentToPhase,
)
from lacoc_client.workshop.phases.facts import TrialFacts
from lacoc_client.workshop.phases.progress import progress
from lacoc_shared.studio import TrialReply

WALKS: dict[str, Any] = {
    "keys": ("B2",),
    "postures": 4,
    "cycles": 5,
    "cycle_s": 1.0,
    "forward_mm": 300.0,
    "left_mm": 0.0,
    "speed_mm_s": 60.0,
    "drift_deg_s": 0.1,
    "upright": 0.99,
    "belly_share": 0.0,
    "margin_mm": 20.0,
    "clearance_mm": 15.0,
    "duty": (0.6,) * 6,
    "tripod_s": 0.4,
    "same_feet_share": 0.4,
    "seam_deg": 0.0,
    "stopped": False,
}


def facts(**changes: Any) -> TrialFacts:
    return TrialFacts(**{**WALKS, **changes})


def tried(number: TriedNumber | None = None, **changes: Any) -> Tried:
    numbers = () if number is None else (number,)
    return Tried(version="1", facts=facts(**changes), numbers=numbers)


@pytest.mark.parametrize(
    ("changes", "code"),
    [
        ({}, None),
        ({"stopped": True, "upright": 0.1}, "class.failed-stopped"),
        ({"upright": 0.5, "belly_share": 0.9}, "class.failed-fell"),
        ({"belly_share": 0.2}, "class.failed-belly"),
        ({"drift_deg_s": -9.0, "speed_mm_s": 0.0}, "class.failed-turns"),
        ({"speed_mm_s": 14.0}, "class.failed-slow"),
        ({"speed_mm_s": -60.0}, "class.failed-slow"),
        ({"keys": ("B1",), "speed_mm_s": 0.0, "drift_deg_s": 20.0}, None),
        ({"keys": ("A1",), "tripod_s": 1.0}, "class.failed-stand"),
        ({"keys": ("A1",), "tripod_s": 2.0}, None),
        ({"keys": ("A1", "A2"), "tripod_s": 0.0}, None),
    ],
)
def test_a_failure_has_a_reason(changes: dict[str, Any], code: str | None) -> None:
    """A failed trial is explained by its worst fault; only key 2 must walk fast and straight."""
    said = failure(facts(**changes))
    assert (said and said.code) == code


def test_three_equal_failures_in_a_row_are_flagged() -> None:
    """A student is stuck if the last three trials failed for the same reason."""
    slow, belly, good = facts(speed_mm_s=0.0), facts(belly_share=0.5), facts()
    for tries, code in (
        ([], None),
        ([slow, slow], None),
        ([slow, slow, slow], "class.failed-slow"),
        ([good, slow, slow, slow], "class.failed-slow"),
        ([slow, slow, slow, good], None),
        ([slow, belly, slow], None),
        ([slow, slow, slow, belly], None),
        ([good, good, good], None),
    ):
        said = stuck(tries)
        assert (said and said.code) == code


def test_a_card_says_who_needs_help() -> None:
    """A card names one need: a raised hand first, else a repeated failure, else inactivity."""
    slow = [tried(speed_mm_s=0.0)] * 3

    def need(evidence: list[Evidence], online: bool = True, after_s: float = 1.0) -> str:
        seen = SeenStudent(name="Anna", online=online, seen_s=1000.0)
        return card(seen, evidence, progress(evidence), 1000.0 + after_s).need

    assert need([]) == ""
    assert need([], after_s=QUIET_S + 1) == "quiet"
    assert need([], online=False, after_s=QUIET_S + 1) == ""
    assert need([*slow], after_s=QUIET_S + 1) == "stuck"
    assert need([*slow, Hand(up=True)]) == "hand"
    assert need([*slow, Hand(up=True), Hand(up=False)]) == "stuck"


def test_a_card_counts_only_walks_as_fast() -> None:
    """The best speed counts only trials of key 2 without a fall, with numbers of the student's own.

    The last speed is of any key.
    """
    own, foreign = TriedNumber(1, 0, 0, 1, 40.0, 0.0), TriedNumber(1, 0, 1, 1, 40.0, 0.0)
    typed = LegEdit(1, 0, 0, (1,), (0.0, 40.0, 0.0), (0.0, 0.0, 0.0))
    evidence: list[Evidence] = [
        WentToPhase(phase=4),
        Edited(version="1", by="hand", legs=(typed,)),
        tried(own, speed_mm_s=70.0),
        tried(own, speed_mm_s=200.0, upright=0.2),
        tried(own, speed_mm_s=300.0, belly_share=0.5),
        tried(foreign, speed_mm_s=400.0),
        tried(own, speed_mm_s=90.0, keys=("B3",)),
    ]
    seen = SeenStudent(name="Anna", best_mm_s=best_speed(evidence))
    shown = card(seen, evidence, progress(evidence), 0.0)
    assert (shown.best_mm_s, shown.last_mm_s, shown.tries) == (70.0, 90.0, 5)
    assert shown.phase == 4
    assert shown.states[:2] == ("open", "skipped")
    assert shown.feet is None


def test_a_hand_has_the_time_when_it_went_up() -> None:
    """A hand that is raised again has the time of its last raise; a lowered hand has no time."""
    assert hand_times([]) is None
    assert hand_times([(1.0, Hand(up=True)), (2.0, Hand(up=False))]) is None
    assert hand_times([(1.0, Hand(up=True)), (2.0, Hand(up=False)), (3.0, Hand(up=True))]) == 3.0


@given(st.lists(st.integers(0, 63), min_size=1, max_size=60), st.integers(0, 5))
def test_runs_say_when_a_foot_was_down(down: list[int], skip: int) -> None:
    """The runs on a card say in which ticks of a trial each foot was down."""
    trial = TrialReply(
        level=1,
        key=2,
        figures={"duty": [0.5] * 6},
        explained=(),
        ticks=skip + len(down),
        first=skip,
        end=skip + len(down),
        starts=(),
        down=bytes([63] * skip + down),
        posture=b"",
        poses=b"",
        commanded_rad=b"",
        contact_w_m=b"",
        centre_w_m=b"",
        margin_m=b"",
        slip_m_s=b"",
        tip_m=b"",
        digest=b"",
    )
    runs = foot_runs(trial)
    assert len(runs) == 6
    for leg, own in enumerate(runs):
        painted = np.zeros(len(down), bool)
        for begin, end in own:
            painted[round(begin * len(down)) : round(end * len(down))] = True
        assert painted.tolist() == [bool(feet >> leg & 1) for feet in down]
