"""Measures the coach: how fast and how well it ranks numbers, and how much faster robots become.

python -m benchmarks.coach matters            # rank the sample's numbers: time, Kendall's tau
python -m benchmarks.coach beginners --tables 50 --size table
python -m benchmarks.coach sample             # from the sample, for both values of `advance`
python -m benchmarks.coach map                # the sample's map of gaits
python -m benchmarks.coach variants           # six variants of the sample, and six bred from two

A beginner's table is the sample with smaller swings, other lifts, and an error in every number.
Half of these tables also have a fault (tests/played/faulty_tables.py). Only tables with which the
robot walks forward are used: beginners ask the coach about a gait that already works.
"""

import argparse
import json
import math
import os
import random
import sys
import threading
import time
from collections.abc import Iterator, Sequence
from itertools import combinations
from statistics import median
from typing import Any

import msgspec
from arguments import arguments
from faulty_tables import FAULTS, WHOLE, sequence_of
from sample_walks import entry_of

from benchmarks.figures import finish
from lacoc_robots.robot import RobotSpec
from lacoc_server.simulate.workers import Workers
from lacoc_server.studio.coach.coach import CoachFound, coach, task_of
from lacoc_server.studio.coach.improve import Size
from lacoc_server.studio.coach.matter import Matter, what_matters
from lacoc_server.studio.coach.trials import Task, Trials, try_table
from lacoc_server.studio.styles.archive import arousal_mm_s, is_sound
from lacoc_server.studio.styles.gait_map import map_gaits
from lacoc_server.studio.styles.variants import VARIANTS, vary
from lacoc_server.trial.reasons.goal import Goal
from lacoc_shared.gait.tables import Gait, LocomotionTable, Posture

_ROBOT, _KEY = "hexapod", 2
_NOISE_DEG = 8
_LEAST_MM_S = 10.0
"""A beginner's table is used only if the robot walks at least this fast."""
_HOLD_US = 200_000
_AIMS = {"matters_s": 10.0, "tau": 0.8, "table": 2.0, "three": 1.3, "reached": 85.0, "time": 180.0}


def main() -> None:
    """Measure, print, and exit with 1 if an aim is missed."""
    ways = ("matters", "beginners", "sample", "map", "variants")
    options = arguments(__doc__, ways, tables=50, size=Size.TABLE, seconds=30.0)
    with Workers() as workers:
        match options.what:
            case "matters":
                found, right = _matters(workers)
            case "sample":
                found, right = _sample(workers, options.seconds)
            case "map":
                found, right = _map(workers, options.seconds)
            case "variants":
                found, right = _variants(workers)
            case _:
                found, right = _beginners(workers, options)
    found["processor_s"] = round(sum(os.times()[:4]), 1)  # also of the processes, which have ended
    finish(found, right)


def _matters(workers: Workers) -> tuple[dict[str, Any], bool]:
    """Rank the sample's numbers as the coach does; compare with the order by longer trials.

    Returns:
        The figures; whether both aims, for the time and for the order, are met.
    """
    entry = entry_of(_ROBOT)
    task = task_of(entry.robot, entry.gait, _KEY, Goal.FORWARD, None)
    trials = Trials(task, workers, threading.Event())
    begin_s = time.perf_counter()
    ranked = coach(trials, None, 0.0, 0, lambda _: None).matters
    took_s = time.perf_counter() - begin_s
    own = task.table.angles_deg
    ranges_deg = entry.robot.ranges_deg * len(task.table.rows)
    full = what_matters(own, ranges_deg, trials.exact)
    tau = kendalls_tau(_sizes(ranked), _sizes(full))
    found = {"matters_s": round(took_s, 2), "tau": round(tau, 3), "numbers": len(own)}
    return found, took_s <= _AIMS["matters_s"] and tau >= _AIMS["tau"]


def _sample(workers: Workers, seconds: float) -> tuple[dict[str, Any], bool]:
    """Search from the sample's own table, with each way to advance to the next posture.

    Returns:
        The figures for each way; whether every gait found is fast enough and keeps the robot up.
    """
    entry = entry_of(_ROBOT)
    ways: dict[str, RobotSpec] = {
        "reached": entry.robot,
        "time": msgspec.structs.replace(entry.robot, advance="time", hold_us=_HOLD_US),
    }
    found: dict[str, Any] = {}
    right = True
    for way, robot in ways.items():
        best = _searched(workers, robot, entry.gait, Size.TABLE, seconds)
        found[way] = _told(best)
        stands = best.after.upright > 0.9 and best.after.belly_share < 0.005
        right &= stands and best.after.speed_mm_s >= _AIMS[way]
    return found, right


def _map(workers: Workers, seconds: float) -> tuple[dict[str, Any], bool]:
    """Search for gaits of all speeds and arousals (how excited a gait looks) from the sample.

    Returns:
        The figures; whether all gaits that were found are sound.
    """
    mapped = map_gaits(_sample_trials(workers), seconds, 0, lambda _: None)
    grid, elites = mapped.archive.grid, mapped.archive.elites.values()
    speeds = [one.figures.speed_mm_s for one in elites]
    arousals = [arousal_mm_s(one.figures) or 0.0 for one in elites]
    found = {
        "filled": len(elites),
        "cells": grid.speeds * grid.arousals,
        "speed_mm_s": [round(min(speeds), 1), round(max(speeds), 1)],
        "arousal_mm_s": [round(min(arousals), 1), round(max(arousals), 1)],
        "trials": mapped.trials,
    }
    return found, all(is_sound(one.figures) for one in elites)


def _variants(workers: Workers) -> tuple[dict[str, Any], bool]:
    """Look for six variants of the sample, and for six more that are bred from the first two.

    Returns:
        The figures of both rounds; whether each round found six variants, all of them sound.
    """
    trials = _sample_trials(workers)
    own = trials.task.table.angles_deg
    keep, before, rounds = [own], [own], []
    right = True
    for index in range(2):
        begin_s = time.perf_counter()
        variants = vary(trials, keep, before, 0, index, lambda _: None).variants
        rounds.append(
            {
                "took_s": round(time.perf_counter() - begin_s, 2),
                "variants": len(variants),
                "upright": round(min(one.figures.upright for one in variants), 3),
                "speed_mm_s": [round(one.figures.speed_mm_s, 1) for one in variants],
            }
        )
        right &= len(variants) == VARIANTS and all(is_sound(one.figures) for one in variants)
        keep = [one.angles_deg for one in variants[:2]]
        before += [one.angles_deg for one in variants]
    return {"rounds": rounds}, right


def _sample_trials(workers: Workers) -> Trials:
    entry = entry_of(_ROBOT)
    task = task_of(entry.robot, entry.gait, _KEY, Goal.FORWARD, None)
    trials = Trials(task, workers, threading.Event())
    trials.figures(
        [task.table.angles_deg] * 2 * workers.count
    )  # so that each process has built its floor
    return trials


def _beginners(workers: Workers, options: argparse.Namespace) -> tuple[dict[str, Any], bool]:
    """Search for a better table from each of many beginners' tables.

    Returns:
        The figures; whether the median gain of speed reaches the aim.
    """
    robot = entry_of(_ROBOT).robot
    ratios, searched_s = [], []
    for _, gait in zip(range(options.tables), beginners(robot), strict=False):
        begin_s = time.perf_counter()
        best = _searched(workers, robot, gait, options.size, options.seconds)
        searched_s.append(time.perf_counter() - begin_s)
        ratios.append(best.after.speed_mm_s / best.before.speed_mm_s)
        print(json.dumps(_told(best)), file=sys.stderr, flush=True)
    found = {
        "tables": len(ratios),
        "ratio": round(median(ratios), 2),
        "worst": round(min(ratios), 2),
        "seconds": round(median(searched_s), 1),
    }
    return found, median(ratios) >= _AIMS.get(options.size, 1.0)


def beginners(robot: RobotSpec) -> Iterator[Gait]:
    """Yield beginners' gaits without end."""
    entry = entry_of(_ROBOT)
    assert entry.gait.locomotion is not None
    stand, sample = (entry.gait.locomotion.sequences[key] for key in (0, _KEY))
    seed = 0
    while True:
        seed += 1
        sequence = _beginners_sequence(robot, sample, random.Random(seed))
        gait = Gait(None, LocomotionTable((stand, stand, sequence)))
        task = task_of(robot, gait, _KEY, Goal.FORWARD, None)
        figures = try_table(task, task.table.angles_deg)
        if figures.speed_mm_s >= _LEAST_MM_S and figures.belly_share < 0.02:
            yield gait


def kendalls_tau(one: Sequence[float], other: Sequence[float]) -> float:
    """Return how similar two orders are: 1 for the same order, -1 for the reverse (tau-b)."""
    same = ties_one = ties_other = 0
    pairs = [*combinations(range(len(one)), 2)]
    for a, b in pairs:
        first, second = one[a] - one[b], other[a] - other[b]
        ties_one += first == 0
        ties_other += second == 0
        same += (first * second > 0) - (first * second < 0)
    return same / math.sqrt((len(pairs) - ties_one) * (len(pairs) - ties_other))


def _beginners_sequence(
    robot: RobotSpec, sample: Sequence[Posture], rng: random.Random
) -> tuple[Posture, ...]:
    legs = len(robot.legs)
    swing, lift = rng.uniform(0.4, 0.9), rng.uniform(0.6, 1.2)
    table = [
        [
            math.degrees(angle) * (swing if joint < legs else lift)
            + rng.randint(-_NOISE_DEG, _NOISE_DEG)
            for joint, angle in enumerate(posture)
        ]
        for posture in sample
    ]
    if rng.random() < 0.5:
        name = rng.choice(sorted(FAULTS.keys() - WHOLE))
        FAULTS[name][1](table, rng.randrange(legs), robot, rng)
    return sequence_of(table, robot)


def _searched(
    workers: Workers, robot: RobotSpec, gait: Gait, size: Size, seconds: float
) -> CoachFound:
    task: Task = task_of(robot, gait, _KEY, Goal.FORWARD, None)
    return coach(Trials(task, workers, threading.Event()), size, seconds, 0, lambda _: None)


def _told(found: CoachFound) -> dict[str, float]:
    return {
        "before_mm_s": round(found.before.speed_mm_s, 1),
        "after_mm_s": round(found.after.speed_mm_s, 1),
        "upright": round(found.after.upright, 3),
        "belly_share": round(found.after.belly_share, 3),
        "trials": found.trials,
    }


def _sizes(matters: Sequence[Matter]) -> list[float]:
    """List how much each number of a table matters, in the order of the table."""
    return [one.size for one in sorted(matters, key=lambda one: one.number)]


if __name__ == "__main__":
    main()
