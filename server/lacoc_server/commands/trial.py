"""`lacoc trial`: let a robot walk with a gait, and print figures of how it walks."""

from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.text import Text

from lacoc_robots.library import WORKSHOPS_ROBOT
from lacoc_robots.reading import load_gait, read_robot_file
from lacoc_robots.robot import RobotSpec
from lacoc_server.studio.answers import Trial, try_gait
from lacoc_server.trial.bars import foot_bars
from lacoc_server.trial.course import SETTLE_TICKS
from lacoc_server.trial.figures import Figures
from lacoc_server.trial.told import told
from lacoc_server.trial.walk import Walk
from lacoc_server.world.sensed import make_course
from lacoc_shared.command import options, screen
from lacoc_shared.gait.tables import Gait
from lacoc_shared.words import Phrase, render, say

app = typer.Typer()

GaitFile = Annotated[
    Path,
    typer.Argument(
        metavar="FILE", help="A gait file: Loco-data.xlsx, Loco-data.txt or LocoTra-data.txt."
    ),
]
RobotName = Annotated[
    str,
    typer.Option(
        "--robot",
        metavar="ROBOT",
        help="The robot: an installed one, a robot's folder, or a robot file (.toml).",
    ),
]

_MOST_COLUMNS = 100


@app.command(name="trial")
def trial_command(
    file: GaitFile,
    robot: RobotName = WORKSHOPS_ROBOT,
    keys: Annotated[
        str,
        typer.Option(
            metavar="KEYS",
            help="Keys to press: '2', or '1:3, 2' for key 1 for 3 s and then key 2. The last "
            "key is measured. By default key 2, forward, is pressed.",
        ),
    ] = "",
    seconds: Annotated[
        float | None,
        typer.Option(
            metavar="S",
            help="How many seconds to press the last key; by default until its sequence was "
            "repeated 6 times.",
            min=0.1,
            max=60.0,
        ),
    ] = None,
    json: options.Json = False,
) -> None:
    """Let a robot walk alone, and print how well it walks: figures, foot bars and explanations.

    The robot moves exactly as at a court. A file of postures (Loco-data) is tried with the
    sequences of the sample's keys: 0 stand, 1 turn left, 2 forward, 3 turn right. The figures are
    averages of whole cycles, without the first cycle, in which the robot starts to move.
    """
    spec = read_robot_file(robot)
    gait = warned_gait(file, spec)
    trial = try_gait(make_course(spec), gait, keys, seconds)
    if json:
        screen.print_json(_as_json(trial))
        return
    press = trial.press
    title = say("trial.title", robot=spec.name, level="AB"[press.level], key=press.digit)
    screen.show(_table(trial.figures, title))
    for row in _bars(trial.walk):
        screen.show(Text(row))
    for sentence in trial.explained:
        screen.show(sentence.said)
    for note in trial.notes:
        screen.warn(note)


def warned_gait(file: Path, robot: RobotSpec) -> Gait:
    """Read a gait file of a robot, and print what is perhaps not intended in it.

    Raises:
        UserError: if the file can't be read.
        FileRefused: with every mistake of the file.
    """
    notes: list[Phrase] = []
    gait = load_gait(file, robot, notes)
    for note in notes:
        screen.warn(note)
    return gait


def _as_json(trial: Trial) -> dict[str, Any]:
    fault = None if trial.walk.fault is None else render(trial.walk.fault)
    sentences = [render(one.said) for one in trial.explained]
    figures = asdict(trial.figures)
    return {"legs": trial.walk.legs, **figures, "fault": fault, "explained": sentences}


def _table(figures: Figures, title: Phrase) -> Any:
    """Make a table of the most important figures."""
    table = screen.table(say("trial.figure"), say("trial.value"))
    table.title, table.title_justify = Text(render(title)), "left"
    for what, value in told(figures):
        table.add_row(render(what), Text(value))
    return table


def _bars(walk: Walk) -> list[str]:
    return foot_bars(walk.legs, walk.down, walk.starts, SETTLE_TICKS, _MOST_COLUMNS)
