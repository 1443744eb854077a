"""Tests of the forecast: how many matches a stage will have, before it is drawn."""

from typing import Any

import pytest

from lacoc_server.contest.league.facts import Planned, Settings, new
from lacoc_server.contest.league.forecast import most_matches
from lacoc_server.contest.league.formats.installed import FORMATS


@pytest.mark.parametrize("teams", range(2, 20))
def test_the_number_of_matches_is_the_known_one(teams: int) -> None:
    """Each format has as many matches as it must have: byes are none, the second final is one."""

    def most(how: str, **settings: Any) -> int:
        plan = new(Planned, stage="cup", format=how, settings=Settings(**settings))
        return most_matches(plan, teams, FORMATS)

    assert most("round-robin") == teams * (teams - 1) // 2
    assert most("single-knockout") == teams - 1
    assert most("single-knockout", third_place=True) == teams - 1 + (teams > 3)
    assert most("double-knockout") == 2 * teams - 1
    assert most("double-knockout", reset=False) == 2 * teams - 2
    assert most("swiss", rounds=5) == 5 * (teams // 2)
