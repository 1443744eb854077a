"""Tests of the circle method: everybody plays equally often, on both sides."""

from collections import Counter
from itertools import combinations

from hypothesis import given
from hypothesis import strategies as st

from lacoc_server.contest.league.formats.round_robin import circle_round

PLAYERS = st.integers(2, 33)
ROUNDS = st.integers(1, 80)


def pairings(players: int, rounds: int) -> list[tuple[int, int]]:
    return [pair for number in range(rounds) for pair in circle_round(players, number)]


@given(PLAYERS, ROUNDS)
def test_everybody_plays_equally_often(players: int, rounds: int) -> None:
    """Everybody plays once a round; of an odd number, nobody rests twice more than another."""
    matches = pairings(players, rounds)
    played = Counter(player for pair in matches for player in pair)
    assert len(matches) == rounds * (players // 2)
    counts = [played[player] for player in range(players)]
    assert max(counts) - min(counts) <= players % 2
    for number in range(rounds):
        at = slice(number * (players // 2), (number + 1) * (players // 2))
        assert max(Counter(player for pair in matches[at] for player in pair).values()) == 1


@given(PLAYERS, ROUNDS)
def test_nobody_meets_the_same_again_while_others_are_left(players: int, rounds: int) -> None:
    """Two players meet again only after everybody has met everybody."""
    met = Counter(frozenset(pair) for pair in pairings(players, rounds))
    counts = [met[frozenset(pair)] for pair in combinations(range(players), 2)]
    assert max(counts) - min(counts) <= 1
    assert sum(counts) == sum(met.values())


@given(PLAYERS, ROUNDS)
def test_sides_are_even(players: int, rounds: int) -> None:
    """Each player's matches in the left seat and in the right one differ by at most one."""
    matches = pairings(players, rounds)
    side = Counter(left for left, _ in matches)
    side.subtract(right for _, right in matches)
    assert max(map(abs, side.values())) <= 1


@given(PLAYERS, ROUNDS)
def test_pairs_that_meet_twice_swap_seats(players: int, rounds: int) -> None:
    """Of two players who meet again, each sits in both seats, as evenly as possible."""
    seated = Counter(pairings(players, rounds))
    assert all(abs(seated[a, b] - seated[b, a]) <= 1 for a, b in seated)


@given(PLAYERS, ROUNDS)
def test_more_rounds_only_add_matches(players: int, rounds: int) -> None:
    """Pairings are the same each time; further rounds come after the earlier ones."""
    assert pairings(players, rounds + 1)[: rounds * (players // 2)] == pairings(players, rounds)
