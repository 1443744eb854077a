"""Searches for a better table; a `Size` says how many of its numbers may change.

A rough score, which is cheap, finds tables that may be better. Only these are tried with the exact
score, and only a table with a better exact score becomes the best.
"""

import random
from collections.abc import Callable, Iterator, Sequence
from enum import StrEnum

import numpy as np
from cmaes import CMAwM  # type: ignore[import-untyped]

from lacoc_server.studio.coach.matter import Matter
from lacoc_server.studio.coach.search import Improved, Score, Search
from lacoc_server.studio.coach.table import Angles, differing

_STEPS_DEG = (5, 10, 15, 20, 30)
_SIGMA_DEG = 8.0
"""Standard deviation of the first random changes, when all numbers may change."""
_POPULATION = 16
_FEW = 24
"""The sizes "cell" and "three" try to change only this many numbers: those that matter most."""
_CONFIRMED = 8
"""Number of tables with one more change that are tried exactly: the best by rough score."""
_HOPEFUL = 0.9
"""A table with all numbers changed is tried exactly only if its rough score is above this part of
the best score. If the best score is negative, the rough score may be as far below it."""
_HOPEFULS = 2
"""Most tables with all numbers changed that are tried exactly in a round."""


class Size(StrEnum):
    """How much of a table may change."""

    CELL = "cell"
    """One number may change."""
    THREE = "three"
    """At most three numbers may change."""
    TABLE = "table"
    """All numbers may change."""


IsOver = Callable[[], bool]
"""Returns whether the time for the search is over."""


def improve(
    search: Search,
    size: Size,
    matters: Sequence[Matter],
    rough: Score,
    is_over: IsOver,
    seed: int,
) -> Iterator[Improved]:
    """Search for a better table; yield the best table so far after each round of trials.

    Args:
        search: the search, which has already tried the table that it begins with.
        size: how many numbers may change.
        matters: the numbers of the table, those that matter most first.
        rough: a cheap score, to find tables that may be better.
        is_over: called after each round; returns whether the time is over.
        seed: seed of all random numbers.
    """
    yield search.best
    if size is Size.TABLE:
        yield from _whole(search, rough, is_over, seed)
    else:
        yield from _few(search, matters, rough, 1 if size is Size.CELL else 3, is_over)


def _few(
    search: Search, matters: Sequence[Matter], rough: Score, most: int, is_over: IsOver
) -> Iterator[Improved]:
    """Change one number after another, always the one that helps most; then tune each of them.

    The best table so far is yielded after each round of trials.
    """
    cells = [one.number for one in matters[:_FEW]]
    changed: list[int] = []
    while len(changed) < most:
        before = search.best
        for step in _STEPS_DEG:
            tables = [
                search.turned(before.angles_deg, index, before.angles_deg[index] + sign * step)
                for index in cells
                for sign in (1, -1)
                if index not in changed
            ]
            search.tried([table for _, table in _ranked(tables, rough(tables))[:_CONFIRMED]])
            yield search.best
            if is_over():
                break
        if search.best.angles_deg == before.angles_deg:
            break
        changed += differing(before.angles_deg, search.best.angles_deg)
        if is_over():
            return
    # The numbers to change are chosen. Now find the best whole degree for each.
    for index in changed:
        angles = search.best.angles_deg
        search.tried([search.turned(angles, index, angles[index] + by) for by in range(-4, 5)])
        yield search.best


def _ranked(tables: Sequence[Angles], scores: Sequence[float]) -> list[tuple[float, Angles]]:
    """Return pairs of score and table, the best first."""
    return sorted(zip(scores, tables, strict=True), reverse=True)


def _whole(search: Search, rough: Score, is_over: IsOver, seed: int) -> Iterator[Improved]:
    """Change all numbers with CMA-ES in whole degrees; each run starts at the best table so far."""
    bounds = np.array([(round(low), round(high)) for low, high in search.ranges_deg], float)
    restarts = random.Random(seed)
    while not is_over():
        mean = np.clip(np.array(search.best.angles_deg, float), bounds[:, 0], bounds[:, 1])
        optimizer = CMAwM(
            mean=mean,
            sigma=_SIGMA_DEG,
            bounds=bounds,
            steps=np.ones(len(mean)),
            seed=restarts.randrange(2**31),
            population_size=_POPULATION,
        )
        while not (is_over() or optimizer.should_stop()):
            asked = [optimizer.ask() for _ in range(_POPULATION)]
            tables = [tuple(round(float(angle)) for angle in x) for x, _ in asked]
            scores = rough(tables)
            optimizer.tell([(told, -score) for (_, told), score in zip(asked, scores, strict=True)])
            least = search.best.score - (1 - _HOPEFUL) * abs(search.best.score)
            best = _ranked(tables, scores)[:_HOPEFULS]
            search.tried([table for score, table in best if score > least])
            yield search.best
