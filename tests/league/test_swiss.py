"""Tests of Swiss pairings: legal, the same as py4swiss makes, and with the fewest faults."""

import itertools
from collections.abc import Iterator, Sequence
from random import Random

import networkx
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lacoc_server.contest.league.formats.swiss import (
    LARGEST,
    SwissTeam,
    dutch,
    faults,
    fewest_faults,
    paired,
    seat_pair,
)


def rounds(
    random: Random, teams: int, number: int, leaving: float = 0.0
) -> Iterator[list[SwissTeam]]:
    """Yield the players before each round; `random` decides the results and which teams leave."""
    players = [SwissTeam(team=f"t{place}", number=place) for place in range(1, teams + 1)]
    for round_number in range(1, number + 1):
        yield players
        before = {player.number: player.points for player in players}
        for pair in paired(players, round_number):
            play(random, pair, before)
        players = [player for player in players if random.random() >= leaving]
        if len(players) < 2:
            return


def play(random: Random, pair: Sequence[SwissTeam], before: dict[int, int]) -> None:
    """Add a random result to both players."""
    if len(pair) == 1:
        pair[0].had_bye = True
        pair[0].points += 2
        pair[0].floats.append("down")
        return
    left = seat_pair(pair[0], pair[1])[0]
    points = random.choice([0, 1, 2])
    for player, other, won in ((*pair, points), (pair[1], pair[0], 2 - points)):
        apart = before[player.number] - before[other.number]
        player.floats.append("down" if apart > 0 else "up" if apart < 0 else "none")
        player.points += won
        player.met.add(other.team)
        player.sides.append(1 if player.team == left else -1)


def as_numbers(pairs: Sequence[Sequence[SwissTeam]]) -> set[frozenset[int]]:
    return {frozenset(player.number for player in pair) for pair in pairs}


def total_faults(pairs: Sequence[Sequence[SwissTeam]]) -> tuple[int, ...]:
    return tuple(map(sum, zip(*map(faults, pairs), strict=True)))


def can_do_without_faults(players: Sequence[SwissTeam]) -> bool:
    """Return whether all players can be paired without faults; a matching in a graph tells this."""
    graph = networkx.Graph()
    graph.add_nodes_from(range(len(players)))
    for (one, first), (two, second) in itertools.combinations(enumerate(players), 2):
        if not any(faults((first, second))):
            graph.add_edge(one, two)
    if len(players) % 2:
        graph.add_edges_from(("bye", at) for at, one in enumerate(players) if not one.had_bye)
    return 2 * len(networkx.max_weight_matching(graph, True)) == len(players) + len(players) % 2


def check_round(players: Sequence[SwissTeam], round_number: int) -> None:
    """Check that everybody is paired once, without a fault if that is possible."""
    pairs = paired(players, round_number)
    assert sorted(one.number for pair in pairs for one in pair) == [one.number for one in players]
    assert sum(len(pair) == 1 for pair in pairs) == len(players) % 2
    found = total_faults(pairs)
    if any(found):
        assert not can_do_without_faults(players)
        assert found == total_faults(fewest_faults(players))


@settings(max_examples=25, deadline=None)
@given(
    teams=st.integers(2, 24),
    number=st.integers(1, 8),
    leaving=st.sampled_from([0.0, 0.05]),
    seed=st.integers(0, 2**32),
)
def test_every_round_is_legal(teams: int, number: int, leaving: float, seed: int) -> None:
    """Each round pairs every player once, and has faults only if they can't be avoided.

    Faults are to meet twice, a second bye, and two more matches on one side than on the other.
    """
    for round_number, players in enumerate(rounds(Random(seed), teams, number, leaving), 1):
        check_round(players, round_number)


def test_a_round_that_needs_a_fault_is_paired_at_once() -> None:
    """A round that can't avoid a fault is paired at once, and with only one fault.

    Two of 24 teams have gone: 12 teams must sit right but only 10 left, so one pair must break a
    rule. The engine alone would try pairings for minutes.
    """
    players = [
        SwissTeam(
            team=f"t{number}", number=number, sides=[1 if number <= 12 else -1], floats=["none"]
        )
        for number in range(1, 23)
    ]
    for player in players[:11]:
        player.points = 2
    pairs = paired(players, 2)
    assert sorted(one.number for pair in pairs for one in pair) == [*range(1, 23)]
    assert total_faults(pairs) == (0, 0, 1)


@settings(max_examples=8, deadline=None)
@given(teams=st.integers(4, 16).map(lambda half: 2 * half), seed=st.integers(0, 2**32))
def test_sides_differ_by_at_most_one(teams: int, seed: int) -> None:
    """In n/4 + 1 rounds of n teams, each team's matches on the two sides differ by at most one.

    Pairs for this always exist if n is even and all teams play (Hall's theorem).
    """
    for players in rounds(Random(seed), teams, teams // 4 + 2):
        assert all(abs(player.balance) <= 1 for player in players)
        assert all(len(player.met) == len(player.sides) for player in players)


@pytest.mark.parametrize("teams", [LARGEST + 1, pytest.param(200, marks=pytest.mark.long)])
def test_large_stages(teams: int) -> None:
    """A stage that is too large for the engine is paired without faults by our own matching."""
    for players in rounds(Random(teams), teams, 5):
        pairs = fewest_faults(players)
        assert total_faults(pairs) == (0, 0, 0)
        assert all(abs(player.balance) <= 1 for player in players)


def brute_force(players: Sequence[SwissTeam]) -> tuple[int, ...]:
    """Return the faults of the best of all possible pairings.

    Returns:
        The number of pairs that met before, of second byes, and of pairs in which both teams are
        due the same side.
    """

    def pairings(left: tuple[SwissTeam, ...]) -> Iterator[tuple[tuple[SwissTeam, ...], ...]]:
        if len(left) < 2:
            yield (left,) if left else ()
            return
        for at in range(1, len(left)):
            for rest in pairings((*left[1:at], *left[at + 1 :])):
                yield ((left[0], left[at]), *rest)
        if len(left) % 2:
            for rest in pairings(left[1:]):
                yield ((left[0],), *rest)

    return min(total_faults(one) for one in pairings(tuple(players)))


@settings(max_examples=15, deadline=None)
@given(teams=st.integers(2, 7), seed=st.integers(0, 2**32))
def test_fewest_faults(teams: int, seed: int) -> None:
    """`fewest_faults` is as good as the best of all pairings, even if all teams have met."""
    for players in rounds(Random(seed), teams, 10):
        assert total_faults(fewest_faults(players)) == brute_force(players)


@pytest.mark.parametrize(
    "least_rounds", [20, pytest.param(150, marks=pytest.mark.long)], ids=["some", "many"]
)
def test_py4swiss_makes_the_same_pairs(least_rounds: int) -> None:
    """py4swiss finds the same pairs in random rounds.

    Rounds are not compared if they need faults, or if the older rules of py4swiss matter.
    """
    pytest.importorskip("py4swiss", reason="there is no wheel of py4swiss for this machine")
    import second_swiss

    compared = 0
    for seed in itertools.count():
        random = Random(seed)
        for number, players in enumerate(rounds(random, random.randint(6, 24), 6), 1):
            theirs = second_swiss.pairs(players, number) if can_do_without_faults(players) else None
            if theirs is None:
                continue
            found = as_numbers(dutch(players, number))
            if not same_bye(players, found, theirs):
                continue
            assert found == theirs, (seed, number)
            compared += 1
        if compared >= least_rounds:
            return


def same_bye(
    players: Sequence[SwissTeam], found: set[frozenset[int]], theirs: set[frozenset[int]]
) -> bool:
    """Return whether both engines give the bye to the same team, or both give none.

    If they choose two teams, check that the one chosen by our engine has fewer points. The rules
    have required the fewest points since February 2026; py4swiss has older rules.
    """
    points = {player.number: player.points for player in players}
    ours, others = ({*pair} for pair in (alone(found), alone(theirs)))
    assert ours == others or points[min(ours)] < points[min(others)]
    return ours == others


def alone(pairs: set[frozenset[int]]) -> frozenset[int]:
    """Return a set with the team that has a bye, or an empty set if there is no bye."""
    return next((pair for pair in pairs if len(pair) == 1), frozenset())
