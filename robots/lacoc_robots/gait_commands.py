"""`lacoc gait`: take a sample, check gait files before a match, convert one kind to another."""

import itertools
import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import msgspec
import typer
from rich.table import Table
from rich.text import Text

from lacoc_robots.joint_picture import joint_picture, labels_of
from lacoc_robots.library import WORKSHOPS_ROBOT, find_robot, sample_gait_files
from lacoc_robots.robot import RobotSpec
from lacoc_robots.robot_file import read_robot
from lacoc_robots.trying import tried
from lacoc_shared.command import options, screen
from lacoc_shared.command.keep import make_folder, save
from lacoc_shared.gait.cells import leg_labels
from lacoc_shared.gait.joining import join_postures
from lacoc_shared.gait.tables import (
    JOINTS_PER_LEG,
    SAMPLE_KEYS,
    Gait,
    Level,
    LocomotionTable,
    Posture,
    PostureTable,
    to_postures,
)
from lacoc_shared.gait.text import read_gait, write_gait
from lacoc_shared.gait.workbook.file import read_gait_file, write_workbook
from lacoc_shared.mistakes import FileRefused, Mistake, UserError
from lacoc_shared.words import Phrase, render, say

app = typer.Typer(
    help="Take the sample gait, check gait files, and convert one kind to another.\n\n"
    "The kinds are Loco-data.txt, Loco-data.xlsx (postures) and LocoTra-data.txt (locomotion).",
    no_args_is_help=True,
)

WORKBOOK = "Loco-data.xlsx"
"""Name of the table that `sample` writes."""
_SAMPLE_KEYS_TEXT = ";".join(",".join(map(str, sequence)) for sequence in SAMPLE_KEYS)
_KEYS = re.compile(r"\d(,\d)*(;\d(,\d)*)*", re.ASCII)
_LIFTED = 0.1  # link lengths above the lowest foot: 7 mm on the workshop's robot


class CheckedFile(msgspec.Struct, frozen=True):
    """A file without mistakes, as `lacoc gait check --json` prints it."""

    file: str
    kind: str
    """"postures" (level A) or "locomotion" (level B)."""
    legs: int
    keys: dict[int, int]
    """Digit key -> number of its postures."""


@app.command()
def sample(
    folder: Annotated[
        Path, typer.Argument(help="Folder for the table; it is made if it does not exist.")
    ] = Path(),
    robot: Annotated[
        str,
        typer.Option(
            metavar="ROBOT",
            help="The robot whose sample is wanted: an installed name (see 'lacoc robot list') or "
            "a robot's folder.",
        ),
    ] = WORKSHOPS_ROBOT,
) -> None:
    """Write a robot's sample gait as the table Loco-data.xlsx, to change it.

    An older file of that name is kept with a number.
    """
    name, data = find_robot(robot)
    spec = read_robot(data, name)
    beside = sample_gait_files(robot).postures
    if beside is None:
        raise UserError(say("gait-command.no-sample", robot=robot))
    table = read_gait(beside.data, beside.name, legs=spec.labels, range_deg=spec.ranges_deg)
    assert isinstance(table, PostureTable)  # the name says so
    make_folder(folder)
    _write(folder / WORKBOOK, write_workbook(table, spec.labels))


@app.command()
def check(
    files: Annotated[
        list[Path], typer.Argument(metavar="FILE", help="Gait files, text or workbook.")
    ],
    legs: Annotated[
        int | None,
        typer.Option(
            min=1,
            max=100,
            metavar="N",
            help="How many legs the robot has; by default gaits for 4, 6 or 8 legs are accepted.",
        ),
    ] = None,
    robot: Annotated[
        str | None,
        typer.Option(
            "--robot",
            metavar="ROBOT",
            help="The robot that the gait is for: a robot file (.toml), a robot's folder, or "
            "an installed name. The gait must fit its legs and ranges, and the robot must "
            "be able to stand.",
        ),
    ] = None,
    json: options.Json = False,
) -> None:
    """Say what the keys of a gait do, or list every mistake in the file."""
    if robot is not None and legs is not None:
        raise UserError(say("gait-command.legs-of-robot"))
    fits: dict[str, Any] = {"legs": legs}
    spec, robot_file = None, ""
    if robot is not None:
        robot_file, data = find_robot(robot)
        spec = read_robot(data, robot_file)
        fits = {"legs": spec.labels, "range_deg": spec.ranges_deg}
    tables: list[tuple[Path, PostureTable | LocomotionTable]] = []
    mistakes: list[Mistake] = []
    notes: list[Phrase] = []
    for file in files:
        try:
            tables.append((file, read_gait_file(file, **fits, notes=notes)))
        except FileRefused as error:
            mistakes += error.mistakes
        except UserError as error:  # a file that can't be opened must not hide the others
            expected = say("gait-command.name-of-file")
            mistakes.append(Mistake(file=str(file), found=error.phrase, expected=expected))
    if spec is not None:
        mistakes += _tried(spec, robot_file, [table for _, table in tables], notes)
    if json:
        checked = [_checked(file, table) for file, table in tables]
        in_words = [mistake.in_words() for mistake in mistakes]
        screen.print_json({"files": checked, "mistakes": in_words, "notes": [*map(render, notes)]})
        if mistakes:
            raise typer.Exit(2)
        return
    for file, table in tables:
        table_legs = table.joints // JOINTS_PER_LEG
        if isinstance(table, PostureTable):
            right = say("gait-command.right-a", file=file.name, legs=table_legs)
        else:
            right = say("gait-command.right-b", file=file.name, legs=table_legs)
        screen.show(Text(render(right), style="bold"))
        screen.show(_summary(table))
    for note in notes:
        screen.warn(note)
    if mistakes:
        screen.refused(mistakes)
        if (labels := spec.labels if spec else labels_of(mistakes)) is not None:
            lit = {mistake.joint for mistake in mistakes if mistake.joint is not None}
            screen.show(joint_picture(labels, lit), screen.stderr)
        raise typer.Exit(2)


@app.command()
def convert(
    source: Annotated[Path, typer.Argument(metavar="A", help="The gait file to read.")],
    target: Annotated[
        Path,
        typer.Argument(
            metavar="B",
            help="The file to write: .xlsx is a workbook; a .txt whose name begins with LocoTra "
            "has locomotion (level B); any other .txt has postures (level A).",
        ),
    ],
    keys: Annotated[
        str | None,
        typer.Option(
            metavar="KEYS",
            help="To make locomotion from postures: the postures of each key, from key 0 on. "
            f"By default as in the sample: '{_SAMPLE_KEYS_TEXT}'.",
        ),
    ] = None,
) -> None:
    """Convert a gait file to another kind; an older file of that name is kept with a number."""
    locomotion = _is_locomotion(target)
    notes: list[Phrase] = []
    table = read_gait_file(source, notes=notes)
    if keys is not None and not (locomotion and isinstance(table, PostureTable)):
        raise UserError(say("convert.keys-use"))
    if locomotion and isinstance(table, PostureTable):
        table = _joined(table, source, _SAMPLE_KEYS_TEXT if keys is None else keys)
    elif not locomotion and isinstance(table, LocomotionTable):
        try:
            table = to_postures(table)
        except ValueError as error:
            raise UserError(say("convert.file-has", file=source.name, error=str(error))) from error
    labels = leg_labels(table.joints // JOINTS_PER_LEG)
    if isinstance(table, PostureTable) and target.suffix.lower() == ".xlsx":
        data = write_workbook(table, labels)
    else:
        data = write_gait(table, labels)
    _write(target, data)
    for note in notes:
        screen.warn(note)


def _write(path: Path, data: bytes) -> None:
    """Write a file, and tell the user its name and that of an older file, which is kept."""
    kept = save(path, data)
    if kept is not None:
        screen.note(say("command.kept", path=str(path), kept=str(kept)))
    screen.note(say("command.written", path=str(path)))


def _is_locomotion(target: Path) -> bool:
    """Return whether a file to write gets locomotion (level B), judged by the file's name.

    Raises:
        UserError: if this command does not write files with such a name.
    """
    if target.suffix.lower() not in (".txt", ".xlsx"):
        raise UserError(say("convert.target", path=str(target)))
    return target.suffix.lower() == ".txt" and target.name.lower().startswith("locotra")


def _joined(table: PostureTable, source: Path, keys: str) -> LocomotionTable:
    """Join postures into the sequences that the option --keys names.

    Raises:
        UserError: if --keys is written wrong, has too many keys or postures, or names a posture
            that does not exist.
    """
    compact = keys.replace(" ", "")
    if not _KEYS.fullmatch(compact):
        raise UserError(say("convert.bad-keys", keys=keys, example=_SAMPLE_KEYS_TEXT))
    return join_postures(
        table, source.name, [[*map(int, part.split(","))] for part in compact.split(";")]
    )


def _tried(
    robot: RobotSpec,
    file: str,
    tables: Sequence[PostureTable | LocomotionTable],
    notes: list[Phrase],
) -> list[Mistake]:
    """Try in physics whether a robot stands with key 0 of each table."""
    book: list[Mistake] = []
    for table in tables:
        if isinstance(table, PostureTable):
            gait, level = Gait(postures=table), Level.POSTURE
        else:
            gait, level = Gait(locomotion=table), Level.LOCOMOTION
        book += tried(robot, gait, (level,), file, notes)
    return list(dict.fromkeys(book))


def _checked(file: Path, table: PostureTable | LocomotionTable) -> CheckedFile:
    return CheckedFile(
        file=file.name,
        kind="postures" if isinstance(table, PostureTable) else "locomotion",
        legs=table.joints // JOINTS_PER_LEG,
        keys={digit: len(sequence) for digit, sequence in _sequences(table).items()},
    )


def _summary(table: PostureTable | LocomotionTable) -> Table:
    """Return a table that shows what each key of a gait does."""
    labels = leg_labels(table.joints // JOINTS_PER_LEG)
    summary = screen.table(say("fact.key"), say("fact.postures"), say("fact.feet-lifted"))
    for digit, sequence in sorted(_sequences(table).items()):
        summary.add_row(str(digit), str(len(sequence)), Text(_lifts(sequence, labels)))
    return summary


def _sequences(table: PostureTable | LocomotionTable) -> dict[int, tuple[Posture, ...]]:
    if isinstance(table, PostureTable):
        return {digit: (posture,) for digit, posture in table.postures.items()}
    return dict(enumerate(table.sequences))


def _lifts(sequence: Sequence[Posture], labels: Sequence[str]) -> str:
    """Name the legs whose feet are lifted in each posture of a sequence.

    Postures in a row that lift the same feet are one step. Only the first six steps are named; "…"
    stands for the rest.
    """
    steps = [step for step, _ in itertools.groupby(_lifted(p, labels) for p in sequence)]
    none, then = render(say("gait-command.no-feet")), render(say("gait-command.then"))
    shown = then.join(" ".join(step) or none for step in steps[:6])
    return shown + (" …" if len(steps) > 6 else "")


def _lifted(posture: Posture, labels: Sequence[str]) -> tuple[str, ...]:
    """Return the labels of the legs whose feet are higher than the lowest foot.

    This assumes that the body is level, and that all links have the same length.
    """
    legs = len(labels)
    # A positive 1st joint lifts the leg, and a positive 2nd joint swings the shank up (rules 1).
    # With both at 0 the shank hangs straight down.
    heights = [
        math.sin(first) - math.cos(first + second)
        for first, second in zip(posture[legs : 2 * legs], posture[2 * legs :], strict=True)
    ]
    return tuple(
        label
        for label, height in zip(labels, heights, strict=True)
        if height > min(heights) + _LIFTED
    )
