"""Tests of sequential stages: they end when the first places are decided, and not before."""

from collections.abc import Sequence
from itertools import combinations
from random import Random
from statistics import fmean

import pytest
from chance_event import Event

from lacoc_server.contest.league.contest import Contest
from lacoc_server.contest.league.facts import (
    Drawn,
    Planned,
    Played,
    Replaced,
    StageSettings,
    Withdrawn,
)
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.league.formats.sequential import lead
from lacoc_server.contest.league.matches import CountedGame
from lacoc_server.contest.league.timetable.schedule import Assignment, due

TEAMS = 4
LAP = 3
GAMES = 2


class Strengths(Event):
    """An event whose teams win as often as their strengths say.

    Args:
        elo: strength of each team.
        seed: of the results.
    """

    def __init__(self, elo: list[float], seed: int) -> None:
        super().__init__(len(elo), 2, Random(seed))
        self.elo = dict(zip(self.names, elo, strict=True))

    def _played(self, game: Assignment) -> None:
        left, right = game.teams
        chance = 1 / (1 + 10 ** ((self.elo[right] - self.elo[left]) / 400))
        won = self.random.random() < chance
        self.add(
            Played,
            pairing=game.pairing,
            game=game.game,
            teams=game.teams,
            scores=(1, 0) if won else (0, 1),
            outcome="left" if won else "right",
            record="record",
        )


def play(event: Event, **settings: object) -> Contest:
    """Play a sequential stage to its end."""
    event.begin("main", "sequential", event.names, games=GAMES, **settings)
    for _ in event.play("main"):
        pass
    return event.contest


def drawn(contest: Contest) -> int:
    return len(contest.stage("main").stage.drawn)


def test_a_stage_without_a_team_is_over() -> None:
    """All teams of the stage before it have left: it has no round, also if the file names some."""
    event = Event(2, 1, Random(1))
    event.begin("main", "sequential", [], rounds=6)
    assert event.contest.stage("main").rounds_to_draw == 0
    assert due(event.contest, FORMATS) is None


def test_a_clear_order_ends_early_and_a_close_one_late() -> None:
    """A stage ends only after whole laps: a clear winner needs few, equal teams all of them."""
    clear = play(Strengths([1200.0, 0.0, 0.0, 0.0], 1))
    assert clear.stage("main").ranking[0] == "t001"
    assert drawn(clear) % LAP == 0
    assert drawn(clear) <= 4 * LAP
    close = play(Strengths([0.0] * TEAMS, 2), rounds=5 * LAP)
    assert drawn(close) == 5 * LAP
    assert close.stage("main").rounds_to_draw == 0
    more = play(Strengths([1200.0, 0.0, 0.0, 0.0], 1), places=TEAMS - 1, rounds=5 * LAP)
    assert drawn(more) > drawn(clear), "the places of equal teams are not decided"


def test_a_team_that_leaves_is_not_paired_any_more() -> None:
    """If all but one leave, the stage is over; rounds without them have fewer matches."""
    event = Strengths([0.0] * TEAMS, 3)
    event.begin("main", "sequential", event.names)
    for step, (contest, _) in enumerate(event.play("main")):
        if step == 4:
            event.add(Withdrawn, team="t002", reason="robot broken")
        if drawn(contest) == 2 * LAP:
            break
    later = [match for match in contest.stage("main").matches if match.pairing.round > LAP + 1]
    assert later
    assert all("t002" not in match.teams for match in later)
    for team in ("t003", "t004"):
        event.add(Withdrawn, team=team, reason="robot broken")
    for _ in event.play("main"):
        pass
    assert event.contest.stage("main").over


def test_a_correction_opens_only_the_last_stage_again() -> None:
    """After a correction the last stage may need more rounds; one that was followed does not."""
    event = Strengths([1200.0, 0.0, 0.0, 0.0], 1)
    contest = play(event)
    wins = [
        (match, game)
        for match in contest.stage("main").matches
        for game in match.games
        if game.winner == "t001"
    ]
    for match, game in wins:
        event.add(
            Replaced,
            pairing=match.pairing.id,
            game=game.number,
            teams=game.teams,
            scores=(1, 1),
            outcome="draw",
            reason="the score was read wrongly",
        )
    assert event.contest.stage("main").may_draw
    event.add(
        Planned, stage="final", format="single-knockout", settings=StageSettings(), after="main"
    )
    event.add(Drawn, stage="final", entries=("t001", "t002"))
    assert event.contest.stage("main").over


def results(elo: Sequence[float], seed: int, laps: int) -> list[CountedGame]:
    """Return the games of some laps, both sides of each match, by the teams' strengths."""
    chance = Random(seed)
    found = []
    for number in range(laps):
        for pair in combinations(range(len(elo)), 2):
            for left, right in (pair, pair[::-1]):
                wins = chance.random() < 1 / (1 + 10 ** ((elo[right] - elo[left]) / 400))
                found.append(
                    CountedGame(
                        number=number,
                        teams=(f"t{left}", f"t{right}"),
                        scores=(int(wins), int(not wins)),
                        outcome="left" if wins else "right",
                        fact="f",
                    )
                )
    return found


@pytest.mark.parametrize("teams", [2, 3, 5])
def test_equal_teams_are_seldom_taken_for_unequal(teams: int) -> None:
    """A lead of 1.64 standard deviations is as rare among equal teams as theory says: 5 %."""
    leads = [lead(results([0.0] * teams, seed, 10), "t0", "t1") for seed in range(400)]
    assert 0.02 <= sum(one > 1.645 for one in leads) / len(leads) <= 0.08
    assert [-one for one in leads] == pytest.approx(
        [lead(results([0.0] * teams, seed, 10), "t1", "t0") for seed in range(400)]
    )


def test_a_stronger_team_leads() -> None:
    """The lead grows with the strength and with the number of games; nothing played is no lead."""
    assert lead([], "t0", "t1") == 0
    means = [
        fmean(lead(results([elo, 0.0, 0.0], seed, laps), "t0", "t1") for seed in range(60))
        for elo, laps in ((0.0, 5), (100.0, 5), (300.0, 5), (300.0, 20))
    ]
    assert means == sorted(means)
    assert abs(means[0]) < 0.5
    assert means[3] > 1.6 * means[2]
