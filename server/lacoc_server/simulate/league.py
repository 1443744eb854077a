"""Who meets whom when many players meet, and where everybody stands."""

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

import msgspec


class Played(NamedTuple):
    """A match that has ended."""

    players: tuple[str, ...]
    """Names of the players, by seat."""
    scores: tuple[int, ...]
    """Points of the players, by seat."""
    winner: int | None
    """Index of the winner's seat; None: a draw."""


class Standing(msgspec.Struct, frozen=True, kw_only=True):
    """Where a player stands after some matches."""

    name: str
    won: int
    drawn: int
    lost: int
    points: int
    """Points of the player in all these matches."""


def pairings(players: int, rounds: int) -> list[tuple[int, int]]:
    """Pair players in rounds by the circle method: in a round each plays once.

    With an odd number of players one rests in each round, always another one. When everybody has
    met everybody, the rounds come again in reverse order with seats swapped. So after any number of
    rounds, each player's matches in the two seats differ by at most one in number.

    Args:
        players: number of players.
        rounds: number of rounds.

    Returns:
        The matches in their order: the player of the left seat and of the right one, by number from
        0.
    """
    return [pair for number in range(rounds) for pair in _round(players, number)]


def _round(players: int, number: int) -> Iterator[tuple[int, int]]:
    """Yield the matches of a round.

    All players but the last of an even number sit on a circle. In each round another one of them is
    the pivot: players at the same distance from the pivot meet, and the pivot meets the last
    player, or rests. A player's distance from the pivot changes by one in each round, so whoever
    sits left at odd distances and right at even ones changes the seat each time. The pivot takes
    the seat that keeps its own matches even: left in even rounds.
    """
    circle = players - 1 + players % 2  # odd; after so many rounds everybody has met everybody
    lap, pivot = divmod(number, circle)
    if lap % 2:
        pivot = circle - 1 - pivot
    for distance in range(1, circle // 2 + 1):
        after, before = (pivot + distance) % circle, (pivot - distance) % circle
        yield (after, before) if (distance + lap) % 2 else (before, after)
    if circle < players:
        yield (pivot, circle) if (pivot + lap) % 2 == 0 else (circle, pivot)


def standings(players: Sequence[str], matches: Iterable[Played]) -> list[Standing]:
    """Count who won, drew and lost.

    Args:
        players: names of the players; those who are equal stay in this order.
        matches: matches that have ended; void ones do not belong to them.

    Returns:
        The best player first: the one with most matches won, then fewest lost, then most points.
    """
    won, drawn, lost, points = (dict.fromkeys(players, 0) for _ in range(4))
    for match in matches:
        for seat, (name, score) in enumerate(zip(match.players, match.scores, strict=True)):
            count = drawn if match.winner is None else won if match.winner == seat else lost
            count[name] += 1
            points[name] += score
    table = [
        Standing(name=name, won=won[name], drawn=drawn[name], lost=lost[name], points=points[name])
        for name in won
    ]
    return sorted(table, key=lambda one: (-one.won, one.lost, -one.points))
