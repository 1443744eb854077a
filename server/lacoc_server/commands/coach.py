"""`lacoc coach`: rank the numbers of a gait, and search for a better gait or for other ones."""

import signal
import threading
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, Any

import typer
from msgspec.structs import asdict
from rich.table import Table
from rich.text import Text

from lacoc_robots.library import WORKSHOPS_ROBOT
from lacoc_robots.reading import read_robot_file
from lacoc_server.commands.coach_others import as_json as others_json
from lacoc_server.commands.coach_others import (
    kept_tables,
    map_table,
    named_gaits,
    variants_table,
    write_gaits,
    written,
)
from lacoc_server.commands.trial import GaitFile, RobotName, warned_gait
from lacoc_server.simulate.workers import Workers
from lacoc_server.studio.coach.coach import Tell, cell_place, coach, coached_key, reply_of, task_of
from lacoc_server.studio.coach.goal import goal_value
from lacoc_server.studio.coach.harm import worse
from lacoc_server.studio.coach.improve import Size
from lacoc_server.studio.coach.matter import STEP_DEG, Matter
from lacoc_server.studio.coach.repair import Repaired
from lacoc_server.studio.coach.search import Improved
from lacoc_server.studio.coach.table import differing
from lacoc_server.studio.coach.trials import Task, Trials
from lacoc_server.studio.styles.found import map_reply, variants_reply
from lacoc_server.studio.styles.gait_map import map_gaits
from lacoc_server.studio.styles.variants import VARIANTS, vary
from lacoc_server.trial.figures import Figures
from lacoc_server.trial.reasons.form import cell_name
from lacoc_server.trial.reasons.goal import Goal
from lacoc_server.trial.told import SHOWN_NAMES, told
from lacoc_shared.command import options, screen
from lacoc_shared.command.keep import save
from lacoc_shared.gait.tables import SAMPLE_KEYS, Gait
from lacoc_shared.mistakes import UserError
from lacoc_shared.studio import CoachReply, MapReply, Progress, VariantsReply
from lacoc_shared.words import Phrase, render, say

app = typer.Typer()

_SHOWN = 10
"""Most numbers of the gait that are printed in the table of those that matter."""
_STAGES = {
    "repair": say("coach.repairs"),
    "matters": say("coach.matters"),
    "search": say("coach.searches"),
    "undo": say("coach.undoes"),
    "variants": say("coach.varies"),
}


@app.command(name="coach")
def coach_command(
    file: GaitFile,
    robot: RobotName = WORKSHOPS_ROBOT,
    size: Annotated[
        Size | None,
        typer.Option(
            help="Search for a better table: change one number (cell), at most three, or the "
            "whole table. By default the coach only says which numbers matter."
        ),
    ] = None,
    goal: Annotated[
        Goal,
        typer.Option(
            "--for", help="What the robot should do better; this also chooses the key to change."
        ),
    ] = Goal.FORWARD,
    key: Annotated[
        int | None,
        typer.Option(
            help="The key of level B to change; by default the key of --for.", min=0, max=9
        ),
    ] = None,
    seconds: Annotated[
        float,
        typer.Option(
            metavar="S",
            help="How many seconds the coach searches; then it undoes changes that hardly help.",
            min=1.0,
            max=3600.0,
        ),
    ] = 30.0,
    seed: Annotated[
        int,
        typer.Option(
            help="Number that decides the order of the search; another number gives another order.",
            min=0,
        ),
    ] = 0,
    out: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="File for the better gait, as LocoTra-data text; with --map or --variants a "
            "folder for all gaits that were found.",
        ),
    ] = None,
    map_: Annotated[
        bool,
        typer.Option(
            "--map",
            help="Search for a map of gaits instead: from slow to fast, from calm to excited.",
        ),
    ] = False,
    variants: Annotated[
        bool,
        typer.Option("--variants", help="Show six gaits that look different instead."),
    ] = False,
    keep: Annotated[
        list[Path] | None,
        typer.Option(
            metavar="FILE",
            help="With --variants: a gait file to keep. New variants are bred from one or two.",
        ),
    ] = None,
    json: options.Json = False,
) -> None:
    """Say which numbers of a gait matter, and search for a better gait with few changes.

    The coach makes each number 10 degrees larger and smaller, and lets the robot walk as in a
    contest. With --size the coach first repairs a mistake, with its reason; if there is none, it
    searches for a better gait (the whole table in any case). A change that hardly helps is undone,
    so that you can understand the changes that are left. With --map or --variants it looks for
    gaits that are different instead. Ctrl-C ends the search and keeps what it has found.
    """
    wishes = sum((size is not None, map_, variants))
    if wishes > 1:
        raise UserError(say("coach.one-wish"))
    if out is not None and not wishes:
        raise UserError(say("coach.out-of-nothing"))
    if goal is not Goal.FORWARD and (map_ or variants):
        raise UserError(say("coach.keep-forward"))
    if keep and (not variants or len(keep) > 2):
        raise UserError(say("coach.keep-variants"))
    spec = read_robot_file(robot)
    gait = warned_gait(file, spec)
    digit = coached_key(gait, goal, key)
    sequences = None if gait.postures is None else SAMPLE_KEYS
    task = task_of(spec, gait, digit, goal, sequences)
    if map_ or variants:
        kept = kept_tables(keep or [], spec, task, digit)
        with _trials(task) as (trials, tell):
            reply: MapReply | VariantsReply
            if map_:
                reply = map_reply(task, digit, map_gaits(trials, seconds, seed, tell))
            else:
                own = task.table.angles_deg
                varied = vary(trials, kept or [own], [own], seed, int(bool(kept)), tell)
                reply = variants_reply(task, digit, varied)
        _show_others(reply, task, gait, out, json)
        return
    with _trials(task) as (trials, tell):
        found = coach(trials, size, seconds, seed, tell)
    if found.stopped:
        if not (found.matters or found.repairs):
            raise KeyboardInterrupt
        screen.warn(say("coach.stopped"))
    best = found.best
    if out is not None and best is not None:
        save(out, written(task, gait, digit, best.angles_deg))
    if json:
        screen.print_json(_as_json(reply_of(task, digit, found)))
        return
    if found.matters and not found.repairs:
        screen.show(_matters_table(task, digit, found.matters))
    for one in found.repairs:
        screen.show(_repaired(one, goal))
    if best is not None and best.angles_deg == task.table.angles_deg:
        screen.show(say("coach.nothing"))
    elif best is not None:
        screen.show(_improved_table(task, digit, best, found.before, found.after))
        harmed = [SHOWN_NAMES[name] for name in worse(found.before, found.after, goal)]
        if harmed:
            screen.show(say("coach.worse", figures=harmed))
    if out is not None and best is not None:
        screen.note(say("command.written", path=str(out)))


def _show_others(
    reply: MapReply | VariantsReply, task: Task, gait: Gait, out: Path | None, json: bool
) -> None:
    if reply.cancelled:
        screen.warn(say("coach.stopped"))
    named = named_gaits(reply)
    if out is not None:
        write_gaits(out, task, gait, reply.key, named)
    if json:
        screen.print_json(others_json(reply))
        return
    if isinstance(reply, MapReply):
        screen.show(map_table(reply))
    else:
        screen.show(variants_table(reply))
        if len(named) < VARIANTS:
            screen.warn(say("coach.few-variants", count=len(named)))
    if out is not None:
        screen.note(say("coach.folder-written", count=len(named), folder=str(out)))


@contextmanager
def _trials(task: Task) -> Iterator[tuple[Trials, Tell]]:
    """Give the object that runs trials in processes, and a function that shows the progress.

    Ctrl-C stops the search.
    """
    with screen.progress() as progress, Workers() as workers, _stop_on_interrupt() as stop:
        bar = progress.add_task("", total=1.0)

        def tell(how_far: Progress) -> None:
            if how_far.stage == "map":
                stage = say("coach.maps", filled=how_far.filled or 0)
            else:
                stage = _STAGES[how_far.stage]
            progress.update(bar, description=render(stage), completed=how_far.done)

        yield Trials(task, workers, stop), tell


@contextmanager
def _stop_on_interrupt() -> Iterator[threading.Event]:
    """Give an event that Ctrl-C sets, so that the search ends and its best gait is kept."""
    stop = threading.Event()
    before = signal.signal(signal.SIGINT, lambda *_: stop.set())
    try:
        yield stop
    finally:
        signal.signal(signal.SIGINT, before)


def _place(task: Task, digit: int, index: int) -> Phrase:
    """Say where a number of the table stands: its key, posture, leg and joint."""
    place = cell_place(task.table, index)
    return cell_name(task.robot, digit, len(task.table.order), place)


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
    for index in differing(own, best.angles_deg):
        place = Text(render(_place(task, digit, index)))
        table.add_row(place, f"{own[index]}", f"{best.angles_deg[index]}")
    table.add_section()
    shown = {render(name) for name in SHOWN_NAMES.values()}
    for (what, then), (_, now) in zip(told(before), told(after), strict=True):
        if render(what) in shown:
            table.add_row(Text(render(what)), then, now)
    return table


def _repaired(one: Repaired, goal: Goal) -> Phrase:
    """Say which mistake was repaired, with the speed (or turning speed) before and after."""
    before, after = goal_value(one.before, goal), goal_value(one.after, goal)
    if goal is Goal.FORWARD:
        return say("coach.repaired", why=one.said, before_mm_s=before, after_mm_s=after)
    return say("coach.repaired-turn", why=one.said, before_deg_s=before, after_deg_s=after)


def _as_json(reply: CoachReply) -> dict[str, Any]:
    return {
        "key": reply.key,
        "matters": [{**asdict(one.cell), "up": one.up, "down": one.down} for one in reply.matters],
        "repairs": [
            {**asdict(one.cell), "said": render(one.said), "before": one.before, "after": one.after}
            for one in reply.repairs
        ],
        "worse": list(reply.worse),
        "changes": [
            {**asdict(one.cell), "from_deg": one.from_deg, "to_deg": one.to_deg}
            for one in reply.changes
        ],
        "before": _score_and_speeds(reply.score_before, reply.before),
        "after": _score_and_speeds(reply.score_after, reply.after),
        "upright": reply.after["upright"],
        "belly_share": reply.after["belly_share"],
        "trials": reply.trials,
    }


def _score_and_speeds(score: float, figures: Mapping[str, Any]) -> dict[str, float]:
    return {
        "score": score,
        "speed_mm_s": figures["speed_mm_s"],
        "drift_deg_s": figures["drift_deg_s"],
    }
