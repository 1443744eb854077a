"""Finds which feet are down, and when in a cycle they come down.

A foot that touches the floor lightly loses and finds it many times a second. So there are two
bounds for its load: the foot comes down above the higher bound, and is up below the lower one.
"""

import math
from collections.abc import Sequence

import numpy as np

from lacoc_server.trial.walk import Bools, Floats

DOWN_SHARE, UP_SHARE = 0.02, 0.01
"""Shares of the robot's weight: a foot comes down when its load rises above the first, and is up
again when its load falls below the second.
"""


def feet_down(load_n: Floats, weight_n: float) -> Bools:
    """Find the feet that are down.

    Args:
        load_n: (ticks, legs) mean normal force of each tick [N].
        weight_n: weight of the robot [N].

    Returns:
        (ticks, legs) whether the foot is down; before the first tick all feet are up.
    """
    down = np.zeros(load_n.shape, np.bool_)
    now = np.zeros(load_n.shape[1], np.bool_)
    for tick, load in enumerate(load_n):
        now = np.where(now, load >= UP_SHARE * weight_n, load > DOWN_SHARE * weight_n)
        down[tick] = now
    return down


def duty(down: Bools) -> list[float]:
    """Return each foot's duty factor: the share of ticks in which it is down."""
    return [float(share) for share in down.mean(axis=0)] if len(down) else [0.0] * down.shape[1]


def phases(down: Bools, first: int, cycles: Sequence[tuple[int, int]]) -> list[float | None]:
    """Return when in a cycle each foot comes down, as a part of the cycle from 0 to 1.

    Args:
        down: (ticks, legs) whether the foot is down.
        first: feet that come down before this tick do not count.
        cycles: for each cycle its first tick, and the tick after its last.

    Returns:
        For each foot the mean over all cycles, on a circle: the mean of 0.98 and 0.02 is 0. None
        for a foot that never comes down in these cycles.
    """
    found: list[float | None] = []
    for leg in range(down.shape[1]):
        touchdowns = [
            (tick - begin) / (end - begin)
            for begin, end in cycles
            for tick in range(max(begin, first, 1), end)
            if down[tick, leg] and not down[tick - 1, leg]
        ]
        found.append(mean_phase(touchdowns, [1.0] * len(touchdowns)) if touchdowns else None)
    return found


def mean_phase(phases: Sequence[float], weights: Sequence[float]) -> float:
    """Return the weighted mean of phases from 0 to 1, on a circle."""
    turns = [2 * math.pi * phase for phase in phases]
    up = sum(weight * math.sin(turn) for turn, weight in zip(turns, weights, strict=True))
    along = sum(weight * math.cos(turn) for turn, weight in zip(turns, weights, strict=True))
    return math.atan2(up, along) / (2 * math.pi) % 1.0


def changes_hz(down: Bools, seconds: float) -> list[float]:
    """Return how often each foot comes down or goes up [1/s]."""
    changes = (down[1:] != down[:-1]).sum(axis=0)
    return [float(count) / seconds if seconds else 0.0 for count in changes]
