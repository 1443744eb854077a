"""Repairs mistakes of a table before the search: tries in physics which repairs help."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from lacoc_server.studio.coach.goal import goal_score
from lacoc_server.studio.coach.table import Angles, KeyTable
from lacoc_server.studio.coach.trials import Trials
from lacoc_server.trial.figures import Figures
from lacoc_server.trial.reasons.form import KeyForm
from lacoc_server.trial.reasons.likely import weigh_repairs
from lacoc_shared.studio import CellPlace
from lacoc_shared.words import Phrase

MOST_REPAIRS = 3
_TRIED, _EXACT = 12, 4
"""In a round, this many of the most probable repairs are tried roughly. Then this many of them are
tried exactly: the most probable one and the best others."""
REPAIR_TRIALS = 1 + _TRIED + _EXACT
"""Number of trials of a round: the table itself, rough ones and exact ones."""
_LEAST, _LEAST_SHARE = 3.0, 0.05
"""A repair must raise the score by this many points, and by this share of the score."""
_AS_GOOD = 0.95
"""Of the repairs with at least this share of the best score, the most probable is taken."""


class Repaired(NamedTuple):
    """A repair that helped."""

    said: Phrase
    """The sentence that names the mistake; its code is `explain.*`."""
    cell: CellPlace
    """A cell with a wrong number, as an example of the mistake."""
    angles_deg: Angles
    """The table after the repair."""
    before: Figures
    after: Figures


def repair(trials: Trials) -> Iterator[Repaired]:
    """Repair mistakes of a table, at most `MOST_REPAIRS`, while this raises the score; yield each.

    Args:
        trials: tries tables for the task.

    Raises:
        Stopped: if the search was stopped.
        WorkerDied: if a process for trials ended.
    """
    task = trials.task
    angles = task.table.angles_deg
    now: Figures | None = None
    for _ in range(MOST_REPAIRS):
        sequence = task.table.sequence(angles)
        form = KeyForm.of(task.robot, sequence, task.goal, task.key)
        found: dict[Angles, tuple[Phrase, CellPlace]] = {}
        for weighed in weigh_repairs(form):
            table = _angles(task.table, weighed.repair.form)
            if table is not None and table != angles:
                found.setdefault(table, (weighed.repair.said, form.place(weighed.repair.cell)))
        tables = list(found)[:_TRIED]
        if not tables:
            return
        if now is None:
            (now,) = trials.walks([angles])
        close = _best(tables, trials.rough(tables))
        walks = trials.walks(close)
        scores = [goal_score(one, task.goal) for one in walks]
        own = goal_score(now, task.goal)
        if max(scores) < own + max(_LEAST, _LEAST_SHARE * abs(own)):
            return
        least = max(scores) - (1 - _AS_GOOD) * abs(max(scores))
        index = next(index for index, score in enumerate(scores) if score >= least)
        angles = close[index]
        yield Repaired(*found[angles], angles, now, walks[index])
        now = walks[index]


def _best(tables: list[Angles], scores: list[float]) -> list[Angles]:
    """Choose tables to try with the contest's physics: the first, most probable one, and the best.

    They keep their order.
    """
    ranked = sorted(range(1, len(tables)), key=lambda index: -scores[index])
    return [tables[index] for index in sorted([0, *ranked[: _EXACT - 1]])]


def _angles(table: KeyTable, form: KeyForm) -> Angles | None:
    """Return the angles of a table's rows [whole deg].

    Return None if the key uses a row twice, and the repair gives its uses different angles.
    """
    postures = np.round(form.angles_deg).astype(int).reshape(form.postures, -1)
    rows: dict[int, tuple[int, ...]] = {}
    for row, posture in zip(table.order, postures, strict=True):
        angles = tuple(map(int, posture))
        if rows.setdefault(row, angles) != angles:
            return None
    return tuple(angle for row in range(len(table.rows)) for angle in rows[row])
