"""A check of some games, chosen by chance, and what it is worth; pure."""

import math
from collections.abc import Sequence
from random import Random
from typing import TypeVar

T = TypeVar("T")

CONFIDENCE = 0.95
"""Probability with which a sample finds what `least_forged` promises."""


def sample(games: Sequence[T], number: int, seed: int) -> list[T]:
    """Choose games by chance; the same seed chooses the same games of the same list."""
    return Random(seed).sample(games, min(number, len(games)))


def missed(games: int, forged: int, checked: int) -> float:
    """Return the probability that a sample has none of the forged games.

    Args:
        games: number of all games.
        forged: how many of them are forged.
        checked: how many are chosen, each choice as likely as any other.
    """
    return math.comb(games - forged, checked) / math.comb(games, checked)


def least_forged(games: int, checked: int) -> int:
    """Return the least number of forged games of which a sample most likely has one.

    Most likely: with probability `CONFIDENCE` or more. With fewer forged games it is less likely.
    If nothing is checked, no number is enough; the result is then one more than the number of
    games. Arguments are as in `missed`.
    """
    enough = (n for n in range(1, games + 1) if missed(games, n, checked) <= 1 - CONFIDENCE)
    return next(enough, games + 1)
