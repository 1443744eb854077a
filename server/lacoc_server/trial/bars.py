"""Draws bars of text that show when each foot is down (Hildebrand's diagram)."""

from collections.abc import Sequence
from itertools import pairwise

from lacoc_server.trial.walk import Bools

_DOWN, _UP, _MARK = "█", "·", "│"


def foot_bars(
    legs: Sequence[str], down: Bools, starts: Sequence[int], first: int, columns: int
) -> list[str]:
    """Draw a bar for each leg; a column is full if the foot is down in half its ticks or more.

    Args:
        legs: labels of the legs.
        down: (ticks, legs) whether the foot is down.
        starts: ticks in which a cycle begins; the last row marks them.
        first: first tick that is drawn.
        columns: largest width of the bars [characters].

    Returns:
        A row for each leg, and then the row with the marks. No rows if there is no tick to draw.
    """
    ticks = len(down) - first
    if ticks <= 0:
        return []
    columns = min(columns, ticks)
    edges = [first + round(column * ticks / columns) for column in range(columns + 1)]
    wide = max(map(len, legs))
    rows = []
    for leg, label in enumerate(legs):
        shares = [down[a:b, leg].mean() for a, b in pairwise(edges)]
        rows.append(f"{label:>{wide}} " + "".join(_DOWN if s >= 0.5 else _UP for s in shares))
    marks = [_MARK if any(a <= start < b for start in starts) else " " for a, b in pairwise(edges)]
    return [*rows, f"{'':>{wide}} {''.join(marks)}".rstrip()]
