"""Tests of the pure part of an office: which facts follow from what its courts show."""

import itertools
from typing import Any

import pytest

from lacoc_server.contest.league.contest import Contest, compute
from lacoc_server.contest.league.facts import (
    AnyFact,
    Called,
    Drawn,
    Entered,
    Planned,
    Played,
    Recalled,
    Settings,
    Withdrawn,
)
from lacoc_server.contest.league.fixture import fixture
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.live.calling import (
    LOST_MS,
    Ended,
    Seen,
    calls,
    results,
    taken_back,
    wanted,
)
from lacoc_shared.words import render

NOW_MS = 1_000_000
TEAMS = ("Ants", "Bees", "Crabs", "Dogs")


class Facts:
    """The facts of a contest of four teams, which a test goes on with."""

    def __init__(self, how: str = "round-robin", **settings: Any) -> None:
        self._numbers = itertools.count(1)
        self.facts: list[AnyFact] = []
        for team in TEAMS:
            self.add(Entered, team=team)
        self.add(Planned, stage="cup", format=how, settings=Settings(**settings))
        self.add(Drawn, stage="cup", entries=TEAMS)

    def add(self, kind: type[AnyFact], **values: Any) -> AnyFact:
        number = next(self._numbers)
        fact = kind(id=f"f{number}", number=number, at_ms=NOW_MS, **values)
        self.facts.append(fact)
        return fact

    def call(self, court: str = "north") -> Called:
        """Append the call of the next game to a court."""
        (called,) = calls(self.contest, {court: Seen(NOW_MS)}, NOW_MS, 0)
        fact = self.add(
            Called, pairing=called.pairing, game=called.game, teams=called.teams, court=court
        )
        assert isinstance(fact, Called)
        return fact

    @property
    def contest(self) -> Contest:
        return compute(self.facts, FORMATS)


def test_free_courts_that_are_there_get_games() -> None:
    """Each court that was heard lately and has no game gets one; no team gets two."""
    facts = Facts()
    seen = {"north": Seen(NOW_MS), "gone": Seen(NOW_MS - LOST_MS), "south": Seen(NOW_MS)}
    given = calls(facts.contest, seen, NOW_MS, 0)
    assert [one.court for one in given] == ["north", "south"]
    assert len({team for one in given for team in one.teams}) == 4
    first = (given[0].pairing, given[0].game)
    others = calls(facts.contest, seen, NOW_MS, 0, held=[first])
    assert first not in [(one.pairing, one.game) for one in others]
    assert others, "a game that is held back keeps no court from the others"


def test_a_call_is_sent_until_the_court_has_it() -> None:
    """A call is wanted as long as its court shows another call or none."""
    facts = Facts()
    call = facts.call()
    assert list(wanted(facts.contest, {})) == [call]
    assert list(wanted(facts.contest, {"north": Seen(NOW_MS, "f1")})) == [call]
    assert list(wanted(facts.contest, {"north": Seen(NOW_MS, call.id)})) == []


def test_the_result_of_a_call_is_taken_once() -> None:
    """A result counts if it is that of the call; afterwards the game is not running any more."""
    facts = Facts()
    call = facts.call()
    end = Ended((20, 16), "left", "x.mcap")
    assert not list(results(facts.contest, {"north": Seen(NOW_MS, "f1", True, end)}))
    assert not list(results(facts.contest, {"north": Seen(NOW_MS, call.id, True)}))
    (played,) = results(facts.contest, {"north": Seen(NOW_MS, call.id, True, end)})
    assert isinstance(played, Played)
    assert (played.teams, played.scores, played.record) == (call.teams, (20, 16), "x.mcap")
    facts.add(
        Played,
        pairing=call.pairing,
        game=call.game,
        teams=call.teams,
        scores=(20, 16),
        outcome="left",
    )
    assert not list(results(facts.contest, {"north": Seen(NOW_MS, call.id, True, end)}))


@pytest.mark.parametrize(
    ("seen", "is_lost"),
    [
        (None, True),
        (Seen(NOW_MS), False),
        (Seen(NOW_MS - LOST_MS - 1), True),
        (Seen(NOW_MS - LOST_MS - 1, "call"), True),
        (Seen(NOW_MS - LOST_MS - 1, "call", begun=True), False),
    ],
)
def test_a_court_that_is_gone_loses_what_it_had_not_begun(seen: Seen | None, is_lost: bool) -> None:
    """A game is taken back from a court that was not heard for long, unless it had begun."""
    facts = Facts()
    call = facts.call()
    courts = {}
    if seen is not None:
        courts["north"] = seen._replace(call=call.id if seen.call else "")
    later_ms = NOW_MS + (LOST_MS + 1 if seen is None else 1)
    facts.facts[-1] = call
    early = NOW_MS - LOST_MS - 1
    facts.facts[-1] = Called(
        id=call.id,
        number=call.number,
        at_ms=NOW_MS if seen is None else early,
        pairing=call.pairing,
        game=call.game,
        teams=call.teams,
        court="north",
    )
    back = list(taken_back(facts.contest, courts, later_ms))
    assert bool(back) == is_lost


def test_a_game_that_is_not_needed_comes_back() -> None:
    """When a team leaves, its game is taken back, unless it has begun."""
    facts = Facts()
    call = facts.call()
    seen = {"north": Seen(NOW_MS, call.id)}
    assert not list(taken_back(facts.contest, seen, NOW_MS))
    facts.add(Withdrawn, team=call.teams[0])
    (back,) = taken_back(facts.contest, seen, NOW_MS)
    assert isinstance(back, Recalled)
    begun = {"north": Seen(NOW_MS, call.id, begun=True)}
    assert not list(taken_back(facts.contest, begun, NOW_MS))


@pytest.mark.parametrize(
    ("how", "settings", "said"),
    [
        ("round-robin", {"groups": 2}, ["cup, group A, round 1", "cup, group B, round 1"]),
        (
            "single-knockout",
            {"games": 3, "third_place": True},
            [
                "Semi-final 1, game 2 of 3",
                "Semi-final 2, game 2 of 3",
                "Final, game 2 of 3",
                "Match for third place, game 2 of 3",
            ],
        ),
        (
            "double-knockout",
            {},
            [
                "Round 1, match 1",
                "Round 1, match 2",
                "Round 2, match 1",
                "Losers' bracket, round 1, match 1",
                "Losers' bracket, round 2, match 1",
                "Final",
                "Deciding final",
            ],
        ),
    ],
)
def test_what_is_played_is_said(how: str, settings: dict[str, Any], said: list[str]) -> None:
    """Each match has its usual name, in groups and in a bracket."""
    contest = Facts(how, **settings).contest
    (view,) = contest.stages
    game = min(2, view.stage.settings.games)
    names = [render(fixture(contest, view, match, game), "en") for match in view.matches]
    assert names == said
