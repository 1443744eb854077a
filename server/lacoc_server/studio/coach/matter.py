"""Finds which numbers of a table matter, by small changes of each number up and down."""

from collections.abc import Sequence
from typing import NamedTuple

from lacoc_server.studio.coach.search import Score
from lacoc_server.studio.coach.table import Angles

STEP_DEG = 10
"""How far each number is changed, if its joint's range allows it [deg]."""


class Matter(NamedTuple):
    """How a change of one number changes the score."""

    number: int
    """Index of the number in the table."""
    up: float
    """Change of the score when the number is `STEP_DEG` larger, or at the end of its range."""
    down: float
    """Change of the score when the number is `STEP_DEG` smaller, or at the end of its range."""

    @property
    def size(self) -> float:
        """The larger of `up` and `down`, both without sign; the numbers are ranked by this."""
        return max(abs(self.up), abs(self.down))


def what_matters(
    table: Angles, ranges_deg: Sequence[tuple[float, float]], score: Score
) -> list[Matter]:
    """Rank the numbers of a table by how much a small change of each alters the score.

    Args:
        table: the angles [deg].
        ranges_deg: lowest and highest angle of each number.
        score: returns the scores of tables.

    Returns:
        All numbers, those that matter most first.
    """
    tables = [table]
    for index in range(len(table)):
        low, high = ranges_deg[index]
        for step in (STEP_DEG, -STEP_DEG):
            turned = round(min(max(table[index] + step, low), high))
            tables.append((*table[:index], turned, *table[index + 1 :]))
    now, *scores = score(tables)
    found = [
        Matter(index, scores[2 * index] - now, scores[2 * index + 1] - now)
        for index in range(len(table))
    ]
    return sorted(found, key=lambda one: -one.size)
