"""Tests of why a team goes on into a stage."""

from random import Random

from chance_event import Event
from cup import Cup

from lacoc_server.contest.league.advance import reasons
from lacoc_server.contest.league.facts import Closed, Drawn, Entered, Planned, Played, Withdrawn
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.league.sheet import sheet
from lacoc_server.contest.league.timetable.schedule import due
from lacoc_shared.words import render


def play(cup: Cup, scores: dict[tuple[str, str], tuple[int, int]]) -> None:
    """Play matches: by the teams, the points of each."""
    for match in cup.contest.stages[0].matches:
        teams = match.next_seats
        if teams is None:
            continue
        points = scores.get(teams) or (scores[teams[1], teams[0]][1], scores[teams[1], teams[0]][0])
        outcome = "draw" if points[0] == points[1] else "left" if points[0] > points[1] else "right"
        facts = {"pairing": match.pairing.id, "game": 1, "teams": teams}
        cup.add(Played, scores=points, outcome=outcome, **facts)


def told(cup: Cup, teams: int, language: str = "en") -> list[str]:
    """Return the reasons of the best teams that go on into a stage after the cup."""
    cup.add(Planned, stage="finals", format="single-knockout", after="cup", teams=teams)
    contest = cup.contest
    plan = contest.planned[0]
    entries = contest.stages[0].ranking[:teams]
    return [render(why, language) for why in reasons(contest, plan, entries)]


def test_a_place_the_points_and_the_rule_that_broke_the_tie() -> None:
    """A team that is level with the next one says which rule put it before that one."""
    cup = Cup(teams=3)
    play(cup, {("t001", "t002"): (3, 1), ("t002", "t003"): (5, 1), ("t001", "t003"): (1, 2)})
    assert told(cup, 2) == [
        "place 1, 2 points; ahead of t001 by the difference of points",
        "place 2, 2 points; ahead of t003 by the difference of points",
    ]
    assert "得失点差" in told(cup, 2, "ja")[0]
    assert told(cup, 3)[2] == "place 3, 2 points; behind t001 by the difference of points"


def test_the_best_of_those_at_the_same_place_of_their_groups() -> None:
    """Where not all seconds go on, the one who does says whom it left behind, and by what."""
    cup = Cup(teams=4, groups=2)
    play(cup, {("t001", "t004"): (3, 2), ("t002", "t003"): (9, 1)})
    assert told(cup, 3)[2] == (
        "place 2 of group A, 0 points; before t003, at this place in another group, by "
        "the difference of points"
    )


def test_a_team_that_moves_up_says_for_whom() -> None:
    """If a better team has left, the one that goes on in its place says so."""
    cup = Cup(teams=3)
    play(cup, {("t001", "t002"): (3, 1), ("t002", "t003"): (5, 1), ("t001", "t003"): (3, 2)})
    cup.add(Withdrawn, team="t001", reason="ill")
    cup.add(Planned, stage="finals", format="single-knockout", after="cup", teams=2)
    contest = cup.contest
    why = reasons(contest, contest.planned[0], ("t002", "t003"))
    assert [render(one) for one in why] == [
        "place 2, 2 points; moves up because t001 left",
        "place 3, 0 points; moves up because t001 left",
    ]


def test_a_stage_that_follows_none_needs_no_reason() -> None:
    """The first stage has whoever entered; the sheet then has no reasons."""
    assert sheet("Cup", Cup().contest).reasons == {}


def drawn(event: Event) -> list[str]:
    """Draw what is due, and return the reasons of the newest stage, with the names of its teams."""
    event.add(Closed)
    draw = due(event.contest, FORMATS)
    assert isinstance(draw, Drawn)
    event.append(draw)
    why = sheet("Cup", event.contest).reasons[draw.stage]
    return [f"{team}: {render(one)}" for team, one in zip(draw.entries, why, strict=True)]


def test_a_team_that_changed_its_place_in_the_draw_says_for_which_pairs() -> None:
    """With `apart` the seconds of two groups change places: both say why, the others do not."""
    cup = Cup(teams=4, groups=2)
    play(cup, {("t001", "t004"): (9, 1), ("t002", "t003"): (3, 2)})
    cup.add(Planned, stage="finals", format="single-knockout", after="cup", met_apart=True)
    assert drawn(cup) == [
        "t001: place 1 of group A, 2 points",
        "t002: place 1 of group B, 2 points",
        "t004: place 2 of group A, 0 points; seed 3 instead of 4, "
        "so that t001 – t004 do not meet at once",
        "t003: place 2 of group B, 0 points; seed 4 instead of 3, "
        "so that t002 – t003 do not meet at once",
    ]


def test_a_first_stage_that_keeps_clubs_apart_says_its_order() -> None:
    """Where clubs make another order than that of the entries, each team says its number."""
    event = Event(0, 2, Random(1))
    for team, club in (("a1", "a"), ("b1", "b"), ("b2", "b"), ("a2", "a")):
        event.add(Entered, team=team, club=club, files=team)
    event.add(Planned, stage="cup", format="single-knockout", apart=True)
    assert drawn(event) == [
        "a1: entered as number 1",
        "b1: entered as number 2",
        "a2: entered as number 4; seed 3 instead of 4, so that a1 – a2 do not meet at once",
        "b2: entered as number 3; seed 4 instead of 3, so that b1 – b2 do not meet at once",
    ]
