"""Tests of where each team of a contest plays, or what it waits for."""

from random import Random
from typing import Any

import pytest
from chance_event import GAME_MS, LEAST_REST_MS, Event
from cup import Cup

from lacoc_server.contest.league.contest import Contest
from lacoc_server.contest.league.facts import (
    Closed,
    Disqualified,
    Drawn,
    Entered,
    NoShow,
    Paused,
    Planned,
    Played,
    StageSettings,
    Substituted,
    Undrawn,
    Withdrawn,
)
from lacoc_server.contest.league.fixture import named
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.league.timetable.calling import SeenCourt
from lacoc_server.contest.league.timetable.foreseen import foreseen
from lacoc_server.contest.league.timetable.schedule import assign
from lacoc_server.contest.league.timetable.whereabouts import (
    ContestPace,
    SeenCourts,
    game_ms,
    starts,
    whereabouts,
)
from lacoc_server.contest.league.titles import titles
from lacoc_server.contest.live.teller import Teller
from lacoc_shared.messages import Done
from lacoc_shared.messages.office import Whereabouts
from lacoc_shared.words import faults, render, say

ADDRESSES = {"north": "tcp/10.0.0.1:7447", "south": "tcp/10.0.0.1:7448"}
GAME = 120_000
"""Length of a game in these tests [ms]."""


def found_for(contest: Contest, courts: SeenCourts, pace: ContestPace) -> dict[str, Whereabouts]:
    """Return where each team is, with the estimate of when matches begin."""
    begins = dict(starts(contest, foreseen(contest, FORMATS), courts.seen, pace))
    return whereabouts(contest, courts, pace, begins)


def where(cup: Cup, calls: dict[str, str], rest_ms: int = 0) -> dict[str, Whereabouts]:
    """Return where each team is; `calls` maps each court to the call that it shows."""
    seen = {court: SeenCourt(cup.now_ms, calls.get(court, "")) for court in ADDRESSES}
    found = found_for(
        cup.contest, SeenCourts(seen, ADDRESSES), ContestPace(cup.now_ms, GAME, rest_ms)
    )
    for there in found.values():
        assert faults(there.said) == []
    return found


def playing(cup: Cup) -> dict[str, str]:
    """Give the first two games to the two courts; return the courts' calls."""
    first, second = (match.pairing for match in cup.contest.stages[0].matches[:2])
    teams = [match.next_seats for match in cup.contest.stages[0].matches[:2]]
    assert teams[0] is not None
    assert teams[1] is not None
    return {
        "north": cup.call(first.id, "north", teams[0]),
        "south": cup.call(second.id, "south", teams[1]),
    }


def test_nobody_is_sent_to_a_silent_court() -> None:
    """A court that is not there yet, or not any more, is in no estimate."""
    cup = Cup()
    seen = {"north": SeenCourt(0), "south": SeenCourt(cup.now_ms)}
    found = found_for(cup.contest, SeenCourts(seen, ADDRESSES), ContestPace(cup.now_ms, GAME, 0))
    assert {there.court for there in found.values()} == {"south"}


def test_a_team_whose_match_is_open_hears_where() -> None:
    """A team whose match is open hears its court, address, seat, call, fixture and opponent."""
    cup = Cup()
    calls = playing(cup)
    found = where(cup, calls)
    left, right = cup.contest.running[0].teams
    there, other = found[left], found[right]
    assert (there.state, there.court, there.address) == ("court", "north", ADDRESSES["north"])
    assert (there.seat, there.opponent, there.call) == ("left", right, calls["north"])
    assert (other.seat, other.opponent, other.call) == ("right", left, calls["north"])
    assert there.fixture is not None
    assert render(there.said) == (f"Court north, left seat, against {right}. Round robin, round 1.")


def test_a_team_waits_until_its_court_has_the_match() -> None:
    """Until its court has the match, a team waits: it hears court and opponent, but no address."""
    cup = Cup()
    calls = playing(cup)
    left, right = cup.contest.running[0].teams
    found = where(cup, calls | {"north": ""})
    assert (found[left].state, found[left].address, found[left].call) == ("waits", "", "")
    assert (found[left].court, found[left].about_s, found[left].games_before) == ("north", 0, 0)
    assert render(found[left].said) == f"Court north, in a moment, against {right}."


def test_in_a_pause_without_an_end_nobody_knows_when() -> None:
    """In a pause without an end a team hears court and opponent, and no time that is not true."""
    cup = Cup()
    cup.add(Paused, reason="a cable")
    there = where(cup, {})["t001"]
    assert (there.state, there.about_s) == ("waits", None)
    assert "after the pause, against" in render(there.said)
    cup.add(Paused, until_ms=cup.now_ms + 600_000)
    assert where(cup, {})["t001"].about_s == 600


def test_who_plays_after_a_team_that_has_not_come_is_told() -> None:
    """If a court waits for a team, nobody knows when its next game begins; the others hear why."""
    cup = Cup(teams=6)  # three matches a round, two courts
    calls = playing(cup)
    late = cup.contest.running[0].teams[0]
    team, other = cup.contest.stages[0].matches[2].teams

    def there() -> Whereabouts:
        seen = {one: SeenCourt(cup.now_ms, calls[one]) for one in ADDRESSES}
        seen["north"] = seen["north"]._replace(missing=(late,))
        pace = ContestPace(cup.now_ms, GAME)
        return found_for(cup.contest, SeenCourts(seen, ADDRESSES), pace)[str(team)]

    assert there().about_s is not None
    cup.now_ms += 30_000
    waits = there()
    assert (waits.court, waits.about_s) == ("north", None)
    assert faults(waits.said) == []
    assert (
        render(waits.said) == f"Court north, after a game that waits for {late}, against {other}."
    )


def test_how_long_a_team_waits() -> None:
    """A team that waits for a court hears which court is free next, and in how long."""
    cup = Cup(teams=6)  # three matches a round, two courts
    calls = playing(cup)
    matches = cup.contest.stages[0].matches
    waits = matches[2].teams
    cup.now_ms += 30_000
    there = where(cup, calls)[str(waits[0])]
    assert (there.state, there.court, there.opponent) == ("waits", "north", waits[1])
    assert (there.games_before, there.about_s) == (0, 90)
    assert render(there.said) == f"Court north, about 2 minutes, against {waits[1]}."
    busy = cup.contest.running[0].teams[0]
    assert where(cup, calls)[busy].state == "court"
    assert where(cup, {}, rest_ms=0)[str(waits[0])].games_before == 0


def test_a_team_rests_before_its_next_match() -> None:
    """The estimate counts the rest of a team, also if a court is free."""
    cup = Cup(teams=3, how="round-robin")
    first = cup.contest.stages[0].matches
    match = next(one for one in first if one.state == "open")
    assert match.next_seats is not None
    cup.call(match.pairing.id, "north", match.next_seats)
    cup.now_ms += GAME
    cup.won(match.pairing.id, match.next_seats)
    found = where(cup, {}, rest_ms=60_000)
    coming = [there for there in found.values() if there.about_s is not None]
    assert {there.about_s for there in coming} == {60, 60 + (GAME + 60_000) // 1000}


@pytest.mark.parametrize("step_ms", [-900_000, 86_400_000])
def test_a_clock_that_was_set_makes_nobody_wait_for_it(step_ms: int) -> None:
    """After the machine's clock was set back or forward, teams wait no longer than before."""
    cup = Cup(teams=6)
    calls = playing(cup)
    waits = str(cup.contest.stages[0].matches[2].teams[0])
    assert where(cup, calls)[waits].about_s == 120
    cup.now_ms += step_ms
    about_s = where(cup, calls, rest_ms=60_000)[waits].about_s
    assert about_s is not None
    assert about_s <= 120
    for call in cup.contest.running:
        cup.won(call.pairing, call.teams)
    assert game_ms(cup.facts, GAME) == GAME


def test_a_clock_that_was_set_back_stops_no_contest() -> None:
    """A team whose game seems to end tomorrow does not rest until then."""
    cup = Cup(teams=3, how="round-robin")
    match = next(one for one in cup.contest.stages[0].matches if one.state == "open")
    assert match.next_seats is not None
    cup.call(match.pairing.id, "north", match.next_seats)
    cup.now_ms += GAME
    cup.won(match.pairing.id, match.next_seats)
    cup.now_ms -= 900_000
    assert len(assign(cup.contest, ["north"], cup.now_ms, 60_000)) == 1


def test_a_knockout_goes_on() -> None:
    """A winner waits for its next opponent; a loser is out, and hears its place at the end."""
    cup = Cup("single-knockout")
    final = next(match for match in cup.contest.stages[0].matches if match.state == "waits")
    first, second = (m for m in cup.contest.stages[0].matches if m.state == "open")
    assert first.next_seats is not None
    assert second.next_seats is not None
    cup.won(first.pairing.id, first.next_seats)
    winner, loser = first.next_seats
    found = where(cup, {})
    assert (found[winner].state, found[winner].opponent) == ("waits", "")
    assert found[winner].about_s == GAME // 1000  # after the other semi-final
    assert render(found[winner].said) == (
        "Final: court south, about 2 minutes. Your opponent is not known yet."
    )
    assert (found[loser].state, found[loser].rank) == ("out", 0)
    assert render(found[loser].said) == "You have played your last match."
    cup.won(second.pairing.id, second.next_seats)
    cup.won(final.pairing.id, (winner, second.next_seats[0]))
    found = where(cup, {})
    assert {there.state for there in found.values()} == {"over"}
    assert render(found[winner].said) == "The contest is over: place 1 in Knockout."
    assert (found[loser].state, found[loser].rank) == ("over", 3)


def test_the_finalists_wait_for_the_match_for_third_place() -> None:
    """While others play for third place, the finalists hear where and when their final begins."""
    cup = Cup("single-knockout", third_place=True)
    first, second = (m for m in cup.contest.stages[0].matches if m.state == "open")
    assert first.next_seats is not None
    assert second.next_seats is not None
    cup.won(first.pairing.id, first.next_seats)
    cup.won(second.pairing.id, second.next_seats)
    third = next(m for m in cup.contest.stages[0].matches if m.pairing.section == "p")
    assert third.next_seats is not None
    winner, other = first.next_seats[0], second.next_seats[0]
    for calls in ({}, {"north": cup.call(third.pairing.id, "north", third.next_seats)}):
        found = where(cup, calls)
        assert (found[winner].state, found[winner].opponent) == ("waits", other)
        assert (found[other].state, found[other].about_s) == ("waits", GAME // 1000)
        assert found[winner].fixture is not None
        assert render(found[winner].fixture) == "Final"


def test_teams_that_are_equal_in_all_share_their_place() -> None:
    """At the end each of them hears whom it shares its place with, in both languages."""
    cup = Cup(teams=2, how="round-robin", rounds=2)
    for match in cup.contest.stages[0].matches:
        assert match.next_seats is not None
        cup.won(match.pairing.id, match.next_seats)
    found = where(cup, {})
    one, other = cup.names
    assert [there.rank for there in found.values()] == [1, 1]
    said = found[one].said
    assert render(said) == f"The contest is over: place 1 in Round robin, shared with {other}."
    assert render(said, "ja") == f"大会は終わりました（総当たり戦 1 位（{other}と同率））。"


def test_stages_have_titles_in_both_languages() -> None:
    """The organiser's title is taken; stages of one usual name have numbers."""
    cup = Cup()
    for name, title in (("a", {}), ("b", {"en": "Finals", "ja": "決勝"}), ("c", {})):
        cup.add(Planned, stage=name, format="single-knockout", after="cup", title=title)
    found = titles(cup.contest)
    assert [render(title) for title in found.values()] == [
        "Round robin",
        "Knockout 1",
        "Finals",
        "Knockout 2",
    ]
    assert [render(title, "ja") for title in found.values()] == [
        "総当たり戦",
        "トーナメント 1",
        "決勝",
        "トーナメント 2",
    ]
    assert not [fault for title in found.values() for fault in faults(title)]


def test_a_stage_that_is_not_drawn() -> None:
    """A team that may still be drawn waits; a team that withdrew or was disqualified is out."""
    cup = Cup()
    cup.add(Planned, stage="finals", format="single-knockout", after="cup", teams=2)
    for match in cup.contest.stages[0].matches[:-1]:
        assert match.next_seats is not None
        cup.won(match.pairing.id, match.next_seats)
    last = {str(team) for team in cup.contest.stages[0].matches[-1].teams}
    free = next(name for name in cup.names if name not in last)
    assert where(cup, {})[free].said.code == "team.awaits-draw"
    cup.add(Withdrawn, team=free, reason="ill")
    there = where(cup, {})[free]
    assert (there.state, there.said) == ("out", say("team.withdrawn", reason="ill"))
    cup.add(Disqualified, team=next(iter(last)))
    assert where(cup, {})[next(iter(last))].state == "out"
    match = cup.contest.stages[0].matches[-1]
    assert match.decided, "its opponent has won by walkover"
    here = {team.name for team in cup.contest.teams if not team.gone}
    cup.add(Drawn, stage="finals", entries=tuple(sorted(here)))
    in_final = set(cup.contest.stages[1].stage.entries)
    states = {name: there.state for name, there in where(cup, {}).items()}
    assert {name for name, state in states.items() if state == "waits"} == in_final


def test_before_the_first_draw_all_wait() -> None:
    """Before the first draw all teams wait for it; after it was taken back they are told why."""
    event = Event(3, 1, Random(1))
    event.add(Planned, stage="cup", format="round-robin", settings=StageSettings())

    def codes() -> set[str]:
        found = found_for(event.contest, SeenCourts({}, {}), ContestPace(0, GAME))
        return {there.said.code for there in found.values()}

    assert codes() == {"team.awaits-draw"}
    event.add(Closed)
    event.add(Drawn, stage="cup", entries=tuple(event.names))
    assert "team.draw-taken-back" not in codes()
    event.add(Undrawn, stage="cup", reason="a late team")
    assert codes() == {"team.draw-taken-back"}


def test_a_team_that_came_back_is_not_told_that_it_left() -> None:
    """A team that withdrew and entered again has a place or none, but it has not left."""
    event = Event(3, 1, Random(1))
    event.add(Planned, stage="cup", format="round-robin", settings=StageSettings())
    back = event.names[0]

    def code() -> str:
        found = found_for(event.contest, SeenCourts({}, {}), ContestPace(0, GAME))
        return found[back].said.code

    event.add(Withdrawn, team=back)
    assert code() == "team.withdrawn"
    event.add(Entered, team=back, files="f")
    event.add(Closed)
    event.add(Drawn, stage="cup", entries=tuple(event.names[1:]))
    assert code() == "team.no-place"


def test_a_team_is_told_who_plays_in_its_place() -> None:
    """A team whose place another one took is not thanked for its last match."""
    cup = Cup()
    cup.add(Entered, team="Late", files="f")
    assert where(cup, {})["Late"].said.code == "team.no-place"
    cup.add(Substituted, team=cup.names[0], substitute="Late", reason="a broken leg")
    said = say("team.substituted", substitute="Late", reason="a broken leg")
    assert where(cup, {})[cup.names[0]].said == said


def test_a_team_whose_opponent_leaves_is_told_that_it_wins() -> None:
    """Whose opponent withdraws reads so, with the match and the reason; other teams read nothing.

    In a round robin a team that leaves has a match with each other one; each reads of its own.
    """
    for fact in (Withdrawn, Disqualified):
        cup = Cup(teams=8, groups=2)
        first = cup.contest.stages[0].matches[0]
        here, away = first.teams
        assert here
        assert away
        cup.add(fact, team=away, reason="a broken leg")
        found = where(cup, {})
        news = found[here].news
        assert news is not None
        assert faults(news) == []
        said = render(news)
        assert said.startswith(f"{render(named(cup.contest, first.pairing.id))}: {away} ")
        assert said.endswith("You win this match. Reason: a broken leg")
        group = {t for m in cup.contest.stages[0].matches if away in m.teams for t in m.teams}
        assert {name for name, there in found.items() if there.news} == group - {away}


def test_teams_are_told_what_was_decided_about_their_match() -> None:
    """Whose opponent did not come reads why the match is won, until the team plays again."""
    cup = Cup()
    first = cup.contest.stages[0].matches[0]
    here, absent = first.teams
    assert here
    assert absent
    cup.add(NoShow, pairing=first.pairing.id, team=absent, reason="not seen since noon")
    found = where(cup, {})
    for team in (here, absent):
        news = found[team].news
        assert news is not None
        assert faults(news) == []
        wins = "You win this match. " * (team == here)
        assert f"{absent} did not come. {wins}Reason: not seen since noon" in render(news)
    assert [there.news for name, there in found.items() if name not in first.teams] == [None] * 2
    cup.add(Entered, team="Late", files="f")
    cup.add(Substituted, team=absent, substitute="Late", reason="a broken leg")
    found = where(cup, {})
    assert found["Late"].news is None
    news = found[here].news
    assert news is not None
    assert f"Late takes the place of {absent}. Reason: a broken leg" in render(news)
    assert "You win" not in render(news), "the match is open again"
    later = next(match for match in cup.contest.stages[0].matches[1:] if here in match.teams)
    assert later.next_seats is not None
    cup.add(NoShow, pairing=first.pairing.id, team="Late")
    assert where(cup, {})[here].news is not None
    cup.now_ms += 60_000
    cup.won(later.pairing.id, later.next_seats)
    assert where(cup, {})[here].news is None
    assert where(cup, {})["Late"].news is not None


def test_what_can_be_played_before_the_first_draw() -> None:
    """Before the first draw the matches of its format are foreseen."""
    event = Event(3, 1, Random(1))
    event.add(Planned, stage="cup", format="round-robin", settings=StageSettings())
    fixtures = {render(match.fixture) for match in foreseen(event.contest, FORMATS)}
    assert fixtures == {f"Round robin, round {number}" for number in (1, 2, 3)}


def test_the_usual_length_of_a_game() -> None:
    """The usual length is the median of all ended games; until one has ended, a given value."""
    cup = Cup()
    assert game_ms(cup.facts, 7) == 7
    for match, length in zip(cup.contest.stages[0].matches, (10, 20, 90), strict=False):
        assert match.next_seats is not None
        cup.call(match.pairing.id, "north", match.next_seats)
        cup.now_ms += length
        cup.won(match.pairing.id, match.next_seats)
    assert game_ms(cup.facts, 7) == 20


@pytest.mark.parametrize("how", ["round-robin", "swiss", "single-knockout", "double-knockout"])
@pytest.mark.parametrize("trouble", [0.0, 0.3])
def test_any_contest(how: str, trouble: float) -> None:
    """At each step of a random contest, exactly the teams that are called are on a court."""
    event = Event(7, 2, Random(how), trouble)
    event.begin("cup", how, event.names, games=3)
    addresses = dict.fromkeys(event.courts, "tcp/10.0.0.1:7447")
    for contest, _ in event.play("cup"):
        calls = {call.court: call.id for call in event.contest.running}
        seen = {court: SeenCourt(event.now_ms, calls.get(court, "")) for court in event.courts}
        pace = ContestPace(event.now_ms, GAME_MS, LEAST_REST_MS)
        found = found_for(event.contest, SeenCourts(seen, addresses), pace)
        assert list(found) == [team.name for team in contest.teams]
        on_court = {name for name, there in found.items() if there.state == "court"}
        assert on_court == {team for call in event.contest.running for team in call.teams}
        gone = {team.name for team in event.contest.teams if team.gone}
        assert all(found[name].state != "waits" for name in gone - on_court)
        open_teams = {
            team
            for match in event.contest.stages[0].matches
            if match.state == "open"
            for team in match.teams
        }
        assert all(found[str(name)].state in ("court", "waits") for name in open_teams)
    assert {there.state for there in found.values()} <= {"court", "waits", "out", "over"}


def test_a_shared_rank_sends_one_team_of_each_group_on() -> None:
    """Where two teams of a group share its first rank, the order of the draw says who goes on."""
    cup = Cup("round-robin", groups=2)
    for match in cup.contest.stages[0].matches:
        assert match.next_seats is not None
        teams, about = match.next_seats, match.pairing.id
        cup.add(Played, pairing=about, game=1, teams=teams, scores=(2, 2), outcome="draw")
    (view,) = cup.contest.stages
    assert [[row.rank for row in table.rows] for table in view.tables] == [[1, 1], [1, 1]]
    assert view.ranking == ("t001", "t002", "t003", "t004")


class _Told:
    """Stands in for the connection to a court; it keeps what the office tells."""

    is_there = True

    def __init__(self) -> None:
        self.teams: dict[str, Whereabouts] = {}

    def tell(self, teams: dict[str, Whereabouts]) -> "_Told":
        self.teams = teams
        return self

    def take(self) -> Done:
        return Done()


def test_a_team_that_applied_is_told_that_it_waits() -> None:
    """Its link leads to a page that says so, and goes on when the organiser has approved it."""
    event = Event(2, 1, Random(1))
    ann, ben = event.names
    court, applied = _Told(), ["Zoe", ann]
    links: Any = {"north": court}
    teller = Teller(links, ADDRESSES, lambda team: team, 0, applicants=lambda: tuple(applied))

    contest = event.contest

    def said() -> dict[str, str]:
        teller.tell(contest, (), {}, GAME)
        return {there.team: there.said.code for there in court.teams.values()}

    # The first team is in; only its newest files wait.
    approval = "team.awaits-approval"
    assert {team: code == approval for team, code in said().items()} == {
        ann: False,
        ben: False,
        "Zoe": True,
    }
    applied.clear()
    assert {*said()} == {ann, ben}
