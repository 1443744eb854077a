"""Runs many trials of one robot in several processes at the same time."""

import threading
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from concurrent.futures import TimeoutError as NotDone
from typing import NamedTuple

from lacoc_robots.robot import RobotSpec
from lacoc_server.simulate.workers import Workers
from lacoc_server.studio.coach.goal import goal_score
from lacoc_server.studio.coach.harm import harm
from lacoc_server.studio.coach.table import Angles, KeyTable
from lacoc_server.studio.floors import course_of
from lacoc_server.trial.course import SETTLE_TICKS
from lacoc_server.trial.figures import Figures, measure
from lacoc_server.trial.reasons.goal import Goal
from lacoc_server.trial.walk import Press
from lacoc_server.world.world import SUBSTEPS
from lacoc_shared.gait.tables import Gait, Level, LocomotionTable, Posture

_CYCLES, _QUICK_CYCLES = 3, 2
"""Cycles of the sequence that a trial and a quick trial measure."""
_ROUGH_STEPS, _ROUGH_CYCLES = 4, 1
"""A rough trial has physics steps of 5 ms and measures one cycle."""
_MOST_AT_ONCE = 4
"""Most trials in one job: small jobs take more time in all, large ones delay a stop."""
_LOOK_S = 0.05


class _Exactness(NamedTuple):
    """How exactly a table is tried."""

    steps: int
    """Physics steps of a tick."""
    cycles: int


_EXACT_WAY = _Exactness(SUBSTEPS, _CYCLES)
_QUICK_WAY = _Exactness(SUBSTEPS, _QUICK_CYCLES)
_ROUGH_WAY = _Exactness(_ROUGH_STEPS, _ROUGH_CYCLES)


class Stopped(Exception):
    """Somebody stopped the search."""


class Task(NamedTuple):
    """The robot, the table and the goal, which are the same in all trials of a search."""

    robot: RobotSpec
    stand: tuple[Posture, ...]
    """Sequence of key 0, in which the robot stands before it walks."""
    table: KeyTable
    """Table of the key that the search changes."""
    goal: Goal
    key: int
    """Digit of the key of `table`, to name its cells."""


class Trials:
    """Lets the robot walk with tables, in other processes, and scores its walks.

    Args:
        task: the robot, the table and the goal.
        workers: the processes.
        stop: the search ends with `Stopped` as soon as this is set.
    """

    def __init__(self, task: Task, workers: Workers, stop: threading.Event) -> None:
        self.task = task
        self.on_done: Callable[[], None] = lambda: None
        """Called many times a second while tables are tried."""
        self.count = 0
        """Number of trials so far."""
        self._spared: dict[_Exactness, Figures] = {}
        self._everything = False
        self._workers = workers
        self._stop = stop

    def exact(self, tables: Sequence[Angles]) -> list[float]:
        """Score tables with the physics of the contest.

        Raises:
            Stopped: if the search was stopped.
            WorkerDied: if a process for trials ended.
        """
        return self._scores(tables, _EXACT_WAY)

    def quick(self, tables: Sequence[Angles]) -> list[float]:
        """Score tables as `exact` does, but over fewer cycles; this is enough for a ranking.

        Raises:
            Stopped: if the search was stopped.
            WorkerDied: if a process for trials ended.
        """
        return self._scores(tables, _QUICK_WAY)

    def rough(self, tables: Sequence[Angles]) -> list[float]:
        """Score tables with larger steps of physics than a contest's, to find which may be better.

        Raises:
            Stopped: if the search was stopped.
            WorkerDied: if a process for trials ended.
        """
        return self._scores(tables, _ROUGH_WAY)

    def walks(self, tables: Sequence[Angles], *, rough: bool = False) -> list[Figures]:
        """Let the robot walk with each table; return the figures.

        The contest's physics is used; if `rough`, larger steps of physics.

        Raises:
            Stopped: if the search was stopped.
            WorkerDied: if a process for trials ended.
        """
        return self._walks(tables, _ROUGH_WAY if rough else _EXACT_WAY)

    def spare(self, table: Angles, *, everything: bool) -> None:
        """From now on lower the score of tables with which a figure is worse than with this one.

        Args:
            table: the table whose figures are compared.
            everything: as in `harm`.

        Raises:
            Stopped: if the search was stopped.
            WorkerDied: if a process for trials ended.
        """
        for way in (_EXACT_WAY, _ROUGH_WAY):
            (self._spared[way],) = self._walks([table], way)
        self._everything = everything

    def figures(self, tables: Sequence[Angles]) -> list[Figures]:
        """Let the robot walk with each table, also after a stop of the search; return the figures.

        These trials are not counted.

        Raises:
            WorkerDied: if a process for trials ended.
        """
        jobs = [self._workers.submit(_figures, self.task, [table], *_EXACT_WAY) for table in tables]
        return [found for job in jobs for found in job.result()]

    def _scores(self, tables: Sequence[Angles], way: _Exactness) -> list[float]:
        goal = self.task.goal
        walks = self._walks(tables, way)
        scores = [goal_score(figures, goal) for figures in walks]
        spared = self._spared.get(way)
        if spared is None:
            return scores
        most = goal_score(spared, goal)
        harms = [harm(spared, figures, goal, everything=self._everything) for figures in walks]
        return [
            min(score, most) - cost if cost else score
            for score, cost in zip(scores, harms, strict=True)
        ]

    def _walks(self, tables: Sequence[Angles], way: _Exactness) -> list[Figures]:
        size = min(_MOST_AT_ONCE, max(1, len(tables) // (4 * self._workers.count)))
        parts = [tables[first : first + size] for first in range(0, len(tables), size)]
        jobs = [self._workers.submit(_figures, self.task, part, *way) for part in parts]
        try:
            return [found for job in jobs for found in self._result(job)]
        finally:
            for job in jobs:
                job.cancel()

    def _result(self, job: "Future[list[Figures]]") -> list[Figures]:
        while True:
            if self._stop.is_set():
                raise Stopped
            try:
                found = job.result(_LOOK_S)
            except NotDone:
                self.on_done()
                continue
            self.count += len(found)
            self.on_done()
            return found


def try_table(
    task: Task, angles_deg: Angles, steps: int = SUBSTEPS, cycles: int = _CYCLES
) -> Figures:
    """Let the robot walk with a table, in this process, and return the figures of its walk."""
    tables = (task.stand, task.table.sequence(angles_deg))
    press = Press(SETTLE_TICKS, Level.LOCOMOTION, 1)
    course = course_of(task.robot, steps)
    return measure(course.walk(Gait(None, LocomotionTable(tables)), [press], cycles=cycles))


def _figures(task: Task, tables: Sequence[Angles], steps: int, cycles: int) -> list[Figures]:
    return [try_table(task, table, steps, cycles) for table in tables]
