"""`lacoc trial`: let a robot walk with a gait, and print figures of how it walks."""

from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.text import Text

from lacoc_robots.library import WORKSHOPS_ROBOT, find_robot
from lacoc_robots.robot import RobotSpec
from lacoc_robots.robot_file import read_robot
from lacoc_server.studio.answers import Trial, try_gait
from lacoc_server.trial.bars import foot_bars
from lacoc_server.trial.course import SETTLE_TICKS
from lacoc_server.trial.figures import Figures
from lacoc_server.trial.walk import Walk
from lacoc_server.world.sensed import make_course
from lacoc_shared.command import options, screen
from lacoc_shared.gait.joining import sample_sequences
from lacoc_shared.gait.tables import Gait, PostureTable
from lacoc_shared.gait.workbook.file import read_gait_file
from lacoc_shared.mistakes import FileRefused, Mistake
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
    gait = read_trial_gait(file, spec)
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


def read_robot_file(name: str) -> RobotSpec:
    """Read a robot's file and check it against the limits of rules 1.

    Raises:
        UserError: if there is no such robot.
        FileRefused: with every mistake of its file.
    """
    file, data = find_robot(name)
    return read_robot(data, file)


def read_trial_gait(file: Path, robot: RobotSpec) -> Gait:
    """Read a gait file for a trial; postures are joined into the sequences of the sample's keys.

    Raises:
        UserError: if the file can't be read.
        FileRefused: with every mistake of the file.
    """
    table = read_gait_file(file, legs=robot.labels, range_deg=robot.ranges_deg)
    if isinstance(table, PostureTable):
        gait = Gait(table, sample_sequences(table))
    else:
        gait = Gait(None, table)
    if gait.joints != robot.joints:
        found = say("trial.joints", joints=gait.joints)
        expected = say("trial.joints-of", joints=robot.joints, robot=robot.name)
        raise FileRefused([Mistake(file=file.name, found=found, expected=expected)])
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
    for what, value in (
        (say("trial.figure-speed"), _number(figures.speed_mm_s, "mm/s")),
        (say("trial.figure-lateral"), _number(figures.lateral_mm_s, "mm/s")),
        (say("trial.figure-drift"), _number(figures.drift_deg_s, "deg/s", 2)),
        (say("trial.figure-stable"), f"{100 * figures.stable_share:.0f} %"),
        (say("trial.figure-margin"), _number(figures.margin_mm, "mm")),
        (say("trial.figure-slip"), _number(figures.slip_mm_s, "mm/s")),
        (say("trial.figure-slip-ratio"), _number(figures.slip_ratio, "", 2)),
        (say("trial.figure-cost"), _number(figures.cost_of_transport, "", 1)),
        (say("trial.figure-clearance"), _number(figures.clearance_mm, "mm")),
        (say("trial.figure-belly"), f"{100 * figures.belly_share:.0f} %"),
        (say("trial.figure-upright"), _number(figures.upright, "", 2)),
        (say("trial.figure-duty"), "  ".join(f"{share:.2f}" for share in figures.duty)),
        (
            say("trial.figure-cycles"),
            f"{figures.cycles} × {figures.cycle_s:.2f} s" if figures.cycle_s else "–",
        ),
    ):
        table.add_row(render(what), Text(value))
    return table


def _number(value: float | None, unit: str, digits: int = 1) -> str:
    return "–" if value is None else f"{value:.{digits}f} {unit}".rstrip()


def _bars(walk: Walk) -> list[str]:
    return foot_bars(walk.legs, walk.down, walk.starts, SETTLE_TICKS, _MOST_COLUMNS)
