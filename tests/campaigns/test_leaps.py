"""Short searches of `fuzz.leaps`: no robot that passes the weigh-in leaves its start, or scores."""

import os

import pytest

from lacoc_robots.standing import FARTHEST_M
from tests.campaigns.fuzz.leaps import at_random, changed, judge, search


@pytest.mark.slow
@pytest.mark.long
def test_no_robot_that_is_let_in_leaps() -> None:
    """Among 30 random robots and 5 variants of one, no accepted robot leaves its start place.

    None scores before a key, in either game (rules 4).
    """
    found = [judge(at_random(seed)) for seed in range(30)]
    farthest = max(found, key=lambda one: one.leap_m or 0.0)
    found += [judge(changed(farthest.candidate, seed)) for seed in range(5)]
    leaps_m = [one.leap_m for one in found if one.leap_m is not None]
    refused_m = [one.tried_m for one in found if one.is_robot and one.leap_m is None]
    assert len(leaps_m) >= 5
    assert max(leaps_m) <= FARTHEST_M
    assert not any(one.scored for one in found)
    assert max(refused_m) > 2 * FARTHEST_M  # some refused robots did leave it


@pytest.mark.long(minutes=1)
def test_no_search_finds_a_leap() -> None:
    """Among 75 random robots and 75 variants, none leaves its start place or scores."""
    found = list(search(75, 75, os.cpu_count() or 1, seed=0))
    leaps_m = [one.leap_m for one in found if one.leap_m is not None]
    assert len(leaps_m) > 17
    assert max(leaps_m) <= FARTHEST_M
    assert not any(one.scored for one in found)
