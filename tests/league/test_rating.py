"""Tests of ratings: intervals contain the true strengths, in any order of the games."""

import math
from random import Random

import msgspec
import pytest

from lacoc_server.contest.league.rating import Rated, ratings

SIDE_ELO = 60.0


def league(random: Random, teams: int, times: int) -> tuple[dict[str, float], list[Rated]]:
    """Draw true strengths, and from them games of every team against every other on both sides."""
    true = {f"t{number:02d}": random.gauss(0, 150) for number in range(teams)}
    games = []
    for left in true:
        for right in true:
            if left != right:
                games += [_game(random, left, right, true) for _ in range(times)]
    return true, games


def _game(random: Random, left: str, right: str, true: dict[str, float]) -> Rated:
    apart = (true[left] - true[right] + SIDE_ELO) * math.log(10) / 400
    wins, loses, draws = math.exp(apart / 2), math.exp(-apart / 2), 0.5
    (winner,) = random.choices([left, right, ""], [wins, loses, draws])
    return Rated(left, right, winner)


def coverage(leagues: int, teams: int, times: int) -> float:
    """Return the share of intervals that contain the true strength of their team."""
    inside = []
    for seed in range(leagues):
        true, games = league(Random(seed), teams, times)
        mean = sum(true.values()) / len(true)
        inside += [
            abs(one.elo - (true[one.team] - mean)) <= one.interval_elo
            for one in ratings(games).teams
        ]
    return sum(inside) / len(inside)


@pytest.mark.parametrize("shuffles", [5, pytest.param(30, marks=pytest.mark.long)])
def test_order_does_not_matter(shuffles: int) -> None:
    """The same games in another order give the same ratings, byte for byte."""
    random = Random(3)
    _, games = league(random, 10, 1)
    expected = msgspec.json.encode(ratings(games))

    for _ in range(shuffles):
        random.shuffle(games)
        assert msgspec.json.encode(ratings(games)) == expected


def test_intervals() -> None:
    """About 95 % (91-99 %) of the intervals contain the true strength."""
    assert 0.91 <= coverage(leagues=25, teams=12, times=1) <= 0.99


@pytest.mark.long
def test_intervals_of_200_leagues() -> None:
    """93-97 % of the intervals of 200 leagues contain the true strength."""
    assert 0.93 <= coverage(leagues=200, teams=12, times=1) <= 0.97


@pytest.mark.long
def test_side_bias() -> None:
    """The advantage of the left side is found within 15 Elo, as the mean of four leagues.

    In a single league of 1,140 games it scatters by about 15 Elo.
    """
    found = []
    for seed in range(4):
        _, games = league(Random(seed), 20, 3)
        assert len(games) == 1140
        found.append(ratings(games).side_elo)
    assert abs(sum(found) / len(found) - SIDE_ELO) <= 15


@pytest.mark.parametrize(
    "games",
    [
        [],
        [Rated("a", "b", "a")],
        [Rated("a", "b", "")] * 3,
        [Rated("a", "b", "a")] * 50,
        [Rated("a", "b", "a"), Rated("c", "d", "")],
    ],
)
def test_few_games(games: list[Rated]) -> None:
    """Ratings are finite for few games, for draws alone, and for teams that no game links."""
    found = ratings(games)
    assert {one.team for one in found.teams} == {team for game in games for team in game[:2]}
    assert all(math.isfinite(one.elo) and one.interval_elo > 0 for one in found.teams)
    assert math.isfinite(found.side_elo)
