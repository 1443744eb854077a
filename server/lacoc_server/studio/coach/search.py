"""Keeps the tables that a search has tried, their scores, and the best table so far."""

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

from lacoc_server.studio.coach.table import Angles

Score = Callable[[Sequence[Angles]], list[float]]
"""Tries tables and returns the score of each; a higher score is better."""


class Improved(NamedTuple):
    """The best table so far, and its score."""

    angles_deg: Angles
    score: float


class Search:
    """The state of a search; it begins by trying its first table.

    Args:
        table: the first table [deg]: the student's own, or what repairs made of it.
        ranges_deg: lowest and highest angle of each number.
        score: tries tables and returns their scores.
    """

    def __init__(
        self, table: Angles, ranges_deg: Sequence[tuple[float, float]], score: Score
    ) -> None:
        self.own = table
        self.ranges_deg = ranges_deg
        self._score = score
        self._known: dict[Angles, float] = {}
        self.best = Improved(table, -math.inf)
        self.tried([table])

    def tried(self, tables: Sequence[Angles]) -> list[float]:
        """Try tables at the same time and return their scores.

        A table whose score is known already is not tried again.
        """
        new = list(dict.fromkeys(one for one in tables if one not in self._known))
        self._known.update(zip(new, self._score(new), strict=True))
        for one in new:
            if self._known[one] > self.best.score:
                self.best = Improved(one, self._known[one])
        return [self._known[one] for one in tables]

    def turned(self, table: Angles, index: int, to_deg: float) -> Angles:
        """Return a table with another whole degree in one cell, limited to the joint's range."""
        low, high = self.ranges_deg[index]
        return (*table[:index], round(min(max(to_deg, low), high)), *table[index + 1 :])
