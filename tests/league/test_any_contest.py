"""Tests of random contests: each step is legal, and facts in any order give the same contest."""

from collections import Counter
from random import Random

import pytest
from chance_event import GAME_MS, LEAST_REST_MS, Event
from hypothesis import given, settings
from hypothesis import strategies as st

from lacoc_server.contest.league.contest import Contest, compute
from lacoc_server.contest.league.facts import Played, decode, encode
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.league.timetable.schedule import Assignment

FORMAT_NAMES = ("round-robin", "swiss", "sequential", "single-knockout", "double-knockout")
FORMAT_CASES = [
    pytest.param(how, marks=[pytest.mark.long] if how == "sequential" else [])
    for how in FORMAT_NAMES
]
"""Formats; a sequential contest takes as long as all others together."""


def most_rounds(how: str, teams: int) -> int:
    """Return little more than a lap for a sequential stage; else 0, the format's own number."""
    return teams + 1 if how == "sequential" else 0


def check_step(event: Event, contest: Contest, given_out: list[Assignment]) -> None:
    """Check one step of a contest: no team and no court has two games, and teams have rested."""
    games = [*event.ends.values()]
    assert len(games) == len(contest.running) + len(given_out)
    teams = Counter(team for _, game in games for team in game.teams)
    assert not teams or max(teams.values()) == 1
    assert len({game.court for _, game in games}) == len(games)
    for one in given_out:
        for team in one.teams:
            pairing, end_ms = contest.ended_ms.get(team, (one.pairing, 0))
            assert pairing == one.pairing or event.now_ms - end_ms >= LEAST_REST_MS


def check_matches(contest: Contest) -> None:
    """Check the matches of a contest that is over."""
    for view in contest.stages:
        entries = {*view.stage.entries}
        by_round: Counter[tuple[str, int, str]] = Counter()
        for match in view.matches:
            assert match.decided
            known = [team for team in match.teams if team]
            assert {*known} <= entries
            assert len({*known}) == len(known)
            by_round.update((match.pairing.section, match.pairing.round, team) for team in known)
            assert match.winner in (*match.teams, "", None)
            for game in match.games:
                assert {*game.teams} == {*match.teams}
            assert [game.number for game in match.games] == [*range(1, len(match.games) + 1)]
            left = Counter(game.teams[0] for game in match.games)
            assert not known or abs(left[known[0]] - left[known[-1]]) <= 1 or len(known) == 1
        assert not by_round or max(by_round.values()) == 1
        ranked = [row.team for table in view.tables for row in table.rows]
        assert sorted(ranked) == sorted(entries)
        assert {*view.ranking} <= entries


def check_facts(event: Event, contest: Contest) -> None:
    """Check that the facts give the same bytes in any order of arrival, also if some come twice."""
    expected = contest.encoded()
    encoded = encode(event.facts)
    for _ in range(3):
        arrived = event.facts + event.random.sample(event.facts, len(event.facts) // 3)
        event.random.shuffle(arrived)
        assert compute(arrived, FORMATS).encoded() == expected
        assert encode(arrived) == encoded
    assert compute(decode(encoded), FORMATS).encoded() == expected
    assert encode(decode(encoded)) == encoded


def check_results(event: Event, contest: Contest) -> None:
    """Check that each game that was played counts once, is listed as unused, or was made void."""
    played = [fact.id for fact in event.facts if isinstance(fact, Played)]
    counts = Counter(
        game.fact for view in contest.stages for match in view.matches for game in match.games
    )
    unused = {one.fact for one in contest.unused}
    voided = {
        fact.id
        for fact in event.facts
        if isinstance(fact, Played)
        for view in contest.stages
        for match in view.matches
        if match.pairing.id == fact.pairing and match.how == "void"
    }
    for fact in played:
        assert counts[fact] + (fact in unused) == 1 or fact in voided


def play(event: Event, how: str, **options: int) -> None:
    """Play a contest of one stage and check it at every step and at its end."""
    event.begin("main", how, event.names, **options)
    for contest, given_out in event.play("main"):
        check_step(event, contest, given_out)
    contest = event.contest
    check_matches(contest)
    check_results(event, contest)
    check_facts(event, contest)


@pytest.mark.parametrize("how", FORMAT_CASES)
@settings(max_examples=settings.default.max_examples // 5)  # a contest has hundreds of steps
@given(
    teams=st.integers(2, 24),
    courts=st.integers(1, 16),
    games=st.integers(1, 3),
    trouble=st.sampled_from([0.0, 0.1, 0.4]),
    seed=st.integers(0, 2**32),
)
def test_any_contest(
    how: str, teams: int, courts: int, games: int, trouble: float, seed: int
) -> None:
    """Contests of 2 to 24 teams, also with trouble, come to their end, and each step is legal."""
    event = Event(teams, courts, Random(seed), trouble)
    play(event, how, games=games, groups=1 + teams // 12, rounds=most_rounds(how, teams))


@pytest.mark.long
@pytest.mark.parametrize("how", FORMAT_NAMES)
def test_200_entries(how: str) -> None:
    """A contest of 200 teams on 16 courts comes to its end, and each step is legal."""
    event = Event(200, 16, Random(1), 0.05)
    play(event, how, groups=40, rounds=5 if how in ("swiss", "sequential") else 0)


def test_groups_then_knockout() -> None:
    """Group winners lead the ranking, and the first eight of the ranking can play a knockout."""
    event = Event(12, 3, Random(5), 0.1)
    event.begin("groups", "round-robin", event.names, groups=3)
    for contest, given_out in event.play("groups"):
        check_step(event, contest, given_out)
    ranking = event.contest.stage("groups").ranking
    firsts = {table.rows[0].team for table in event.contest.stage("groups").tables}
    assert {*ranking[:3]} == firsts

    event.begin("finals", "double-knockout", [*ranking[:8]], games=3)
    for contest, given_out in event.play("finals"):
        check_step(event, contest, given_out)
    check_matches(event.contest)
    check_facts(event, event.contest)
    assert event.now_ms > GAME_MS
