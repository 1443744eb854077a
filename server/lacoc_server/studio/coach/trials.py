"""Run many trials in several processes; each process keeps the course that its robot walks on."""

import os
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import lru_cache
from multiprocessing import get_context
from typing import NamedTuple, Self

from lacoc_robots.robot import RobotSpec
from lacoc_server.studio.coach.goal import Goal, score
from lacoc_server.studio.coach.table import Angles, KeyTable
from lacoc_server.trial.course import SETTLE_TICKS, Course
from lacoc_server.trial.figures import Figures, measure
from lacoc_server.trial.walk import Press
from lacoc_server.world.sensed import make_course
from lacoc_server.world.world import SUBSTEPS
from lacoc_shared.gait.tables import Gait, Level, LocomotionTable, Posture

_QUICK_STEPS, _QUICK_CYCLES = 4, 2
"""A quick trial has physics steps of 5 ms and measures two cycles of the sequence."""
_CYCLES = 3


class Task(NamedTuple):
    """What is the same in all trials of a search."""

    robot: RobotSpec
    stand: tuple[Posture, ...]
    """Sequence of key 0, in which the robot stands before it walks."""
    table: KeyTable
    """Table of the key that the search changes."""
    goal: Goal


class Trials:
    """Tries tables in processes; used as a context manager.

    Args:
        task: what is the same in all trials.
        jobs: number of processes; None: one for each core.
    """

    def __init__(self, task: Task, jobs: int | None = None) -> None:
        self._task = task
        self._jobs = jobs or os.cpu_count() or 1
        self._pool = ProcessPoolExecutor(self._jobs, mp_context=get_context("spawn"))
        self.count = 0
        """Number of trials so far."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self._pool.shutdown(cancel_futures=True)

    def exact(self, tables: Sequence[Angles]) -> list[float]:
        """Score tables with the physics of the contest."""
        return self._score(tables, SUBSTEPS, _CYCLES)

    def quick(self, tables: Sequence[Angles]) -> list[float]:
        """Score tables with longer physics steps and fewer cycles: good enough to rank them."""
        return self._score(tables, _QUICK_STEPS, _QUICK_CYCLES)

    def _score(self, tables: Sequence[Angles], steps: int, cycles: int) -> list[float]:
        self.count += len(tables)
        size = max(1, -(-len(tables) // (4 * self._jobs)))
        jobs = [
            self._pool.submit(_scores, self._task, tables[first : first + size], steps, cycles)
            for first in range(0, len(tables), size)
        ]
        return [found for job in jobs for found in job.result()]


def try_table(
    task: Task, angles_deg: Angles, steps: int = SUBSTEPS, cycles: int = _CYCLES
) -> Figures:
    """Let the robot walk with a table, in this process, and return the figures of its walk."""
    tables = (task.stand, task.table.sequence(angles_deg))
    press = Press(SETTLE_TICKS, Level.LOCOMOTION, 1)
    course = _course(task.robot, steps)
    return measure(course.walk(Gait(None, LocomotionTable(tables)), [press], cycles=cycles))


def _scores(task: Task, tables: Sequence[Angles], steps: int, cycles: int) -> list[float]:
    return [score(try_table(task, table, steps, cycles), task.goal) for table in tables]


@lru_cache(maxsize=4)
def _course(robot: RobotSpec, steps: int) -> Course:
    return make_course(robot, steps)
