"""Undoes the changes that hardly help, so that few changes are left and can be understood.

Many changes are undone at a time, those that help least first. This is much quicker than one after
the other, because the trials of a round run at the same time. The first pass guesses which changes
help least, from how much each number mattered before the search. Then few changes are left. The
second pass ranks these by rough trials, in each of which one change is undone.
"""

from collections.abc import Iterator, Sequence
from functools import partial

from lacoc_server.studio.coach.matter import Matter
from lacoc_server.studio.coach.search import Improved, Score, Search
from lacoc_server.studio.coach.table import Angles, differing

_EACH, _ALL = 0.02, 0.2
"""Each undone change may cost at most the first part of the best score. All undone changes together
may cost at most the second part of what the search has gained."""
_AT_ONCE = 8
"""Most tables that are tried in one round; each has a different count of undone changes."""


def undo(search: Search, matters: Sequence[Matter], rough: Score) -> Iterator[Improved]:
    """Undo changes of a search's best table; yield each good table with fewer changes.

    Args:
        search: the search.
        matters: how much each number of the search's first table matters.
        rough: a cheap score, to find the changes that help least.
    """
    best = found = search.best
    (own_score,) = search.tried([search.own])
    each, most = _EACH * abs(best.score), _ALL * (best.score - own_score)
    undone = 0
    for least_first in (partial(_guessed, matters), partial(_tried, rough)):
        order = least_first(search.own, found.angles_deg)
        low, high = 0, len(order)
        while low < high:
            counts = _spread(low, high)
            tables = [_back(search.own, found.angles_deg, order[:count]) for count in counts]
            scores = search.tried(tables)
            fits = [
                (count, Improved(table, score))
                for count, table, score in zip(counts, tables, scores, strict=True)
                if score >= best.score - min(most, each * (undone + count))
            ]
            if fits:
                low, better = fits[-1]
                yield better
            high = min((count for count in counts if count > low), default=low + 1) - 1
        if low:
            found = better
            undone += low


def _guessed(matters: Sequence[Matter], own: Angles, table: Angles) -> list[int]:
    """List the changed numbers; first those whose change probably helps least."""
    size = {one.number: one.size for one in matters}
    numbers = differing(own, table)
    return sorted(numbers, key=lambda number: size[number] * abs(table[number] - own[number]))


def _tried(rough: Score, own: Angles, table: Angles) -> list[int]:
    """List the changed numbers; first those that can be undone with the best rough score."""
    numbers = differing(own, table)
    without = rough([_back(own, table, [number]) for number in numbers])
    return [number for _, number in sorted(zip(without, numbers, strict=True), reverse=True)]


def _back(own: Angles, table: Angles, numbers: Sequence[int]) -> Angles:
    """Return a table with the angles of `own` put back in the cells with these indices."""
    mine = set(numbers)
    return tuple(own[i] if i in mine else angle for i, angle in enumerate(table))


def _spread(low: int, high: int) -> list[int]:
    """Return how many changes each table of a round undoes: counts in equal steps.

    They are above `low` and at most `high`; there are at most `_AT_ONCE`.
    """
    steps = min(_AT_ONCE, high - low)
    return [low + (high - low) * step // steps for step in range(1, steps + 1)]
