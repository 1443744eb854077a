"""Which numbers of a table matter: each is changed a little, up and down."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

from lacoc_server.studio.coach.table import Angles

STEP_DEG = 10
"""How far each number is changed [deg]."""
CONFIRMED = 12
"""How many of the numbers that matter most are tried again, with the steps of the contest."""

Score = Callable[[Sequence[Angles]], list[float]]
"""Tries tables and returns how good each is."""


class Matter(NamedTuple):
    """What a change of one number does."""

    number: int
    """Index of the number in the table."""
    up: float
    """Change of the score when the number is `STEP_DEG` larger."""
    down: float
    """Change of the score when it is smaller."""

    @property
    def size(self) -> float:
        """The larger of both changes: the order in which numbers matter."""
        return max(abs(self.up), abs(self.down))


def what_matters(
    table: Angles, ranges_deg: Sequence[tuple[float, float]], quick: Score, exact: Score
) -> list[Matter]:
    """Rank the numbers of a table by what a change of each does.

    Args:
        table: the angles [deg].
        ranges_deg: lowest and highest angle of each number.
        quick: a score that is cheap, to find the order.
        exact: the score of the contest, for the numbers at the top.

    Returns:
        All numbers, those that matter most first.
    """
    ranked = _changes(table, range(len(table)), ranges_deg, quick)
    top = [found.number for found in ranked[:CONFIRMED]]
    confirmed = _changes(table, top, ranges_deg, exact)
    return [*confirmed, *ranked[CONFIRMED:]]


def _changes(
    table: Angles, cells: Sequence[int], ranges_deg: Sequence[tuple[float, float]], score: Score
) -> list[Matter]:
    tables = [table]
    for index in cells:
        low, high = ranges_deg[index]
        for step in (STEP_DEG, -STEP_DEG):
            turned = round(min(max(table[index] + step, low), high))
            tables.append((*table[:index], turned, *table[index + 1 :]))
    now, *scores = score(tables)
    found = [
        Matter(index, scores[2 * place] - now, scores[2 * place + 1] - now)
        for place, index in enumerate(cells)
    ]
    return sorted(found, key=lambda one: -one.size)
