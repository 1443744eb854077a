"""Tests of the circle method of a round robin: all play equally often, on both sides."""

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
    """No player has two matches in a round, and in total all have equally many.

    If the number of players is odd, their numbers of matches differ by at most one.
    """
    matches = pairings(players, rounds)
    played = Counter(player for pair in matches for player in pair)
    assert len(matches) == rounds * (players // 2)
    counts = [played[player] for player in range(players)]
    assert max(counts) - min(counts) <= players % 2
    for number in range(rounds):
        at = slice(number * (players // 2), (number + 1) * (players // 2))
        assert max(Counter(player for pair in matches[at] for player in pair).values()) == 1


def test_nobody_plays_alone() -> None:
    """Fewer than two players have no match, in any round."""
    assert pairings(0, 3) == pairings(1, 3) == []


@given(PLAYERS, ROUNDS)
def test_all_players_meet_before_any_meet_again(players: int, rounds: int) -> None:
    """All pairs of players meet equally often, or some pairs meet once more than the others."""
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
    """When two players meet several times, their numbers of left seats differ by at most one."""
    seated = Counter(pairings(players, rounds))
    assert all(abs(seated[a, b] - seated[b, a]) <= 1 for a, b in seated)


@given(PLAYERS, ROUNDS)
def test_more_rounds_only_add_matches(players: int, rounds: int) -> None:
    """With one more round, the matches of the earlier rounds stay the same."""
    assert pairings(players, rounds + 1)[: rounds * (players // 2)] == pairings(players, rounds)
