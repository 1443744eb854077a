"""Ratings of teams on the Elo scale, with intervals and the advantage of the left side."""

import math
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import msgspec
from whr import WHR

_ELO = 400 / math.log(10)
"""Elo points of one natural unit, which is a factor e in the odds to win."""
_SIDE = "left"
_Z95 = 1.959963984540054
_PRECISION = 1e-3
"""The fit ends when the largest gradient is below this, in natural units."""
_BATCH, _MOST_BATCHES = 50, 20
"""How many Newton steps are made between two checks of the gradient, and how many such batches at
most."""


class Rated(NamedTuple):
    """A game that counts for ratings."""

    left: str
    right: str
    winner: str
    """The team that won; "": a draw."""


class Rating(msgspec.Struct, frozen=True, kw_only=True):
    """How strong a team is."""

    team: str
    elo: float
    """Strength of the team in Elo points; the mean of all teams is 0."""
    interval_elo: float
    """Half the width of the 95 % confidence interval, in Elo points."""
    games: int


class Ratings(msgspec.Struct, frozen=True, kw_only=True):
    """Ratings of all teams that have played."""

    teams: tuple[Rating, ...]
    """A rating for each team, the strongest first."""
    side_elo: float
    """Advantage of the left seat, in Elo points."""


def ratings(games: Iterable[Rated]) -> Ratings:
    """Fit a Bradley-Terry model with draws (Davidson) and an advantage of the left side.

    It is the whole-history rating (Coulom 2008) of a single day: all games weigh the same,
    whenever they were played. The games are sorted first, so their order does not matter.
    """
    played = sorted(games)
    model = WHR(_draws(played))
    for game in played:
        result = "B" if game.winner == game.left else "W" if game.winner == game.right else "D"
        model.create_game(game.left, game.right, result, 1, _SIDE)
    if not played:
        return Ratings(teams=(), side_elo=0.0)
    for _ in range(_MOST_BATCHES):
        model.iterate(_BATCH)
        if model.max_gradient_norm() < _PRECISION:
            break
    days = {name: player.days[-1] for name, player in model.players.items()}
    mean = sum(days[name].elo for name in sorted(days)) / len(days)
    teams = [
        Rating(
            team=name,
            elo=round(day.elo - mean, 1),
            interval_elo=round(_Z95 * _ELO * math.sqrt(day.uncertainty), 1),
            games=sum(name in (game.left, game.right) for game in played),
        )
        for name, day in days.items()
    ]
    return Ratings(
        teams=tuple(sorted(teams, key=lambda one: (-one.elo, one.team))),
        side_elo=round(_ELO * math.log(model.handicap_gamma[_SIDE]), 1),
    )


def _draws(games: Sequence[Rated]) -> dict[str, float]:
    """Return arguments for the model, for contests in which no game or every game was drawn.

    If no game was drawn, the model takes draws as impossible. If all were, it expects half of all
    games to be drawn. Otherwise it fits how often draws happen.
    """
    if all(game.winner for game in games):
        return {"pinned_draw": 0.0}
    return {} if any(game.winner for game in games) else {"draw_rate": 0.5}
