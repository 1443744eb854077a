"""A seat's entry: its robot and gait files, weighed in together (rules 1 and 2)."""

from collections.abc import Collection
from dataclasses import dataclass
from functools import lru_cache

import msgspec

from lacoc_robots.robot_file import Limits, RobotSpec, read_robot
from lacoc_robots.standing import too_large_standing
from lacoc_shared.gait.tables import Gait, Level, LocomotionTable, PostureTable
from lacoc_shared.gait.text import read_gait
from lacoc_shared.inputs import JoinSeat
from lacoc_shared.messages import Join, SentFile
from lacoc_shared.mistakes import FileRefused, Mistake
from lacoc_shared.words import Phrase, say

DEFAULT_LIMITS = Limits()

_TABLES: dict[Level, tuple[type[PostureTable] | type[LocomotionTable], Phrase]] = {
    Level.POSTURE: (PostureTable, say("gait.loco-data")),
    Level.LOCOMOTION: (LocomotionTable, say("gait.locotra-data")),
}


@dataclass(frozen=True)
class Entry:
    """A robot with its gait, weighed in for a match."""

    robot: RobotSpec
    gait: Gait
    notes: tuple[Phrase, ...] = ()
    """Remarks on things in the gait files that are legal, but probably not meant."""


def weigh_in(
    robot: SentFile,
    postures: SentFile | None,
    locomotion: SentFile | None,
    limits: Limits = DEFAULT_LIMITS,
    levels: Collection[Level] = tuple(Level),
) -> Entry:
    """Read and check a contestant's files; whether the robot stands is not tried here.

    The result is cached, because a court reads the same files twice: at its door, and when the
    match gives the team its seat. A replay reads them from the record in the same way.

    Args:
        robot: the robot file.
        postures: a Loco-data file, or None.
        locomotion: a LocoTra-data file, or None.
        limits: limits of the contest.
        levels: open levels of control; a gait must have keys at one of them or more.

    Raises:
        FileRefused: with the mistakes of all files. What needs several files (such as whether a
            robot is too large as it stands) is checked only if the others have no mistake.
    """
    return _weigh_in(robot, postures, locomotion, limits, frozenset(levels))


@lru_cache(maxsize=16)
def _weigh_in(
    robot: SentFile,
    postures: SentFile | None,
    locomotion: SentFile | None,
    limits: Limits,
    levels: frozenset[Level],
) -> Entry:
    mistakes: list[Mistake] = []
    spec = None
    try:
        spec = read_robot(robot.data, robot.name, limits)
    except FileRefused as refused:
        mistakes += refused.mistakes
    notes: list[Phrase] = []
    gait = read_gaits(postures, locomotion, spec, mistakes, notes)
    if not (mistakes or any(gait.keys(level) for level in levels)):
        expected = say("robot.any-of", options=[_TABLES[level][1] for level in sorted(levels)])
        found = say("gait.none-for-arena")
        mistakes.append(Mistake(file="gait files", found=found, expected=expected))
    if spec is not None and not mistakes:
        mistakes += too_large_standing(spec, gait, levels, limits, robot.name)
    if spec is None or mistakes:
        raise FileRefused(mistakes)
    return Entry(spec, gait, tuple(notes))


def read_gaits(
    postures: SentFile | None,
    locomotion: SentFile | None,
    robot: RobotSpec | None,
    mistakes: list[Mistake],
    notes: list[Phrase],
) -> Gait:
    """Read gait files and check that they fit a robot, and that each is of its own kind.

    Args:
        postures: a Loco-data file, or None.
        locomotion: a LocoTra-data file, or None.
        robot: the robot; None: its file was refused, and only the form of the files is checked.
        mistakes: receives the mistakes of the files; the gait has no table of a file with mistakes.
        notes: receives remarks on things that are legal, but probably not meant.
    """
    tables: list[PostureTable | LocomotionTable] = []
    for file, (kind, what) in zip((postures, locomotion), _TABLES.values(), strict=True):
        if file is None:
            continue
        try:
            table = _read_gait(file, robot, notes)
        except FileRefused as refused:
            mistakes += refused.mistakes
            continue
        if isinstance(table, kind):
            tables.append(table)
        else:
            mistakes.append(Mistake(file=file.name, found=say("gait.other-kind"), expected=what))
    return Gait(
        next((t for t in tables if isinstance(t, PostureTable)), None),
        next((t for t in tables if isinstance(t, LocomotionTable)), None),
    )


@dataclass(frozen=True)
class JoinCheck:
    """Completes the files in a request to join (`Join`), and checks them all.

    A request without any file gets the files of its seat if its team has that seat, else the
    contest's robot with its sample gait. If there are gait files but no robot file, the robot is
    the contest's.
    A gait file is never added to files that a team sent.
    """

    robot: SentFile
    """The contest's robot."""
    postures: SentFile | None
    locomotion: SentFile | None
    """Sample gait of the contest's robot."""
    limits: Limits
    levels: Collection[Level]
    """Levels of control that the arena opens."""

    def __call__(self, join: Join, held: JoinSeat | None = None) -> tuple[Join, tuple[Phrase, ...]]:
        """Complete the files in a request to join, and check them all.

        Args:
            join: the request as it arrived.
            held: the request with which the seat was taken; None: nobody has the seat.

        Returns:
            The request with the files that are used. If it brought none, also a note about them.

        Raises:
            FileRefused: as `weigh_in` does.
        """
        sample = (self.robot, self.postures, self.locomotion)
        files = (join.robot, join.postures, join.locomotion)
        notes: tuple[Phrase, ...] = ()
        if not any(files):
            files = sample
            if held is not None and held.team == join.name:
                files = (held.robot, held.postures, held.locomotion)
            names = [file.name for file in files if file is not None]
            kept = say("note.files-kept", files=names)
            notes = (say("note.files-sample") if files == sample else kept,)
        robot, postures, locomotion = files
        robot = robot or self.robot
        weigh_in(robot, postures, locomotion, self.limits, self.levels)
        whole = msgspec.structs.replace(join, robot=robot, postures=postures, locomotion=locomotion)
        return whole, notes


def _read_gait(
    file: SentFile, robot: RobotSpec | None, notes: list[Phrase]
) -> PostureTable | LocomotionTable:
    """Read a gait file and check that it fits a robot; add remarks on it to `notes`.

    Without a robot, because the robot's file was refused, only the form of the file is checked.
    """
    if robot is None:
        return read_gait(file.data, file.name)
    labels, ranges_deg = robot.labels, robot.ranges_deg
    return read_gait(file.data, file.name, legs=labels, range_deg=ranges_deg, notes=notes)
