"""Tests of the pure part of an office: which facts follow from what its courts show."""

from typing import Any

import pytest
from cup import NOW_MS, Cup

from lacoc_server.contest.desk.overview import slots
from lacoc_server.contest.league.facts import (
    COURT_LOST,
    Called,
    Moved,
    Played,
    Recalled,
    Replay,
    Voided,
    Withdrawn,
)
from lacoc_server.contest.league.fixture import fixture
from lacoc_server.contest.league.timetable.calling import (
    LOST_MS,
    GameEnd,
    SeenCourt,
    calls,
    in_vain,
    results,
    taken_back,
    wanted,
    why_recalled,
)
from lacoc_server.contest.league.timetable.whereabouts import ContestPace, OfficeKnowledge
from lacoc_shared.words import render, say


def called(cup: Cup, court: str = "north") -> Called:
    """Call the next game to a court."""
    (call,) = calls(cup.contest, {court: SeenCourt(NOW_MS)}, NOW_MS, 0)
    return cup.append(call)


def test_free_courts_that_are_there_get_games() -> None:
    """Courts that were heard lately get a game each; no team gets two; games held back wait."""
    cup = Cup()
    seen = {
        "north": SeenCourt(NOW_MS),
        "gone": SeenCourt(NOW_MS - LOST_MS),
        "south": SeenCourt(NOW_MS),
    }
    given = calls(cup.contest, seen, NOW_MS, 0)
    assert [one.court for one in given] == ["north", "south"]
    assert len({team for one in given for team in one.teams}) == 4
    first = (given[0].pairing, given[0].game)
    others = calls(cup.contest, seen, NOW_MS, 0, held=[first])
    assert first not in [(one.pairing, one.game) for one in others]
    assert others, "a game that is held back keeps no court from the others"


def test_a_game_that_was_moved_goes_back_unless_it_has_begun() -> None:
    """A moved game is taken back and called to its new court; one that has begun stays."""
    cup = Cup()
    call = called(cup)
    seen = {"north": SeenCourt(NOW_MS, call.id), "south": SeenCourt(NOW_MS)}
    cup.add(Moved, pairing=call.pairing, court="south")
    begun = {**seen, "north": SeenCourt(NOW_MS, call.id, True)}
    assert not list(taken_back(cup.contest, begun, NOW_MS))
    (back,) = taken_back(cup.contest, seen, NOW_MS)
    assert isinstance(back, Recalled)
    cup.add(Recalled, pairing=back.pairing, game=back.game, reason=back.reason)
    assert why_recalled(cup.contest, cup.facts, call.id) == say("recalled.moved")
    again = {one.court: one.pairing for one in calls(cup.contest, seen, NOW_MS, 0)}
    assert again["south"] == call.pairing
    assert again["north"] != call.pairing, "the other court does not wait"
    called(cup, "south")
    assert not list(taken_back(cup.contest, seen, NOW_MS)), "it is where it was moved"
    cup.add(Moved, pairing=call.pairing, not_before_ms=NOW_MS + 1)
    assert len(list(taken_back(cup.contest, seen, NOW_MS))) == 1


def test_a_call_is_sent_until_the_court_has_it() -> None:
    """A call is sent as long as its court shows another call or none."""
    cup = Cup()
    call = called(cup)
    assert list(wanted(cup.contest, {})) == [call]
    assert list(wanted(cup.contest, {"north": SeenCourt(NOW_MS, "f1")})) == [call]
    assert list(wanted(cup.contest, {"north": SeenCourt(NOW_MS, call.id)})) == []


def test_the_result_of_a_call_is_taken_once() -> None:
    """A result counts once, if its court shows the call and the end of the match."""
    cup = Cup()
    call = called(cup)
    late = (say("health.late-beat", late_ms=300.0, most_ms=200.0),)
    end = GameEnd((20, 16), "left", "x.mcap", late)
    assert not list(results(cup.contest, {"north": SeenCourt(NOW_MS, "f1", True, end)}))
    assert not list(results(cup.contest, {"north": SeenCourt(NOW_MS, call.id, True)}))
    (played,) = results(cup.contest, {"north": SeenCourt(NOW_MS, call.id, True, end)})
    assert isinstance(played, Played)
    assert (played.teams, played.scores, played.record) == (call.teams, (20, 16), "x.mcap")
    assert played.advice == late
    cup.append(played)
    assert not list(results(cup.contest, {"north": SeenCourt(NOW_MS, call.id, True, end)}))


@pytest.mark.parametrize(
    ("seen", "is_lost"),
    [
        (None, True),
        (SeenCourt(NOW_MS + 1), False),
        (SeenCourt(NOW_MS), True),
        (SeenCourt(NOW_MS, "call"), True),
        (SeenCourt(NOW_MS, "call", begun=True), False),
    ],
)
def test_a_court_that_is_gone_loses_a_game_that_has_not_begun(
    seen: SeenCourt | None, is_lost: bool
) -> None:
    """A game is taken back if its court was silent for `LOST_MS` and the game has not begun."""
    cup = Cup()
    call = called(cup)
    north = {} if seen is None else {"north": seen._replace(call=call.id if seen.call else "")}
    assert list(taken_back(cup.contest, north, NOW_MS + LOST_MS)) == []
    assert bool(list(taken_back(cup.contest, north, NOW_MS + LOST_MS + 1))) == is_lost
    started_ms = NOW_MS + 1  # an office that has just started has not listened long enough
    assert list(taken_back(cup.contest, north, NOW_MS + LOST_MS + 1, started_ms)) == []
    for back in taken_back(cup.contest, north, NOW_MS + LOST_MS + 1):
        cup.append(back)
        silent = say("recalled.silent", seconds=LOST_MS // 1000)
        assert why_recalled(cup.contest, cup.facts, call.id) == silent


def test_a_game_that_is_not_needed_comes_back() -> None:
    """When a team leaves, its game is taken back, also in play: it would play for nothing."""
    cup = Cup()
    call = called(cup)
    seen = {"north": SeenCourt(NOW_MS, call.id)}
    assert not list(taken_back(cup.contest, seen, NOW_MS))
    assert why_recalled(cup.contest, cup.facts, call.id) is None
    others = {*(team.name for team in cup.contest.teams)} - {*call.teams}
    cup.add(Withdrawn, team=min(others), reason="ill")
    assert why_recalled(cup.contest, cup.facts, call.id) is None, "that is about another game"
    cup.add(Withdrawn, team=call.teams[0], reason="a broken leg")
    (back,) = taken_back(cup.contest, seen, NOW_MS)
    assert isinstance(back, Recalled)
    begun = {"north": SeenCourt(NOW_MS, call.id, begun=True)}
    assert len(list(taken_back(cup.contest, begun, NOW_MS))) == 1
    cup.append(back)
    what = say("decided.withdrawn", team=call.teams[0])
    said = say("recalled.decided", what=what, reason="a broken leg")
    assert why_recalled(cup.contest, cup.facts, call.id) == said
    assert why_recalled(cup.contest, cup.facts, "no such call") is None


def test_a_game_in_play_that_may_still_count_stays() -> None:
    """Game 2 goes on if game 1 is to be played again, or its sides would be others now."""
    cup = Cup(games=3)
    first = called(cup)
    about = {"pairing": first.pairing, "teams": first.teams, "scores": (3, 1), "outcome": "left"}
    cup.add(Played, game=1, record="r.mcap", **about)
    second = called(cup)
    assert (second.pairing, second.game) == (first.pairing, 2)
    cup.add(Replay, pairing=first.pairing, game=1, teams=first.teams, reason="a cable")
    begun = {"north": SeenCourt(NOW_MS, second.id, begun=True)}
    assert not list(taken_back(cup.contest, begun, NOW_MS))
    waits = {"north": SeenCourt(NOW_MS, second.id)}
    assert len(list(taken_back(cup.contest, waits, NOW_MS))) == 1
    assert not in_vain(cup.contest, second)
    cup.add(Voided, pairing=first.pairing, teams=first.teams, reason="nobody came")
    assert in_vain(cup.contest, second)
    assert len(list(taken_back(cup.contest, begun, NOW_MS))) == 1


def test_a_dead_court_loses_its_game_though_the_clock_was_set_back() -> None:
    """A call in the future, by the clock of now, keeps no game at a court that was not heard."""
    cup = Cup()
    call = called(cup)
    now_ms = call.at_ms - 600_000
    north = SeenCourt(now_ms - LOST_MS, begun=None)
    assert not list(taken_back(cup.contest, {"north": north}, now_ms))
    north = SeenCourt(now_ms - LOST_MS - 1, begun=None)
    assert [one.reason for one in taken_back(cup.contest, {"north": north}, now_ms)] == [COURT_LOST]


@pytest.mark.parametrize("is_moved", [True, False])
def test_a_game_may_be_in_play_while_its_court_is_not_heard(*, is_moved: bool) -> None:
    """It stays until its court is heard or lost, also if it was moved or is not the next one."""
    cup = Cup(games=3)
    first = called(cup)
    about = {"pairing": first.pairing, "teams": first.teams}
    cup.add(Played, game=1, record="r.mcap", scores=(3, 1), outcome="left", **about)
    call = called(cup)
    if is_moved:
        cup.add(Moved, pairing=call.pairing, court="south")
    else:
        cup.add(Replay, game=1, reason="a cable", **about)
    silent = {"north": SeenCourt(NOW_MS, begun=None)}
    late_ms = NOW_MS + LOST_MS + 1
    assert not list(taken_back(cup.contest, silent, NOW_MS + LOST_MS))
    assert [fact.reason for fact in taken_back(cup.contest, silent, late_ms)] == [COURT_LOST]
    other = {"north": SeenCourt(late_ms, "f1", begun=True)}
    assert len(list(taken_back(cup.contest, other, late_ms))) == 1, "that is another game"
    in_play = {"north": SeenCourt(late_ms, call.id, begun=True)}
    assert not list(taken_back(cup.contest, in_play, late_ms))
    cup.add(Voided, reason="nobody came", **about)
    assert len(list(taken_back(cup.contest, silent, NOW_MS))) == 1, "it would count no more"


def test_a_group_called_f_plays_no_final() -> None:
    """Matches of the groups f, l and p are named as groups, not as parts of a bracket."""
    contest = Cup(teams=34, groups=17).contest
    (view,) = contest.stages
    said = {fixture(contest, view, match, 1).code for match in view.matches}
    assert {match.pairing.section for match in view.matches} >= {"f", "l", "p"}
    assert said == {"fixture.round"}


@pytest.mark.parametrize(
    ("how", "settings", "said"),
    [
        (
            "round-robin",
            {"groups": 2},
            ["Group stage, group A, round 1", "Group stage, group B, round 1"],
        ),
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
    contest = Cup(how, **settings).contest
    (view,) = contest.stages
    game = min(2, view.stage.settings.games)
    names = [render(fixture(contest, view, match, game), "en") for match in view.matches]
    assert names == said


@pytest.mark.parametrize(
    ("after_ms", "call", "absent"),
    [(0, "", ()), (60_000, "", ("t002",)), (60_000, "other", ())],
)
def test_a_team_that_has_not_come_is_told_a_while_after_the_call(
    after_ms: int, call: str, absent: tuple[str, ...]
) -> None:
    """A court that still has another match says nothing about this one."""
    cup = Cup()
    called = cup.call("cup:a1.1", "north", ("t001", "t002"))
    there = SeenCourt(NOW_MS, call or called, missing=("t002",))
    pace = ContestPace(cup.contest.running[0].at_ms + after_ms, 60_000)
    known = OfficeKnowledge({"north": there}, pace, {})
    (slot,) = (slot for slot in slots(cup.contest, known) if slot.running)
    assert slot.absent == absent
