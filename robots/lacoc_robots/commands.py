"""`lacoc robot`: check a robot file, import or export one, list the installed robots."""

import math
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.table import Table
from rich.text import Text

from lacoc_robots.header.importing import CFile, import_robot
from lacoc_robots.library import find_robot, installed_robots, sample_gait_files
from lacoc_robots.limits import Limits
from lacoc_robots.robot import RobotSpec
from lacoc_robots.robot_file import read_robot
from lacoc_robots.standing import STAND_TEST_S
from lacoc_robots.trying import not_tried, tried
from lacoc_shared.command import options, screen
from lacoc_shared.command.keep import save
from lacoc_shared.contest import file as contests
from lacoc_shared.gait.tables import Gait, Level, LocomotionTable, PostureTable
from lacoc_shared.gait.text import decoded, read_gait
from lacoc_shared.mistakes import FileRefused, UserError, printable, text_of
from lacoc_shared.words import Phrase, render, say

app = typer.Typer(
    help="Check a robot file, import the workshop's header, export MJCF, or list the robots.",
    no_args_is_help=True,
)

_LARGEST_C_FILE = 256 * 1024
"""Largest C file that is read [bytes]."""

_Robot = Annotated[
    str,
    typer.Argument(
        metavar="ROBOT", help="A robot file (.toml), a robot's folder, or an installed name."
    ),
]


@app.command()
def check(robot: _Robot, contest: options.ContestOption = None, json: options.Json = False) -> None:
    """Weigh a robot in: list every mistake in its file, or describe the robot.

    The robot is tried in physics: it must stay in place when it stands, with the gait files beside
    its robot file, or in its start posture if there are none. By default the limits of the rules
    count, with --contest those of the contest. With --json the mistakes are a list, which is empty
    for a robot without mistakes.
    """
    notes: list[Phrase] = []
    try:
        spec = _stands(robot, contest, notes)
    except FileRefused as refused:
        if not json:
            raise
        screen.print_json({"mistakes": [one.in_words() for one in refused.mistakes]})
        raise typer.Exit(2) from None
    facts = _facts(spec)
    for note in notes:
        screen.warn(note)
    if json:
        screen.print_json({**facts, "stands": not_tried() not in notes or None, "mistakes": []})
        return
    width_m, length_m, height_m = facts["footprint_m"]
    table = Table(
        title=Text(render(say("robot-command.right", name=spec.name))),
        title_justify="left",
        show_header=False,
    )
    stands = say("robot-command.stands", seconds=STAND_TEST_S)
    if (untried := not_tried()) in notes:
        stands = untried
    size = say("robot-command.size", width_m=width_m, length_m=length_m, height_m=height_m)
    for what, value in (
        (say("fact.legs"), f"{facts['legs']} ({'  '.join(facts['labels'])})"),
        (say("fact.joints"), f"{facts['joints']}"),
        (say("fact.mass"), f"{facts['mass_kg']:.3f} kg"),
        (say("fact.footprint"), size),
        ("AngMin", say("robot-command.ang-min", deg_s=facts["ang_min_deg_s"])),
        (say("fact.next-posture"), _advance(spec)),
        (say("fact.stands"), stands),
    ):
        table.add_row(render(what), Text(render(value)))
    screen.show(table)


@app.command()
def export(
    robot: _Robot,
    out: Annotated[Path, typer.Argument(metavar="OUT", help="The MJCF file to write (.xml).")],
    contest: options.ContestOption = None,
) -> None:
    """Write a robot as plain MJCF, which any MuJoCo opens.

    The file has a floor, and in its keyframe "stand" the robot stands there. If there is a file of
    that name already, it is kept under another name. This command needs MuJoCo, which the extra
    "server" installs.
    """
    spec = _read(robot, contest)
    from lacoc_robots.model import export_mjcf  # a contestant's machine may have no MuJoCo

    kept = save(out, export_mjcf(spec).encode())
    if kept is not None:
        screen.note(say("command.kept", path=str(out), kept=str(kept)))
    screen.note(say("robot-command.written", path=str(out)))


@app.command("import")
def import_header(
    files: Annotated[
        list[Path],
        typer.Argument(metavar="FILES", help="robot6legs.h, and mainR.cpp if AngMin is changed."),
    ],
    out: Annotated[Path, typer.Option(metavar="FILE", help="The robot file to write.")] = Path(
        "robot.toml"
    ),
    name: Annotated[str, typer.Option(metavar="NAME", help="The robot's name.")] = "My robot",
) -> None:
    """Make a robot file of the workshop's C header (workshop 4-3).

    Sizes, weights, places of the legs, start posture and AngMin are read, also from expressions
    such as 0.5*ROBOT_BODY_W. Nothing is compiled. Each line that can't be read is named, and the
    workshop's own numbers stand in its place. A file of the same name is kept.
    """
    sources = [CFile(printable(file.name), _c_text(file)) for file in files]
    made = import_robot(sources, text_of(name))
    kept = save(out, made.toml.encode())
    for note in made.notes:
        screen.warn(note)
    if kept is not None:
        screen.note(say("command.kept", path=str(out), kept=str(kept)))
    screen.note(say("robot-command.imported", path=str(out)))
    read_robot(made.toml, out.name)


def _c_text(file: Path) -> str:
    try:
        data = file.read_bytes()
    except OSError as error:
        why = error.strerror or str(error)
        raise UserError(say("command.cannot-read", path=str(file), why=why)) from None
    return decoded(data, file.name, _LARGEST_C_FILE).text


@app.command("list")
def list_robots(json: options.Json = False) -> None:
    """List the installed robots; you can give their names in place of a robot file."""
    robots = {name: _facts(_read(name, None)) for name in installed_robots()}
    if json:
        screen.print_json(robots)
        return
    table = screen.table(
        say("fact.robot"), say("fact.legs"), say("fact.mass-kg"), say("fact.ang-min")
    )
    for name, facts in robots.items():
        table.add_row(
            name, f"{facts['legs']}", f"{facts['mass_kg']:.3f}", f"{facts['ang_min_deg_s']:g}"
        )
    screen.show(table)


def _stands(robot: str, contest: Path | None, notes: list[Phrase]) -> RobotSpec:
    """Read a robot and check that it can stand.

    Raises:
        FileRefused: with every mistake in the robot's file, or with what the robot did instead of
            standing.
    """
    name, data = find_robot(robot)
    spec = _spec(name, data, contest)
    if mistakes := tried(spec, _gait_beside(robot, spec, notes), tuple(Level), name, notes):
        raise FileRefused(mistakes)
    return spec


def _read(robot: str, contest: Path | None) -> RobotSpec:
    return _spec(*find_robot(robot), contest)


def _spec(name: str, data: bytes, contest: Path | None) -> RobotSpec:
    limits = Limits.of(contests.load(contest).limits) if contest else Limits()
    return read_robot(data, name, limits)


def _gait_beside(robot: str, spec: RobotSpec, notes: list[Phrase]) -> Gait:
    """Read the gait files beside a robot's file; leave out files with mistakes, and note this."""
    tables: list[PostureTable | LocomotionTable] = []
    for file in sample_gait_files(robot):
        if file is None:
            continue
        try:
            table = read_gait(file.data, file.name, legs=spec.labels, range_deg=spec.ranges_deg)
        except FileRefused:
            notes.append(say("robot-command.gait-mistakes", file=file.name))
        else:
            tables.append(table)
    return Gait(
        next((table for table in tables if isinstance(table, PostureTable)), None),
        next((table for table in tables if isinstance(table, LocomotionTable)), None),
    )


def _facts(spec: RobotSpec) -> dict[str, Any]:
    low, high = spec.bounds((0.0,) * spec.joints)
    return {
        "name": spec.name,
        "legs": len(spec.legs),
        "labels": spec.labels,
        "joints": spec.joints,
        "mass_kg": round(spec.mass_kg, 6),
        "footprint_m": [round(b - a, 6) for a, b in zip(low, high, strict=True)],
        "ang_min_deg_s": round(math.degrees(spec.ang_min_rad_s), 6),
        "advance": spec.advance,
        "hold_s": spec.hold_us / 1e6,
    }


def _advance(spec: RobotSpec) -> Phrase:
    hold_s = spec.hold_us / 1e6
    if spec.advance == "time":
        return say("robot-command.every", seconds=hold_s)
    return say("robot-command.when-reached", held_s=hold_s or None)
