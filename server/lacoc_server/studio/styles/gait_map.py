"""Fills a map of gaits (a grid with the best gait of each cell), from a student's own table."""

import time
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from lacoc_server.studio.coach.coach import Tell
from lacoc_server.studio.coach.table import Angles
from lacoc_server.studio.coach.trials import Stopped, Trials
from lacoc_server.studio.styles.archive import Archive, grid_of
from lacoc_server.studio.styles.style import WAYS, Styles
from lacoc_server.trial.figures import Figures
from lacoc_shared.studio import Progress

_ROUND = 16
"""Tables that are tried roughly at the same time."""
_STEPS = 1.4
"""Standard deviation of the change of a new table in each way (`Way`) [steps]."""
_MIXED, _ALL_WAYS = 0.35, 0.25
"""Share of the new tables that begin as a mix of two others, and share that is changed in all ways
(`Way`); the rest is changed in one to three ways."""
_NOISY, _CELLS, _NOISE_DEG = 0.4, 0.3, 8.0
"""Share of the tables in which single angles change as well, the share of those angles, and the
standard deviation of their changes [deg]."""
_FULL = 0.3
"""A cell's weight in the choice of a parent is this plus the number of empty cells beside it."""
_HOPEFULS = 6
"""Most tables of a round that are tried exactly, those for empty cells first."""


class Mapped(NamedTuple):
    """The map of gaits at the end of a search; some of its cells may be empty."""

    archive: Archive
    own: Figures
    trials: int
    stopped: bool


def map_gaits(trials: Trials, seconds: float, seed: int, tell: Tell) -> Mapped:
    """Fill a map of gaits: search for gaits of all speeds, from calm to excited ones.

    Args:
        trials: tries tables for the task.
        seconds: how long to search [s].
        seed: seed of all random numbers.
        tell: called with the progress of the search.

    Raises:
        WorkerDied: if a process for trials ended.
    """
    task = trials.task
    own = task.table.angles_deg
    (figures,) = trials.figures([own])
    archive = Archive(own, grid_of(task.robot, figures))
    begin_s = time.monotonic()

    def passed_s() -> float:
        return time.monotonic() - begin_s

    trials.on_done = lambda: tell(
        Progress(
            stage="map",
            done=min(1.0, passed_s() / max(seconds, 1e-9)),
            trials=trials.count,
            filled=len(archive.elites),
        )
    )
    archive.add(own, figures)
    stopped = False
    try:
        for _ in fill(archive, Styles(task.robot, task.table), own, trials, seed):
            if passed_s() >= seconds:
                break
    except Stopped:
        stopped = True
    trials.on_done = lambda: None
    return Mapped(archive, figures, trials.count, stopped)


def fill(
    archive: Archive, styles: Styles, own: Angles, trials: Trials, seed: int
) -> Iterator[None]:
    """Fill a map of gaits, one round of trials after another, without an end; yield after each.

    A rough trial finds the tables that may be better than those in the map. Only these are tried
    exactly, and only an exact trial puts a table into the map.
    """
    rng = np.random.default_rng(seed)
    seen = {own}
    while True:
        tables: list[Angles] = []
        for _ in range(4 * _ROUND):  # a table that the joints keep from moving gives no new ones
            table = _offspring(archive, styles, own, rng)
            if table not in seen:
                seen.add(table)
                tables.append(table)
            if len(tables) == _ROUND:
                break
        rough = trials.walks(tables, rough=True)
        new_first = sorted(
            (archive.grid.place(figures) in archive.elites, index)
            for index, figures in enumerate(rough)
            if archive.would_take(tables[index], figures)
        )
        hopeful = [tables[index] for _, index in new_first[:_HOPEFULS]]
        for table, figures in zip(hopeful, trials.walks(hopeful), strict=True):
            archive.add(table, figures)
        yield


def _offspring(archive: Archive, styles: Styles, own: Angles, rng: np.random.Generator) -> Angles:
    """Make a new table from one or two tables of a map of gaits; from `own` while it is empty."""
    parents = [elite.angles_deg for elite in archive.elites.values()] or [own]
    weights = np.array([archive.empty_beside(place) + _FULL for place in archive.elites] or [1.0])

    def parent() -> Angles:
        return parents[int(rng.choice(len(parents), p=weights / weights.sum()))]

    table = parent()
    if rng.random() < _MIXED:
        table = styles.between(table, parent(), float(rng.uniform(-0.3, 1.3)))
    steps = rng.normal(0.0, _STEPS, len(WAYS))
    if rng.random() >= _ALL_WAYS:
        keeps = rng.permutation(len(WAYS))[int(rng.integers(1, 4)) :]
        steps[keeps] = 0.0
    table = styles.turned(table, steps)
    if rng.random() < _NOISY:
        noise_deg = rng.normal(0.0, _NOISE_DEG, len(table)) * (rng.random(len(table)) < _CELLS)
        table = styles.within(np.array(table) + noise_deg)
    return table
