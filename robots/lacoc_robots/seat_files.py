"""A contestant's robot and gait files, read from their folders (rules 2)."""

import math
import re
from collections.abc import Iterable, Iterator, Sequence
from fnmatch import fnmatchcase
from pathlib import Path
from typing import NamedTuple

from lacoc_robots.library import GAIT_NAMES, find_robot, read_content, sample_gait_files
from lacoc_shared.gait.cells import leg_labels
from lacoc_shared.gait.joining import join_postures, sample_sequences
from lacoc_shared.gait.tables import JOINTS_PER_LEG, LocomotionTable, PostureTable
from lacoc_shared.gait.text import read_gait, write_gait
from lacoc_shared.gait.workbook.file import is_workbook, read_gait_file, read_workbook
from lacoc_shared.messages import SentFile
from lacoc_shared.mistakes import FileRefused, Mistake, UserError, text_of
from lacoc_shared.words import Phrase, say

_POSTURES = ("Loco-data.txt", "Loco-data.xlsx", "Loco-data-6legs.txt")
_LOCOMOTION = ("LocoTra-data.txt", "LocoTra-data*.txt")

USUAL_NAMES = ("robot.toml", *GAIT_NAMES)
"""Usual names of the files of a join in a folder."""

_LIKE_GAIT = re.compile(r"loco(tra)?-.*\.(txt|xlsx)", re.IGNORECASE)

_ZIP = b"PK\x03\x04"  # first bytes of a workbook

_Table = PostureTable | LocomotionTable


class SeatFiles(NamedTuple):
    """The robot and gait files with which a seat is taken.

    Where a file is None, the contest's robot or its sample gait is used.
    """

    robot: SentFile | None = None
    postures: SentFile | None = None
    locomotion: SentFile | None = None


def gather(
    robot: str | None, gaits: Sequence[Path], notes: list[Phrase] | None = None
) -> SeatFiles:
    """Read the robot and gait files of a contestant.

    Args:
        robot: an installed robot, a folder or a robot file; None: the contest's robot.
        gaits: gait files, at most one for each level; none: the gait files beside the robot file.
        notes: receives phrases about things in a workbook that are legal, but probably not meant.
            For text files the court sends such phrases.

    Raises:
        FileRefused: with every mistake of every gait file.
        UserError: if a file can't be read, or two are for the same level.
    """
    robot_file = SentFile(*find_robot(robot)) if robot else None
    if gaits:
        return SeatFiles(robot_file, *_read(gaits, notes))
    return SeatFiles(robot_file, *(sample_gait_files(robot) if robot else (None, None)))


def as_text(files: SeatFiles, notes: list[Phrase] | None = None) -> SeatFiles:
    """Turn gait files that are workbooks into text, which is what a court reads.

    Each file keeps its name, so that mistakes name the contestant's own file.

    Args:
        files: the files of a join.
        notes: receives phrases about things in a workbook that are legal, but probably not meant.

    Raises:
        FileRefused: with every mistake of every workbook.
    """
    mistakes: list[Mistake] = []
    texts: list[SentFile | None] = []
    for file in (files.postures, files.locomotion):
        if file is None or not is_workbook(file.data):
            texts.append(file)
            continue
        try:
            texts.append(_text(file.name, read_workbook(file.data, file.name, notes=notes)))
        except FileRefused as refused:
            mistakes += refused.mistakes
    if mistakes:
        raise FileRefused(mistakes)
    return SeatFiles(files.robot, *texts)


def to_send(
    files: SeatFiles, sequences: Sequence[Sequence[int]] | None, notes: list[Phrase]
) -> tuple[SeatFiles, FileRefused | None]:
    """Turn the files that a team has into files that a court reads.

    A workbook with mistakes is sent without its content, so that the court can report the mistakes
    of the other files too. The court also says whether it needs the files at all: in a match that
    has begun, a seat may be taken again without files.

    Args:
        files: the files of a join.
        sequences: the sequences of level B; see `with_level_b`.
        notes: receives phrases about things in a workbook that are legal, but probably not meant.

    Returns:
        The files for the court, and the mistakes of the workbooks; None: they have no mistakes.

    Raises:
        UserError: if a sequence is empty, or uses a posture that does not exist.
    """
    try:
        return with_level_b(as_text(files, notes), sequences), None
    except FileRefused as refused:
        return SeatFiles(*map(_emptied, files)), refused


def _emptied(file: SentFile | None) -> SentFile | None:
    return SentFile(file.name, _ZIP) if file is not None and is_workbook(file.data) else file


def with_level_b(files: SeatFiles, sequences: Sequence[Sequence[int]] | None = None) -> SeatFiles:
    """Add a locomotion file (level B), made from the postures, if there is none.

    Args:
        files: files as text. A posture file with mistakes stays as it is: the court reports them,
            because it has the robot.
        sequences: for each digit key from 0 on, the digits of its postures in order; None: as in
            the sample gait, if the file has all those postures.

    Raises:
        UserError: if a sequence is empty, or uses a posture that does not exist.
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
    """Return the newest gait file of each level in a folder, found by name (workshop 4-1)."""
    return [path for path in _newest_in(folder) if path is not None]


def files_in(folder: Path) -> SeatFiles:
    """Read the newest gait file of each level in a folder, unchanged; its name decides its level.

    Raises:
        UserError: if a file can't be read.
    """
    postures, locomotion = (
        None if path is None else SentFile(text_of(path.name), read_content(path))
        for path in _newest_in(folder)
    )
    return SeatFiles(None, postures, locomotion)


def _newest_in(folder: Path) -> Iterator[Path | None]:
    """Yield the newest gait file of level A, then that of level B.

    None for a level without a file.
    """
    there = _gaits_there(folder)
    for patterns in (_POSTURES, _LOCOMOTION):
        paths = [path for pattern in patterns for path in there if _is_named(path, pattern)]
        yield max(filter(Path.exists, paths), key=_changed_s, default=None)


def _gaits_there(folder: Path) -> list[Path]:
    """Return the files of a folder whose names look like those of gait files."""
    return sorted(path for path in folder.glob("*") if _LIKE_GAIT.fullmatch(path.name))


def _is_usual(path: Path) -> bool:
    return any(_is_named(path, pattern) for pattern in (*_POSTURES, *_LOCOMOTION))


def _is_named(path: Path, pattern: str) -> bool:
    """Return whether a file has a name of this pattern; capital letters do not matter."""
    return fnmatchcase(path.name.lower(), pattern.lower())


def _changed_s(path: Path) -> float:
    """Return when a file was changed [s]; for a file that has just vanished, long ago."""
    try:
        return path.stat().st_mtime
    except OSError:
        return -math.inf


def remarks(folder: Path, taken: Sequence[Path]) -> list[Phrase]:
    """Return warnings about gait files in a folder that are not read, or are perhaps too old.

    There is a warning for each LocoTra workbook, because it is not read, for a locomotion file that
    is older than the posture file, and for the newest file if its name is not a usual one.

    Args:
        folder: the folder.
        taken: the gait files that are read, as `gaits_in` returns them.
    """
    there = _gaits_there(folder)
    books = [path for path in there if _is_named(path, "LocoTra*.xlsx")]
    said = [say("play.no-workbook", file=path.name) for path in books]
    others = [path for path in there if path not in books and not _is_usual(path)]
    newest = max(others, key=_changed_s, default=None)
    if newest is not None and _changed_s(newest) > max(map(_changed_s, taken), default=-math.inf):
        said.append(say("play.other-name", file=text_of(newest.name)))
    match taken:
        case [postures, sequences] if sequences.stat().st_mtime < postures.stat().st_mtime:
            said.append(
                say("play.older-sequences", postures=postures.name, sequences=sequences.name)
            )
    return said


def _read(
    paths: Iterable[Path], notes: list[Phrase] | None
) -> tuple[SentFile | None, SentFile | None]:
    """Return the posture file and the locomotion file, with workbooks turned into text."""
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
        if is_workbook(data):
            files[type(table)] = _text(name, table)
            if notes is not None:
                notes += noted  # the text has a new legend, so the court can't find it
        else:
            files[type(table)] = SentFile(name, data)
    if mistakes:
        raise FileRefused(mistakes)
    return files.get(PostureTable), files.get(LocomotionTable)


def _text(name: str, table: _Table) -> SentFile:
    text = write_gait(table, leg_labels(table.joints // JOINTS_PER_LEG))
    return SentFile(name, text)
