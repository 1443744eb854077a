"""Tests of the facts of real trials, and of the directions in which feet go."""

import math
from collections.abc import Callable

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lacoc_client.workshop.phases.facts import (
    TrialFacts,
    differences,
    foot_ways,
    pace,
    trial_facts,
    way,
)
from lacoc_robots.leg import LegSpec
from lacoc_robots.library import find_robot
from lacoc_robots.robot_file import read_robot
from lacoc_shared.gait.tables import Posture
from lacoc_shared.messages import Phrase
from lacoc_shared.studio import Sentence, TrialReply

Tries = Callable[..., TrialFacts]

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def legs() -> tuple[LegSpec, ...]:
    """Give the legs of the workshop's robot."""
    name, data = find_robot("hexapod")
    return read_robot(data, name).legs


def test_the_sample_walks_five_whole_cycles(try_gait: Tries, sample: dict[int, Posture]) -> None:
    """The sample walks straight for five cycles, nearly half of the time on the same three feet."""
    facts = try_gait(sample, "B1")

    assert (facts.keys, facts.postures, facts.cycles) == (("B1",), 4, 5)
    assert 60 * 7.2 * 0.98 < facts.forward_mm < 62 * 7.2
    assert way(facts) == "straight"
    assert 0.4 < facts.same_feet_share <= 0.5
    assert 0.5 < facts.tripod_s < 0.72  # half a cycle takes 0.72 s
    assert facts.seam_deg == 0
    assert not facts.stopped


def test_a_tripod_is_seen_and_six_feet_are_none(
    try_gait: Tries, sample: dict[int, Posture]
) -> None:
    """In the sample's posture 1 the robot stands on three feet; in posture 0 it never does."""
    tripod, stand = try_gait(sample, "A1", 3.0), try_gait(sample, "A0", 3.0)

    assert tripod.tripod_s == pytest.approx(2.96, abs=0.1)
    assert tripod.same_feet_share > 0.95
    assert (stand.tripod_s, stand.same_feet_share) == (0.0, 0.0)


def test_two_postures_go_forward_on_the_same_feet(
    try_gait: Tries, sample: dict[int, Posture]
) -> None:
    """From posture 1 to posture 2 of the sample, the robot goes forward on the same three feet."""
    facts = try_gait(sample, "A1:1, a2", 1.5)

    assert facts.keys == ("A1", "A2")
    assert facts.forward_mm > 30
    assert facts.same_feet_share == 1.0


def test_a_jump_at_the_seam_is_told_in_degrees(try_gait: Tries, sample: dict[int, Posture]) -> None:
    """Facts give the largest jump of a joint from the last posture back to the first.

    Here Root turns by 26 degrees from each of four postures to the next, so it jumps back by 78.
    """
    turned = {
        key: tuple(
            math.radians(-40 + 26 * (key - 1)) if joint == 0 else angle
            for joint, angle in enumerate(posture)
        )
        for key, posture in sample.items()
        if key <= 4
    }

    assert try_gait(turned, "B1").seam_deg == pytest.approx(78, abs=1)


def test_faults_of_physics_are_facts(
    ask_trial: Callable[..., TrialReply], sample: dict[int, Posture]
) -> None:
    """A trial in which physics failed, even in the first tick, has facts."""
    reply = ask_trial(sample, "A1", 0.2)
    stopped = msgspec.structs.replace(reply, fault=Phrase("fault.numbers"))
    empty = msgspec.structs.replace(
        stopped, ticks=0, first=0, end=0, down=b"", margin_m=b"", posture=b""
    )

    assert trial_facts(stopped).stopped
    assert trial_facts(empty).tripod_s == 0
    seam = Sentence(said=Phrase("explain.seam", {"jump_deg": 30.0}))
    assert trial_facts(msgspec.structs.replace(reply, explained=(seam,))).seam_deg == 30


def test_a_reply_that_does_not_fit_together_is_refused(
    ask_trial: Callable[..., TrialReply], sample: dict[int, Posture]
) -> None:
    """A reply with arrays of a wrong length, or without figures, raises a ValueError."""
    reply = ask_trial(sample, "A1", 0.2)

    for wrong in ({"ticks": reply.ticks + 1}, {"figures": {}}, {"down": b""}, {"margin_m": b"x"}):
        with pytest.raises(ValueError, match=r"."):
            trial_facts(msgspec.structs.replace(reply, **wrong))


def test_faster_slower_and_turning(try_gait: Tries, sample: dict[int, Posture]) -> None:
    """With smaller angles the sample is slower; the sample's postures 5 to 8 turn right."""
    forward = try_gait(sample, "B1")
    shorter = try_gait({k: _half_roots(posture) for k, posture in sample.items()}, "B1")
    reordered = {1: sample[5], 2: sample[6], 3: sample[7], 4: sample[8], 0: sample[0]}

    assert pace(forward, shorter) == "slower"
    assert pace(shorter, forward) == "faster"
    assert pace(forward, forward) == "same"
    assert way(try_gait(reordered, "B1")) == "right"
    assert differences(forward, forward) == ()
    assert {"speed", "period"} <= set(differences(forward, shorter))
    assert differences(forward, shorter) == differences(shorter, forward)


def _half_roots(posture: Posture) -> Posture:
    return tuple(angle / 2 if joint < 6 else angle * 0.7 for joint, angle in enumerate(posture))


@pytest.mark.parametrize("leg", range(6))
@pytest.mark.parametrize(
    ("before", "after", "ways"),
    [
        ((0, 20, 0), (30, 20, 0), ("forward",)),
        ((0, 20, 0), (-30, 20, 0), ("back",)),
        ((0, 20, 0), (0, 20, 0), ("still",)),
        ((0, 20, 0), (0, 20, 40), ("out",)),
        ((0, 20, 40), (0, 20, 0), ("in",)),
    ],
)
def test_a_foot_goes_the_same_way_on_both_sides(
    legs: tuple[LegSpec, ...],
    leg: int,
    before: tuple[float, ...],
    after: tuple[float, ...],
    ways: tuple[str, ...],
) -> None:
    """On every leg, Root moves the foot forward and back, and 2nd moves it out and in."""
    assert foot_ways(legs[leg], before, after)[0] == ways[0]


ANGLES = st.tuples(*[st.integers(-90, 90)] * 3)


@given(st.integers(0, 5), ANGLES, ANGLES)
def test_a_foot_that_goes_back_goes_the_other_way(
    legs: tuple[LegSpec, ...], leg: int, one: tuple[int, ...], other: tuple[int, ...]
) -> None:
    """An edit that is reversed moves the foot in the opposite directions.

    No edit moves the foot in two directions that are opposite to each other.
    """
    opposite = {"forward": "back", "up": "down", "out": "in", "still": "still"}
    opposite |= {there: here for here, there in opposite.items()}
    ways = foot_ways(legs[leg], one, other)

    assert tuple(opposite[way] for way in foot_ways(legs[leg], other, one)) == ways
    assert ways == ("still",) or not {opposite[way] for way in ways} & set(ways)
