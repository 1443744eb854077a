"""Breeds six gaits that differ visibly, from one table or from the two that a student has kept."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from lacoc_server.studio.coach.coach import Tell
from lacoc_server.studio.coach.table import Angles
from lacoc_server.studio.coach.trials import Stopped, Trials
from lacoc_server.studio.styles.archive import is_sound
from lacoc_server.studio.styles.style import WAYS, Styles, far_apart
from lacoc_server.trial.figures import Figures
from lacoc_server.trial.walk import Floats
from lacoc_shared.studio import Progress

VARIANTS = 6
_DRAWN, _TRIED, _ROUNDS = 80, 16, 4
"""Number of tables that a round draws, number of these (the most different) that it tries, and most
rounds."""
_ENOUGH, _LEAST = 10, 8
"""Most tables of a round that are tried exactly, and number of good gaits that are enough."""
_FAR, _NEAR = 2.0, 1.0
"""Largest change of a table in each `Way` [steps], at a student's first request for variants and
after many requests."""
_CALMER = 0.85
"""Factor of the steps from one round of trials to the next: with smaller changes, more robots stay
upright."""
_WALKS = 0.25
"""A variant goes forward with at least this part of its slower parent's speed."""
_SIDE = 0.5
"""A variant goes sideways with at most this part of its speed forward."""
_PERIOD, _SPEED = 1.25, 1.35
"""A period this many times longer, or a speed this many times higher, counts as one step."""


class Variant(NamedTuple):
    """One of up to six gaits from which a student can choose."""

    angles_deg: Angles
    figures: Figures


class Varied(NamedTuple):
    """The result of a student's request for gaits to choose from."""

    variants: list[Variant]
    """The six that differ most; fewer if the search was stopped or too few walked."""
    trials: int
    stopped: bool


def vary(
    trials: Trials,
    parents: Sequence[Angles],
    before: Sequence[Angles],
    seed: int,
    round_: int,
    tell: Tell,
) -> Varied:
    """Breed six gaits from the parents that differ visibly and walk upright.

    Args:
        trials: tries tables for the task.
        parents: one or two tables.
        before: tables that were shown before; variants differ from them.
        seed: seed of all random numbers.
        round_: number of earlier requests of the student; later ones change tables less.
        tell: called with the progress of the search.

    Raises:
        WorkerDied: if a process for trials ended.
    """
    task = trials.task
    styles = Styles(task.robot, task.table)
    rng = np.random.default_rng([seed, round_])
    known = [styles.look(table) for table in dict.fromkeys((*parents, *before))]
    seen = {*parents, *before}
    found: list[Variant] = []
    expected = len(parents) + _TRIED + _ENOUGH

    def on_done() -> None:
        done = min(1.0, trials.count / expected)
        tell(Progress(stage="variants", done=done, trials=trials.count, filled=len(found)))

    trials.on_done = on_done
    stopped = False
    try:
        slowest = min(one.speed_mm_s for one in trials.walks(parents))
        least_mm_s = min(slowest, _WALKS * slowest)
        steps = max(_NEAR, _FAR * 0.8**round_)
        for _ in range(_ROUNDS):
            drawn = [_child(styles, parents, steps, rng) for _ in range(_DRAWN)]
            drawn = [table for table in dict.fromkeys(drawn) if table not in seen]
            seen.update(drawn)
            looks = [styles.look(table) for table in drawn]
            taken = [*known, *(styles.look(one.angles_deg) for one in found)]
            tables = [drawn[index] for index in far_apart(looks, _TRIED, taken)]
            for rough in (True, False):
                walks = zip(tables, trials.walks(tables, rough=rough), strict=True)
                good = [
                    Variant(table, figures)
                    for table, figures in walks
                    if _walks(figures, least_mm_s)
                ]
                tables = [one.angles_deg for one in good][:_ENOUGH]
            found += good
            if len(found) >= _LEAST:
                break
            steps *= _CALMER
    except Stopped:
        stopped = True
    trials.on_done = lambda: None
    chosen = far_apart([_appearance(styles, one) for one in found], VARIANTS)
    return Varied([found[index] for index in chosen], trials.count, stopped)


def _child(
    styles: Styles, parents: Sequence[Angles], steps: float, rng: np.random.Generator
) -> Angles:
    """Mix the parents, and change the resulting table in one to three ways (`Way`)."""
    table = parents[0]
    if len(parents) > 1:
        table = styles.between(table, parents[1], float(rng.uniform(-0.25, 1.25)))
    turns = np.zeros(len(WAYS))
    some = rng.permutation(len(WAYS))[: int(rng.integers(1, 4))]
    turns[some] = rng.choice([-1.0, 1.0], len(some)) * rng.uniform(0.5, 1.0, len(some)) * steps
    return styles.turned(table, turns)


def _walks(figures: Figures, least_mm_s: float) -> bool:
    """Return whether a robot walks upright, fast enough and mostly forward."""
    forward_mm_s = figures.speed_mm_s
    if not is_sound(figures) or forward_mm_s < least_mm_s:
        return False
    return abs(figures.lateral_mm_s) <= max(5.0, _SIDE * forward_mm_s)


def _appearance(styles: Styles, variant: Variant) -> Floats:
    """Return how a gait looks when a robot walks with it, as a vector.

    The vector has the numbers of `Styles.look`, then the period and the speed, all in steps.
    """
    figures = variant.figures
    period = np.log(figures.cycle_s or 1.0) / np.log(_PERIOD)
    speed = np.log(max(5.0, figures.speed_mm_s)) / np.log(_SPEED)
    return np.array([*styles.look(variant.angles_deg), period, speed])
