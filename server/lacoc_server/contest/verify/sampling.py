"""Chooses games by chance, and says how likely a check of only these finds a forged one; pure."""

import math
from collections.abc import Sequence
from random import Random
from typing import TypeVar

T = TypeVar("T")

CONFIDENCE = 0.95
"""Probability with which a sample has a forged game, if `least_forged` or more are forged."""


def sample(games: Sequence[T], number: int, seed: int) -> list[T]:
    """Choose games by chance; the same seed chooses the same games of the same list."""
    return Random(seed).sample(games, min(number, len(games)))


def missed(games: int, forged: int, checked: int) -> float:
    """Return the probability that a sample of games has no forged one.

    Args:
        games: number of all games.
        forged: how many of them are forged.
        checked: how many are chosen, each choice as likely as any other.
    """
    return math.comb(games - forged, checked) / math.comb(games, checked)


def least_forged(games: int, checked: int) -> int:
    """Return how many games must be forged at least, so that a sample most likely has one of them.

    "Most likely" means with probability `CONFIDENCE` or more. If no number is enough, because no
    game is checked, return one more than the number of games. Arguments are as in `missed`.
    """
    enough = (n for n in range(1, games + 1) if missed(games, n, checked) <= 1 - CONFIDENCE)
    return next(enough, games + 1)
