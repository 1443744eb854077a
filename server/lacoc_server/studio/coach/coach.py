"""Runs a search of the coach for a better table, and reports its progress.

It ranks the numbers of the table, searches, and undoes changes that hardly help.
"""

import time
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

from lacoc_robots.robot import RobotSpec
from lacoc_server.studio.coach.goal import goal_score, goal_value
from lacoc_server.studio.coach.harm import worse
from lacoc_server.studio.coach.improve import Size, improve
from lacoc_server.studio.coach.matter import Matter, what_matters
from lacoc_server.studio.coach.repair import REPAIR_TRIALS, Repaired, repair
from lacoc_server.studio.coach.search import Improved, Search
from lacoc_server.studio.coach.table import Angles, KeyTable, differing
from lacoc_server.studio.coach.trials import Stopped, Task, Trials
from lacoc_server.studio.coach.undo import undo
from lacoc_server.trial.figures import Figures
from lacoc_server.trial.keys import forward_key
from lacoc_server.trial.reasons.goal import Goal
from lacoc_shared.gait.tables import Gait, Level
from lacoc_shared.mistakes import UserError
from lacoc_shared.studio import CellChange, CellPlace, CoachReply, Progress, RepairTold, Weight
from lacoc_shared.words import say

_UNDO_TRIALS = 50
"""Typical number of trials to undo changes; the progress of this stage is estimated from it."""
_TURNS = {Goal.LEFT: 1, Goal.RIGHT: 3}
"""The sample's keys for turning (workshop Fig. 4-2)."""

Tell = Callable[[Progress], None]
"""Called with the progress of a search, many times a second."""


class CoachFound(NamedTuple):
    """Result of a search of the coach."""

    repairs: list[Repaired]
    """Mistakes that were repaired before the search, in this order."""
    matters: list[Matter]
    """All numbers of the key, those that matter most first; empty if they were not ranked."""
    best: Improved | None
    """The best table; None: nothing was repaired or searched."""
    before: Figures
    """Figures of the student's own gait."""
    after: Figures
    """Figures of the best gait; equal to `before` if `best` is None."""
    trials: int
    stopped: bool


def coached_key(gait: Gait, goal: Goal, key: int | None = None) -> int:
    """Choose the key of level B whose table the coach shall improve.

    Args:
        gait: the robot's gait.
        goal: what the key is for.
        key: digit of the key. None: choose it by the goal. To turn, it is the sample's key for
            that direction; to go forward, the key that `trial.keys.forward_key` chooses.

    Raises:
        UserError: if the gait has no such key at level B.
    """
    if key is None:
        level, found = forward_key(gait)
        key = _TURNS.get(goal, found if level is Level.LOCOMOTION else 0)
    if gait.sequence(Level.LOCOMOTION, key) is None:
        there = [f"B{one}" for one in gait.keys(Level.LOCOMOTION)]
        missing = say("trial.no-key", key=f"B{key}", keys=there)
        raise UserError(missing if there else say("coach.no-keys"))
    return key


def task_of(
    robot: RobotSpec, gait: Gait, key: int, goal: Goal, sequences: Sequence[Sequence[int]] | None
) -> Task:
    """Make the coach's task: to improve the table of a key of level B.

    Args:
        robot: the robot.
        gait: the robot's gait, which has the key.
        key: digit of the key.
        goal: what the key is for.
        sequences: for each key the postures that it runs through, by their digits in the Loco-data
            file; None if the gait has a LocoTra-data file, which has the angles itself.
    """
    stand = gait.sequence(Level.LOCOMOTION, 0) or (robot.start_posture,)
    digits = None if sequences is None else sequences[key]
    table = KeyTable.of(gait.sequence(Level.LOCOMOTION, key) or (), digits)
    return Task(robot, stand, table, goal, key)


def coach(trials: Trials, size: Size | None, seconds: float, seed: int, tell: Tell) -> CoachFound:
    """Repair a table; if nothing needs repair, rank its numbers and search for a better table.

    If a table was repaired, the search goes on only with the size "table". With a smaller size, the
    student first sees the repair, and can ask again.

    Args:
        trials: tries tables for the task.
        size: how many numbers may change; None: only rank the numbers, without repairs and search.
        seconds: how long to repair and to search [s]; repairs are not cut short. The ranking before
            the search and the undoing after it do not count.
        seed: seed of all random numbers.
        tell: called with the progress of the search.

    Raises:
        WorkerDied: if a process for trials ended.
    """
    task = trials.task
    own = task.table.angles_deg
    ranges_deg = task.robot.ranges_deg * len(task.table.rows)
    repairs: list[Repaired] = []
    matters: list[Matter] = []
    best: Improved | None = None
    stopped = False
    begin_s = time.monotonic()
    try:
        if size is not None:
            _follow(trials, tell, "repair", 2 * REPAIR_TRIALS)
            for one in repair(trials):
                repairs.append(one)
                best = Improved(one.angles_deg, goal_score(one.after, task.goal))
        seconds -= time.monotonic() - begin_s
        if best is None or size is Size.TABLE:
            start = own if best is None else best.angles_deg
            _follow(trials, tell, "matters", 1 + 2 * len(own))
            matters = what_matters(start, ranges_deg, trials.quick)
            if size is not None:
                trials.spare(start, everything=size is not Size.TABLE)
                for better in _better(
                    trials, start, ranges_deg, matters, size, seconds, seed, tell
                ):
                    best = better
    except Stopped:
        stopped = True
    trials.on_done = lambda: None
    tables = [own] if best is None else [own, best.angles_deg]
    figures = trials.figures(tables)
    return CoachFound(repairs, matters, best, figures[0], figures[-1], trials.count, stopped)


def reply_of(task: Task, key: int, found: CoachFound) -> CoachReply:
    """Make the message that tells what the coach found."""
    own = task.table.angles_deg
    best = own if found.best is None else found.best.angles_deg
    return CoachReply(
        key=key,
        matters=tuple(
            Weight(cell=cell_place(task.table, one.number), up=one.up, down=one.down)
            for one in found.matters
        ),
        changes=cell_changes(task.table, own, best),
        before=vars(found.before),
        after=vars(found.after),
        repairs=tuple(
            RepairTold(
                said=one.said,
                cell=one.cell,
                before=goal_value(one.before, task.goal),
                after=goal_value(one.after, task.goal),
            )
            for one in found.repairs
        ),
        worse=worse(found.before, found.after, task.goal),
        score_before=goal_score(found.before, task.goal),
        score_after=goal_score(found.after, task.goal),
        trials=found.trials,
        cancelled=found.stopped,
    )


def cell_changes(table: KeyTable, before: Angles, after: Angles) -> tuple[CellChange, ...]:
    """List the numbers that differ between two versions of a table."""
    return tuple(
        CellChange(cell=cell_place(table, index), from_deg=before[index], to_deg=after[index])
        for index in differing(before, after)
    )


def cell_place(table: KeyTable, index: int) -> CellPlace:
    """Return the place of a number in the key's sequence, in the first posture that has it."""
    row, joint = table.cell(index)
    return CellPlace(posture=table.order.index(row), joint=joint)


def _better(
    trials: Trials,
    start: Angles,
    ranges_deg: tuple[tuple[float, float], ...],
    matters: list[Matter],
    size: Size,
    seconds: float,
    seed: int,
    tell: Tell,
) -> Iterator[Improved]:
    """Search for a better table, then undo changes that hardly help.

    Yield the best table so far after each round of trials.
    """
    begin_s = time.monotonic()

    def passed_s() -> float:
        return time.monotonic() - begin_s

    search = Search(start, ranges_deg, trials.exact)
    trials.on_done = lambda: tell(
        Progress(
            stage="search",
            done=min(1.0, passed_s() / max(seconds, 1e-9)),
            trials=trials.count,
            score=search.best.score,
        )
    )
    yield from improve(search, size, matters, trials.rough, lambda: passed_s() >= seconds, seed)
    _follow(trials, tell, "undo", _UNDO_TRIALS, search.best.score)
    yield from undo(search, matters, trials.rough)


def _follow(
    trials: Trials, tell: Tell, stage: str, expected: int, best: float | None = None
) -> None:
    """From now on report the progress of one stage of a search, by its number of trials.

    Args:
        trials: counts the trials.
        tell: called with the progress.
        stage: name of the stage.
        expected: about how many trials the stage takes.
        best: score of the best table so far.
    """
    begin = trials.count

    def on_done() -> None:
        done = min(1.0, (trials.count - begin) / expected)
        tell(Progress(stage=stage, done=done, trials=trials.count, score=best))

    trials.on_done = on_done
