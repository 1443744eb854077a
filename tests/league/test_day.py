"""Tests of a day that is steered: what is to come, pauses, shifts, breaks, draws, substitutes."""

from collections import Counter
from random import Random

import pytest
from chance_event import Event
from cup import Cup
from hypothesis import given
from hypothesis import strategies as st

from lacoc_server.contest.league.draws import by_lot, set_apart
from lacoc_server.contest.league.facts import (
    Announced,
    Closed,
    Drawn,
    Entered,
    Moved,
    NoShow,
    Paused,
    Planned,
    Played,
    Recalled,
    Replaced,
    Replay,
    Resumed,
    Shifted,
    StageSettings,
    Substituted,
    Undrawn,
    Unshifted,
)
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.league.timetable.calling import SeenCourt
from lacoc_server.contest.league.timetable.foreseen import foreseen
from lacoc_server.contest.league.timetable.schedule import assign, due
from lacoc_server.contest.league.timetable.seeding import meets_again
from lacoc_server.contest.league.timetable.whereabouts import ContestPace, starts
from lacoc_shared.words import render

MINUTE_MS = 60_000
COURTS = ["north", "south"]


def called(cup: Event, courts: list[str] = COURTS) -> list[tuple[str, str]]:
    """Return the games that are called now: the pairing and the court of each."""
    return [(one.pairing, one.court) for one in assign(cup.contest, courts, cup.now_ms)]


def play_open(cup: Cup, *pairings: str) -> None:
    """Let the left team win matches that are open, in their order."""
    for pairing in pairings:
        (match,) = (
            one for view in cup.contest.stages for one in view.matches if one.pairing.id == pairing
        )
        assert match.next_seats is not None
        cup.won(pairing, match.next_seats)


@pytest.mark.parametrize(
    ("how", "settings"),
    [
        ("single-knockout", {"third_place": True}),
        ("double-knockout", {"reset": False}),
        ("round-robin", {"groups": 2}),
        ("swiss", {"rounds": 3}),
    ],
)
@pytest.mark.parametrize("teams", [4, 5, 7, 8, 11])
def test_what_is_played_was_foreseen(how: str, settings: dict[str, object], teams: int) -> None:
    """Before a stage is drawn, the timetable has exactly the matches that it will have."""
    event = Event(teams, 2, Random(1))
    event.add(Planned, stage="cup", format=how, settings=StageSettings(**settings))
    early = foreseen(event.contest, FORMATS)
    assert all(one.match.teams == (None, None) for one in early)
    assert all(render(who) for one in early for who in one.who)
    event.add(Drawn, stage="cup", entries=tuple(event.names))
    for _ in event.play("cup"):
        pass
    (view,) = event.contest.stages
    played = [match.pairing.id for match in view.matches if match.how not in ("bye", "")]
    assert sorted(one.pairing.id for one in early) == sorted(played)
    assert foreseen(event.contest, FORMATS) == ()


def test_a_match_to_come_says_who_it_waits_for() -> None:
    """A bracket that is not drawn has seeds, then winners and losers of its matches, by name."""
    event = Event(6, 2, Random(1))
    event.add(
        Planned, stage="cup", format="single-knockout", settings=StageSettings(third_place=True)
    )
    told = {
        render(one.fixture): tuple(map(render, one.who)) for one in foreseen(event.contest, FORMATS)
    }
    assert told == {
        "Quarter-final 2": ("seed 4", "seed 5"),
        "Quarter-final 4": ("seed 3", "seed 6"),
        "Semi-final 1": ("seed 1", "winner of Quarter-final 2"),
        "Semi-final 2": ("seed 2", "winner of Quarter-final 4"),
        "Match for third place": ("loser of Semi-final 1", "loser of Semi-final 2"),
        "Final": ("winner of Semi-final 1", "winner of Semi-final 2"),
    }


def test_the_final_comes_last() -> None:
    """With two free courts, the match for third place is played first, then the final."""
    cup = Cup("single-knockout", third_place=True)
    play_open(cup, "cup:w1.1", "cup:w1.2")
    assert called(cup) == [("cup:p1.1", "north")]
    play_open(cup, "cup:p1.1")
    assert called(cup) == [("cup:w2.1", "north")]


def test_a_break_a_court_and_a_later_stage() -> None:
    """A stage begins after its break, and its final after another one, on its own court."""
    event = Cup("round-robin", teams=4)
    event.add(
        Planned,
        stage="finals",
        format="single-knockout",
        after="cup",
        break_s=600.0,
        final_court="south",
        final_break_s=120.0,
    )
    coming = foreseen(event.contest, FORMATS)
    seen = {court: SeenCourt(event.now_ms) for court in COURTS}
    early = dict(starts(event.contest, coming, seen, ContestPace(event.now_ms, MINUTE_MS)))
    rounds = [start.at_ms for pairing, start in early.items() if pairing.startswith("cup:")]
    semi, final = early["finals:w1.1"], early["finals:w2.1"]
    assert semi.at_ms == max(rounds) + MINUTE_MS + 600_000
    assert final.at_ms == semi.at_ms + MINUTE_MS + 120_000
    assert final.court == "south"

    for match in event.contest.stages[0].matches:
        play_open(event, match.pairing.id)
    draw = due(event.contest, FORMATS)
    assert isinstance(draw, Closed)
    event.append(draw)
    draw = due(event.contest, FORMATS)
    assert isinstance(draw, Drawn)
    event.append(draw)
    assert called(event) == []
    event.now_ms += 599_999
    assert called(event) == []
    event.now_ms += 1
    assert [pairing for pairing, _ in called(event)] == ["finals:w1.1", "finals:w1.2"]
    play_open(event, "finals:w1.1", "finals:w1.2")
    assert called(event) == []
    event.now_ms += 120_000
    assert called(event) == [("finals:w2.1", "south")]
    assert called(event, ["north"]) == []


@pytest.mark.parametrize("is_void", [True, False])
def test_a_final_that_is_played_again_has_no_second_break(*, is_void: bool) -> None:
    """After a void game of the final, or a decision to play it again, it is called at once."""
    event = Event(4, 2, Random(1))
    event.add(Planned, stage="cup", format="single-knockout", final_break_s=900.0)
    event.add(Drawn, stage="cup", entries=tuple(event.names))
    for match in event.contest.stages[0].matches[:2]:
        assert match.next_seats is not None
        about = {"pairing": match.pairing.id, "game": 1, "teams": match.next_seats}
        event.add(Played, scores=(3, 1), outcome="left", **about)
    assert called(event) == []
    event.now_ms += 900_000
    assert called(event) == [("cup:w2.1", "north")]
    teams = event.contest.matches["cup:w2.1"].next_seats
    final = {"pairing": "cup:w2.1", "game": 1, "teams": teams}
    event.add(Played, scores=(0, 0), outcome="void" if is_void else "left", **final)
    if not is_void:
        event.add(Replay, reason="a cable", **final)
    assert called(event) == [("cup:w2.1", "north")]


@pytest.mark.parametrize("break_s", [0.0, 600.0])
def test_a_clock_that_was_set_back_holds_no_stage(break_s: float) -> None:
    """Games that ended in the future, by the clock of now, make no stage and no final wait."""
    event = Cup("round-robin", teams=2)
    event.add(Closed)
    breaks = {"break_s": break_s, "final_break_s": break_s}
    event.add(Planned, stage="finals", format="single-knockout", after="cup", **breaks)
    play_open(event, event.contest.stages[0].matches[0].pairing.id)
    draw = due(event.contest, FORMATS)
    assert isinstance(draw, Drawn)
    event.append(draw)
    event.now_ms -= 500_000
    assert [pairing for pairing, _ in called(event)] == ["finals:w1.1"]


def test_a_match_is_moved_before_its_stage_is_drawn() -> None:
    """A move that comes early counts later; until then it is no fact that changes nothing."""
    event = Event(4, 2, Random(1))
    event.add(Planned, stage="cup", format="single-knockout")
    event.add(Moved, pairing="cup:w1.2", court="south", not_before_ms=5_000)
    assert event.contest.unused == ()
    event.add(Drawn, stage="cup", entries=tuple(event.names))
    assert called(event) == [("cup:w1.1", "north")]
    event.now_ms = 5_000
    assert called(event) == [("cup:w1.1", "north"), ("cup:w1.2", "south")]


def test_a_pause_holds_all_games() -> None:
    """Nothing is called in a pause; it ends when somebody says so, or at its time."""
    cup = Cup()
    assert len(called(cup)) == 2
    cup.add(Paused, reason="a cable")
    assert called(cup) == []
    assert (cup.contest.day.paused, cup.contest.day.reason) == (True, "a cable")
    cup.add(Resumed)
    assert len(called(cup)) == 2
    cup.add(Paused, until_ms=cup.now_ms + 10)
    assert called(cup) == []
    cup.now_ms += 10
    assert len(called(cup)) == 2


def test_all_that_is_to_come_is_shifted() -> None:
    """After a shift nothing is called for so long, and appointed times are as much later."""
    cup = Cup()
    first, second = (match.pairing.id for match in cup.contest.stages[0].matches[:2])
    cup.add(Moved, pairing=first, not_before_ms=cup.now_ms + MINUTE_MS)
    cup.add(Moved, pairing=second, not_before_ms=cup.now_ms - MINUTE_MS)
    cup.add(Shifted, by_ms=15 * MINUTE_MS, reason="a speech")
    moved = {move.pairing: move.not_before_ms for move in cup.contest.moves}
    assert moved == {first: cup.now_ms + 16 * MINUTE_MS, second: cup.now_ms - MINUTE_MS}
    assert called(cup) == []
    cup.now_ms += 15 * MINUTE_MS
    assert first not in dict(called(cup))
    assert second in dict(called(cup))


def test_a_shift_is_taken_back_as_if_it_had_never_been() -> None:
    """Set times are as before, a pause has its own end again, and an older shift stays."""
    cup = Cup()
    first, second = (match.pairing.id for match in cup.contest.stages[0].matches[:2])
    cup.add(Moved, pairing=first, not_before_ms=cup.now_ms + 5 * MINUTE_MS)
    cup.add(Paused, until_ms=cup.now_ms + 3 * MINUTE_MS)
    before = cup.contest
    one = cup.add(Shifted, by_ms=MINUTE_MS)
    other = cup.add(Shifted, by_ms=15 * MINUTE_MS)
    cup.add(Moved, pairing=second, not_before_ms=cup.now_ms + 9 * MINUTE_MS)
    cup.add(Unshifted, shift=other.id)
    now = cup.contest
    assert now.shifted == one
    assert [move.not_before_ms - cup.now_ms for move in now.moves] == [6 * MINUTE_MS, 9 * MINUTE_MS]
    cup.add(Unshifted, shift=one.id)
    now = cup.contest
    assert (now.shifted, now.day, now.moves[0]) == (None, before.day, before.moves[0])
    again = cup.add(Unshifted, shift=one.id)
    assert [(one.fact, one.why.code) for one in cup.contest.unused] == [
        (again.id, "league.no-shift")
    ]


def test_the_newest_line_is_shown() -> None:
    """A line to all stands until another one, or none, takes its place."""
    cup = Cup()
    for text in ("Lunch", "Lunch is over"):
        cup.add(Announced, text=text)
        assert cup.contest.announced is not None
        assert cup.contest.announced.text == text
    cup.add(Announced, text="")
    assert cup.contest.announced is None


def test_a_substitute_takes_a_place_that_nobody_has_played_in() -> None:
    """A substitute sits where its team would have sat; a team that has played keeps its place."""
    cup = Cup("single-knockout")
    cup.add(Entered, team="late", reason="a reserve", files="x")
    play_open(cup, "cup:w1.1")  # t001 against t004
    cup.add(Substituted, team="t002", substitute="late", reason="ill")
    (view,) = cup.contest.stages
    assert view.stage.entries == ("t001", "late", "t003", "t004")
    assert view.matches[1].teams == ("late", "t003")
    assert view.matches[1].state == "open"
    assert [team.name for team in cup.contest.teams if team.gone] == ["t002"]
    cup.add(Substituted, team="t001", substitute="t003", reason="no")
    (view,) = cup.contest.stages
    assert view.stage.entries == ("t001", "late", "t003", "t004")


def test_who_has_a_result_by_a_decision_keeps_its_place() -> None:
    """Also who won because nobody came; for the team that did not come a substitute may come.

    If its game is to be played after all, it can be replaced again.
    """
    cup = Cup("single-knockout")
    cup.add(Entered, team="late", reason="a reserve", files="x")
    first, second = (match.pairing.id for match in cup.contest.stages[0].matches[:2])
    ruled = {"pairing": first, "game": 1, "teams": ("t001", "t004"), "reason": "agreed"}
    cup.add(Replaced, scores=(9, 1), outcome="left", **ruled)
    cup.add(NoShow, pairing=second, team="t003", opponent="t002")
    entries = cup.contest.stages[0].stage.entries
    for number, (team, is_replaced) in enumerate(
        (("t001", False), ("t004", False), ("t002", False), ("t003", True))
    ):
        trial = Cup("single-knockout")
        trial.facts = list(cup.facts)
        trial.add(Substituted, team=team, substitute="late", reason="ill")
        assert (trial.contest.stages[0].stage.entries != entries) is is_replaced, number
    undrawn = cup.add(Undrawn, stage="cup", reason="a late team")
    assert [(one.fact, one.why.code) for one in cup.contest.unused] == [
        (undrawn.id, "league.played-already")
    ]
    cup.add(Replay, **ruled)
    cup.add(Substituted, team="t001", substitute="late", reason="ill")
    assert cup.contest.stages[0].stage.entries == ("late", "t002", "t003", "t004")


def test_what_takes_a_decision_back_takes_its_result_back() -> None:
    """A game that is played again takes no other game's result along.

    When a substitute comes for a team that did not come, its opponent is free again too.
    """
    cup = Cup("single-knockout", games=3)
    first, second = cup.contest.stages[0].matches[:2]
    about = {"pairing": first.pairing.id, "teams": ("t001", "t004"), "reason": "agreed"}
    for game in (1, 2):
        cup.add(Replaced, game=game, scores=(9, 1), outcome="left", **about)
    cup.add(Replay, game=2, **about)
    assert cup.contest.with_result == {"cup": {"t001", "t004"}}
    cup.add(Replay, game=1, **about)
    assert cup.contest.with_result == {}
    left, right = second.teams
    for team, other in ((left, right), (right, left)):
        cup.add(NoShow, pairing=second.pairing.id, team=team, opponent=other)
        assert cup.contest.with_result == ({"cup": {other}} if team == left else {})
    cup.add(Entered, team="late", reason="a reserve", files="x")
    cup.add(Substituted, team=left, substitute="late", reason="ill")
    assert cup.contest.with_result == {}


def test_who_did_not_come_in_one_match_may_come_to_another() -> None:
    """A correction gives a team another opponent: it is not absent in the new match."""
    cup = Cup("single-knockout")
    for pairing in ("cup:w1.1", "cup:w1.2"):
        play_open(cup, pairing)
    final = cup.contest.stages[0].matches[-1]
    absent, other = final.teams
    assert absent
    assert other
    cup.add(NoShow, pairing=final.pairing.id, team=absent, opponent=other)
    assert cup.contest.stages[0].matches[-1].winner == other
    games = {"pairing": "cup:w1.2", "game": 1, "reason": "miscounted"}
    seats = cup.contest.matches["cup:w1.2"].games[0].teams
    outcome = "left" if seats[1] == other else "right"
    cup.add(Replaced, teams=seats, scores=(5, 5), outcome=outcome, **games)
    now = cup.contest.stages[0].matches[-1]
    assert now.teams[0] == absent
    assert now.state == "open"
    assert [one.why.code for one in cup.contest.unused][-1] == "league.other-teams"


@pytest.mark.parametrize("substitute", ["t002", "nobody", "t001"])
def test_who_can_be_no_substitute_is_none(substitute: str) -> None:
    """A team that has left, is not there, or is the team itself takes no place."""
    cup = Cup("single-knockout")
    cup.add(Substituted, team="t002", substitute="t003", reason="ill")
    fact = cup.add(Substituted, team="t001", substitute=substitute, reason="no")
    assert [(one.fact, one.why.code) for one in cup.contest.unused] == [
        (fact.id, "league.no-substitute")
    ]


def test_a_draw_is_taken_back_until_somebody_has_played() -> None:
    """After that the stage waits to be drawn again, also with a late team; later it stays."""
    cup = Cup("single-knockout")
    cup.add(Undrawn, stage="cup", reason="a late team")
    cup.add(Entered, team="late", reason="a late train", files="x")
    assert cup.contest.stages == ()
    cup.add(Closed)
    draw = due(cup.contest, FORMATS)
    assert isinstance(draw, Drawn)
    assert draw.entries == (*cup.names, "late")
    cup.append(draw)
    play_open(cup, next(one.pairing.id for one in cup.contest.stages[0].matches if one.next_seats))
    fact = cup.add(Undrawn, stage="cup", reason="no")
    assert [(one.fact, one.why.code) for one in cup.contest.unused] == [
        (fact.id, "league.played-already")
    ]
    assert len(cup.contest.stages) == 1


def test_a_substitute_is_in_the_draw_that_is_made_again() -> None:
    """Its place in a draw that was taken back is its own in the next one, too."""
    cup = Cup("single-knockout")
    cup.add(Entered, team="late", reason="a reserve", files="x")
    cup.add(Planned, stage="finals", format="round-robin", after="cup", teams=2)
    cup.add(Closed)
    for _ in range(2):
        play_open(cup, *(m.pairing.id for m in cup.contest.stages[0].matches if m.next_seats))
    draw = due(cup.contest, FORMATS)
    assert isinstance(draw, Drawn)
    first, second = draw.entries
    cup.append(draw)
    cup.add(Substituted, team=first, substitute="late", reason="ill")
    assert cup.contest.stages[1].stage.entries == ("late", second)
    cup.add(Entered, team="later", reason="another reserve", files="x")
    cup.add(Substituted, team="late", substitute="later", reason="ill")
    cup.add(Undrawn, stage="finals", reason="a wrong order")
    draw = due(cup.contest, FORMATS)
    assert isinstance(draw, Drawn)
    assert draw.entries == ("later", second)


def test_a_draw_stays_while_a_court_has_a_game_of_it() -> None:
    """Also if both were decided in the same moment; when the game is taken back, it can go."""
    cup = Cup("single-knockout")
    match = cup.contest.stages[0].matches[0]
    assert match.next_seats is not None
    cup.call(match.pairing.id, "north", match.next_seats)
    cup.add(Undrawn, stage="cup", reason="late")
    assert [one.why.code for one in cup.contest.unused] == ["league.played-already"]
    cup.add(Recalled, pairing=match.pairing.id, game=1)
    cup.add(Undrawn, stage="cup", reason="late")
    assert cup.contest.stages == ()


def test_a_lot_gives_the_same_order_to_everybody() -> None:
    """The order follows from the lot alone; another lot gives another order, each as often."""
    teams = ["Ants", "Bees", "Crabs", "Dogs"]
    assert by_lot(teams, "3 1 4") == by_lot(reversed(teams), " 3 1 4 ")
    first = Counter(by_lot(teams, str(lot))[0] for lot in range(4000))
    assert all(900 < number < 1100 for number in first.values())


@given(
    st.lists(st.sampled_from(["", "red", "blue"]), min_size=2, max_size=12),
    st.integers(1, 4),
)
def test_teams_of_one_club_are_kept_apart(clubs: list[str], groups: int) -> None:
    """Never do more of one club meet than before; nobody is lost; no order changes for nothing."""
    names = tuple(f"t{number}" for number in range(len(clubs)))
    club_of = dict(zip(names, clubs, strict=True))

    def met(order: tuple[str, ...]) -> list[tuple[str, str]]:
        dealt = [order[at::groups] for at in range(groups)]
        return [(one, two) for group in dealt for one in group for two in group if one < two]

    def clash(order: tuple[str, ...]) -> list[tuple[str, str]]:
        return [(one, two) for one, two in met(order) if club_of[one] == club_of[two] != ""]

    found = set_apart(names, clash)
    assert sorted(found) == sorted(names)
    assert len(clash(found)) <= len(clash(names))
    if not clash(names):
        assert found == names


def test_the_best_of_two_schools_meet_late() -> None:
    """In a bracket of two schools with two teams each, nobody meets the own school in round 1."""
    event = Event(0, 2, Random(1))
    for team, club in (("a1", "a"), ("b1", "b"), ("b2", "b"), ("a2", "a")):
        event.add(Entered, team=team, club=club, files=team)
    event.add(Planned, stage="cup", format="single-knockout", apart=True)
    event.add(Closed)
    draw = due(event.contest, FORMATS)
    assert isinstance(draw, Drawn)
    event.append(draw)
    pairs = [match.teams for match in event.contest.stages[0].matches[:2]]
    assert {tuple(sorted(team[0] for team in pair if team)) for pair in pairs} == {("a", "b")}


@pytest.mark.parametrize("groups", [2, 4])
@pytest.mark.parametrize("seed", range(4))
def test_the_first_two_of_a_group_meet_again_only_late(groups: int, seed: int) -> None:
    """With `apart`, the first two of each group cross over: winners stay the best seeds.

    Without it the ranking alone makes the order, so teams of a group may meet again.
    """
    event = Event(3 * groups, 2, Random(seed))
    event.begin("groups", "round-robin", event.names, groups=groups)
    for _ in event.play("groups"):
        pass
    ranking = event.contest.stages[0].ranking[: 2 * groups]
    settings = {"format": "single-knockout", "after": "groups", "teams": 2 * groups}
    event.add(Planned, stage="cup", met_apart=True, **settings)
    event.add(Closed)
    plan = event.contest.planned[0]
    how = FORMATS["single-knockout"]
    draw = due(event.contest, FORMATS)
    assert isinstance(draw, Drawn)
    assert draw.entries[:groups] == ranking[:groups]
    assert sorted(draw.entries) == sorted(ranking)
    assert meets_again(event.contest, plan, how, draw.entries) == ()
    if meets_again(event.contest, plan, how, ranking) == ():
        assert draw.entries == ranking


def test_in_one_group_all_have_met_so_the_order_stays() -> None:
    """Where nothing avoids that teams meet again, `apart` changes no seeding."""
    cup = Cup(teams=4)
    for _ in cup.play("cup"):
        pass
    cup.add(Planned, stage="final", format="single-knockout", after="cup", met_apart=True)
    cup.add(Closed)
    draw = due(cup.contest, FORMATS)
    assert isinstance(draw, Drawn)
    assert draw.entries == cup.contest.stages[0].ranking
    again = meets_again(
        cup.contest, cup.contest.planned[0], FORMATS["single-knockout"], draw.entries
    )
    assert len(again) == 2
