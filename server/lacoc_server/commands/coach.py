"""`lacoc coach`: find which numbers of a gait matter, and change few of them for a better walk."""

import time
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.table import Table
from rich.text import Text

from lacoc_robots.robot import RobotSpec
from lacoc_server.commands.trial import GaitFile, RobotName, read_robot_file, read_trial_gait
from lacoc_server.studio.coach.goal import Goal, score
from lacoc_server.studio.coach.improve import Improved, Size, improve
from lacoc_server.studio.coach.matter import STEP_DEG, Matter, what_matters
from lacoc_server.studio.coach.table import Angles, KeyTable
from lacoc_server.studio.coach.trials import Task, Trials, try_table
from lacoc_server.trial.figures import Figures
from lacoc_server.trial.keys import forward_key
from lacoc_shared.command import options, screen
from lacoc_shared.command.keep import save
from lacoc_shared.gait.tables import LEVEL_NAMES, Gait, Level, LocomotionTable
from lacoc_shared.gait.text import write_gait
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import Phrase, render, say

app = typer.Typer()

_SHOWN = 10
"""How many of the numbers that matter are printed."""
_TURNS = {Goal.LEFT: 1, Goal.RIGHT: 3}
"""The sample's keys for turning (workshop Fig. 4-2)."""


@app.command(name="coach")
def coach_command(
    file: GaitFile,
    robot: RobotName = "hexapod",
    size: Annotated[
        Size | None,
        typer.Option(
            help="Search for a better table: change one number (cell), at most three, or the whole "
            "table. Left out, the coach only says which numbers matter."
        ),
    ] = None,
    goal: Annotated[
        Goal, typer.Option("--for", help="What the key is for: it also chooses the key.")
    ] = Goal.FORWARD,
    key: Annotated[
        int | None, typer.Option(help="The key of level B to change.", min=0, max=9)
    ] = None,
    seconds: Annotated[
        float,
        typer.Option(
            metavar="S",
            help="How long the coach searches; then it undoes what hardly helps.",
            min=1.0,
            max=3600.0,
        ),
    ] = 30.0,
    seed: Annotated[int, typer.Option(help="Another number searches in another order.", min=0)] = 0,
    out: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Write the better gait there, as LocoTra-data text."),
    ] = None,
    json: options.Json = False,
) -> None:
    """Say which numbers of a gait matter, and search for a better gait with few changes.

    Each number is turned by 10 degrees up and down, and the robot walks with it, under the
    contest's drive and limits. With --size the coach then searches. A change that hardly helps is
    undone, so what is left can be understood. Ctrl-C ends the search and keeps the best so far.
    """
    spec = read_robot_file(robot)
    gait = read_trial_gait(file, spec)
    digit = _digit(gait, goal, key)
    task = _task(spec, gait, digit, goal)
    angles = task.table.angles_deg
    ranges_deg = spec.ranges_deg * len(task.table.rows)
    with screen.progress() as progress, Trials(task) as trials:
        bar = progress.add_task(render(say("coach.matters")), total=None)
        matters = what_matters(angles, ranges_deg, trials.quick, trials.exact)
        best: Improved | None = None
        if size is not None:
            end_s = time.monotonic() + seconds
            progress.update(bar, description=render(say("coach.searches")), total=seconds)
            found = improve(
                angles,
                ranges_deg,
                size,
                matters,
                trials.exact,
                lambda: time.monotonic() > end_s,
                seed,
            )
            try:
                for better in found:
                    best = better
                    left_s = max(0.0, end_s - time.monotonic())
                    progress.update(bar, completed=seconds - left_s)
            except KeyboardInterrupt:
                screen.warn(say("coach.stopped"))
        count = trials.count
    before = try_table(task, angles)
    after = before if best is None else try_table(task, best.angles_deg)
    if out is not None and best is not None:
        save(out, _written(spec, gait, digit, task.table, best.angles_deg))
    if json:
        screen.print_json(_as_json(task, digit, matters, best, before, after, count))
        return
    screen.show(_matters_table(task, digit, matters))
    if best is not None:
        screen.show(_improved_table(task, digit, best, before, after))
        if out is not None:
            screen.note(say("coach.written", file=str(out)))


def _digit(gait: Gait, goal: Goal, key: int | None) -> int:
    """Choose the key to change.

    Raises:
        UserError: if the gait has no such key at level B.
    """
    if key is None:
        level, found = forward_key(gait)
        key = _TURNS.get(goal, found if level is Level.LOCOMOTION else 0)
    if gait.sequence(Level.LOCOMOTION, key) is None:
        there = [f"B{one}" for one in gait.keys(Level.LOCOMOTION)]
        raise UserError(say("trial.no-key", key=f"B{key}", keys=there))
    return key


def _task(robot: RobotSpec, gait: Gait, digit: int, goal: Goal) -> Task:
    stand = gait.sequence(Level.LOCOMOTION, 0) or (robot.start_posture,)
    return Task(robot, stand, KeyTable.of(gait.sequence(Level.LOCOMOTION, digit) or ()), goal)


def _written(robot: RobotSpec, gait: Gait, digit: int, table: KeyTable, angles: Angles) -> bytes:
    assert gait.locomotion is not None
    sequences = list(gait.locomotion.sequences)
    sequences[digit] = table.sequence(angles)
    return write_gait(LocomotionTable(tuple(sequences)), robot.labels)


def _place(task: Task, digit: int, index: int) -> Phrase:
    """Name a cell by its key, the first posture that has it, the leg and the joint's place."""
    row, joint = task.table.cell(index)
    legs = len(task.robot.legs)
    return say(
        "explain.cell",
        key=digit,
        posture=task.table.order.index(row) + 1,
        postures=len(task.table.order),
        leg=task.robot.labels[joint % legs],
        level=LEVEL_NAMES[joint // legs],
    )


def _matters_table(task: Task, digit: int, matters: Sequence[Matter]) -> Table:
    table = screen.table(
        say("coach.number"),
        say("coach.now"),
        say("coach.up", step_deg=STEP_DEG),
        say("coach.down", step_deg=STEP_DEG),
    )
    angles = task.table.angles_deg
    for one in matters[:_SHOWN]:
        table.add_row(
            Text(render(_place(task, digit, one.number))),
            f"{angles[one.number]}",
            f"{one.up:+.1f}",
            f"{one.down:+.1f}",
        )
    table.title, table.title_justify = Text(render(say("coach.which-matter"))), "left"
    return table


def _improved_table(
    task: Task, digit: int, best: Improved, before: Figures, after: Figures
) -> Table:
    table = screen.table(say("coach.number"), say("coach.before"), say("coach.after"))
    own = task.table.angles_deg
    for index in task.table.changed(own, best.angles_deg):
        place = Text(render(_place(task, digit, index)))
        table.add_row(place, f"{own[index]}", f"{best.angles_deg[index]}")
    table.add_section()
    for what, then, now in (
        (say("trial.figure-speed"), before.speed_mm_s, after.speed_mm_s),
        (say("trial.figure-drift"), before.drift_deg_s, after.drift_deg_s),
        (say("trial.figure-slip"), before.slip_mm_s, after.slip_mm_s),
    ):
        table.add_row(Text(render(what)), f"{then:.1f}", f"{now:.1f}")
    return table


def _as_json(
    task: Task,
    digit: int,
    matters: Sequence[Matter],
    best: Improved | None,
    before: Figures,
    after: Figures,
    count: int,
) -> dict[str, Any]:
    def cell(index: int) -> dict[str, Any]:
        row, joint = task.table.cell(index)
        return {"posture": task.table.order.index(row), "joint": joint}

    own = task.table.angles_deg
    changes = [] if best is None else task.table.changed(own, best.angles_deg)
    return {
        "key": digit,
        "matters": [{**cell(one.number), "up": one.up, "down": one.down} for one in matters],
        "changes": [
            {**cell(index), "from_deg": own[index], "to_deg": best.angles_deg[index]}
            for index in changes
            if best is not None
        ],
        "before": {"score": score(before, task.goal), "speed_mm_s": before.speed_mm_s},
        "after": {"score": score(after, task.goal), "speed_mm_s": after.speed_mm_s},
        "upright": after.upright,
        "belly_share": after.belly_share,
        "trials": count,
    }
