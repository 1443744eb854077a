"""Who meets whom when many players meet, and where everybody stands."""

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import msgspec

from lacoc_server.league.formats.round_robin import circle_round
from lacoc_server.league.standings import Counted
from lacoc_server.league.standings import standings as league_standings

_ORDER = ("wins", "fewest-lost", "scored", "seed")


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
    return [pair for number in range(rounds) for pair in circle_round(players, number)]


def standings(players: Sequence[str], matches: Iterable[Played]) -> list[Standing]:
    """Count who won, drew and lost.

    Args:
        players: names of the players; those who are equal stay in this order.
        matches: matches that have ended; void ones do not belong to them.

    Returns:
        The best player first: the one with most matches won, then fewest lost, then most points.
    """
    counted = [Counted(match.players, match.scores, match.winner) for match in matches]
    table = league_standings([*dict.fromkeys(players)], counted, _ORDER)
    return [
        Standing(name=row.team, won=row.won, drawn=row.drawn, lost=row.lost, points=row.scored)
        for row in table.rows
    ]
