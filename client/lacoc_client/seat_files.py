"""What a contestant brings: a robot file and gait files, from where they lie (rules 2)."""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

from lacoc_robots.library import find_robot, sample_gait_files
from lacoc_shared.gait.cells import leg_labels
from lacoc_shared.gait.joining import join_postures, sample_sequences
from lacoc_shared.gait.tables import JOINTS_PER_LEG, LocomotionTable, PostureTable
from lacoc_shared.gait.text import read_gait, write_gait
from lacoc_shared.gait.workbook import read_gait_file, read_workbook
from lacoc_shared.messages import SentFile
from lacoc_shared.mistakes import FileRefused, Mistake, UserError, text_of
from lacoc_shared.words import Phrase, say

_POSTURES = ("Loco-data.txt", "Loco-data.xlsx", "Loco-data-6legs.txt")
_LOCOMOTION = ("LocoTra-data.txt", "LocoTra-data*.txt")

_ZIP = b"PK\x03\x04"  # a workbook

_Table = PostureTable | LocomotionTable


class SeatFiles(NamedTuple):
    """What goes with a join; None: the contest's robot, or its sample gait."""

    robot: SentFile | None = None
    postures: SentFile | None = None
    locomotion: SentFile | None = None


def gather(
    robot: str | None, gaits: Sequence[Path], notes: list[Phrase] | None = None
) -> SeatFiles:
    """Read the files that were named.

    Args:
        robot: an installed robot, a folder or a robot file; None: the contest's.
        gaits: gait files, at most one for each level; none: those beside the robot file.
        notes: takes what is no mistake in a workbook, but may not be meant. The court says the
            same of a text.

    Raises:
        FileRefused: with every mistake of every gait file.
        UserError: if a file can't be read, or two are for the same level.
    """
    robot_file = SentFile(*find_robot(robot)) if robot else None
    if gaits:
        return SeatFiles(robot_file, *_read(gaits, notes))
    return SeatFiles(robot_file, *(sample_gait_files(robot) if robot else (None, None)))


def as_text(files: SeatFiles, notes: list[Phrase] | None = None) -> SeatFiles:
    """Turn workbooks into the text that they stand for: that is what a court reads.

    Each keeps its name, by which mistakes are told to its contestant. `notes` takes what is no
    mistake in a workbook, but may not be meant.

    Raises:
        FileRefused: with every mistake of every workbook.
    """
    mistakes: list[Mistake] = []
    texts: list[SentFile | None] = []
    for file in (files.postures, files.locomotion):
        if file is None or not file.data.startswith(_ZIP):
            texts.append(file)
            continue
        try:
            texts.append(_text(file.name, read_workbook(file.data, file.name, notes=notes)))
        except FileRefused as refused:
            mistakes += refused.mistakes
    if mistakes:
        raise FileRefused(mistakes)
    return SeatFiles(files.robot, *texts)


def with_level_b(files: SeatFiles, sequences: Sequence[Sequence[int]] | None = None) -> SeatFiles:
    """Make level B of the postures where no locomotion file comes with them.

    Args:
        files: as text; a posture file with mistakes is left to the court, which knows the robot.
        sequences: for each digit key from 0 on, the postures it runs through, by their digits;
            None: as the sample's keys, if the postures have all of theirs.

    Raises:
        UserError: if a sequence is empty, or uses a posture that there is not.
    """
    postures = files.postures
    if postures is None or files.locomotion is not None:
        return files
    try:
        table = read_gait(postures.data, postures.name)
    except FileRefused:
        return files
    if not isinstance(table, PostureTable):
        return files
    if sequences is None:
        joined = sample_sequences(table)
    else:
        joined = join_postures(table, postures.name, sequences)
    if joined is None:
        return files
    return files._replace(locomotion=_text(f"level B of {postures.name}", joined))


def gaits_in(folder: Path) -> list[Path]:
    """The gait files of a folder (workshop 4-1): for each level the one that was saved last."""
    found = (
        [path for pattern in patterns for path in sorted(folder.glob(pattern))]
        for patterns in (_POSTURES, _LOCOMOTION)
    )
    return [max(paths, key=lambda path: path.stat().st_mtime) for paths in found if paths]


def remarks(folder: Path, taken: Sequence[Path]) -> list[Phrase]:
    """Say what a contestant may not expect of the gait files taken from a folder."""
    said = [
        say("play.no-workbook", file=path.name) for path in sorted(folder.glob("LocoTra*.xlsx"))
    ]
    match taken:
        case [postures, sequences] if sequences.stat().st_mtime < postures.stat().st_mtime:
            said.append(
                say("play.older-sequences", postures=postures.name, sequences=sequences.name)
            )
    return said


def _read(
    paths: Iterable[Path], notes: list[Phrase] | None
) -> tuple[SentFile | None, SentFile | None]:
    """The posture file and the locomotion file, a workbook as the text it stands for."""
    files: dict[type[_Table], SentFile] = {}
    mistakes: list[Mistake] = []
    for path in paths:
        try:
            noted: list[Phrase] = []
            table = read_gait_file(path, notes=noted)
        except FileRefused as refused:
            mistakes += refused.mistakes
            continue
        if type(table) in files:
            one = files[type(table)].name
            raise UserError(say("play.same-keys", one=one, other=path.name))
        data = path.read_bytes()
        name = text_of(path.name)
        if data.startswith(_ZIP):
            files[type(table)] = _text(name, table)
            if notes is not None:
                notes += noted  # the text has its own legend, so the court can't say it
        else:
            files[type(table)] = SentFile(name, data)
    if mistakes:
        raise FileRefused(mistakes)
    return files.get(PostureTable), files.get(LocomotionTable)


def _text(name: str, table: _Table) -> SentFile:
    text = write_gait(table, leg_labels(table.joints // JOINTS_PER_LEG))
    return SentFile(name, text)
