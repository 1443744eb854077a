"""Find which numbers of a table matter: each number is changed a little, up and down."""

from collections.abc import Sequence
from typing import NamedTuple

from lacoc_server.studio.coach.search import Score
from lacoc_server.studio.coach.table import Angles

STEP_DEG = 10
"""How far each number is changed [deg]."""
CONFIRMED = 12
"""How many of the numbers that matter most are tried again, with the contest's physics."""


class Matter(NamedTuple):
    """How a change of one number changes the score."""

    number: int
    """Index of the number in the table."""
    up: float
    """Change of the score when the number is `STEP_DEG` larger."""
    down: float
    """Change of the score when the number is `STEP_DEG` smaller."""

    @property
    def size(self) -> float:
        """The larger of both changes without its sign; numbers are ranked by it."""
        return max(abs(self.up), abs(self.down))


def what_matters(
    table: Angles, ranges_deg: Sequence[tuple[float, float]], quick: Score, exact: Score
) -> list[Matter]:
    """Rank the numbers of a table by how much a small change of each alters the score.

    Args:
        table: the angles [deg].
        ranges_deg: lowest and highest angle of each number.
        quick: returns rough scores; they rank all numbers.
        exact: returns scores with the contest's physics; they rank the first `CONFIRMED` again.

    Returns:
        All numbers, those that matter most first.
    """
    ranked = changes_of(table, range(len(table)), ranges_deg, quick)
    top = [found.number for found in ranked[:CONFIRMED]]
    confirmed = changes_of(table, top, ranges_deg, exact)
    return [*confirmed, *ranked[CONFIRMED:]]


def changes_of(
    table: Angles, cells: Sequence[int], ranges_deg: Sequence[tuple[float, float]], score: Score
) -> list[Matter]:
    """Find what changes of some cells do to a score; the cells that matter most come first."""
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
