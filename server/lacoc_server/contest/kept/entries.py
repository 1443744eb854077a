"""Entries: the files and the bot with which a team plays, kept unchanged under their hash."""

import hashlib
import re
import shutil
import tempfile
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import msgspec

from lacoc_arenas import brains
from lacoc_arenas.arena import Arena
from lacoc_arenas.checked_bot import broken
from lacoc_robots.library import GAIT_NAMES, find_robot, gait_files_in, sample_gait_files
from lacoc_robots.limits import Limits
from lacoc_robots.stand_test import try_standing
from lacoc_server.match.entry import weigh_in
from lacoc_shared.inputs import JoinSeat
from lacoc_shared.messages import SentFile
from lacoc_shared.mistakes import FileRefused, UserError, text_of
from lacoc_shared.words import say

_ROBOT, _PROGRAM, _BOT = "robot.toml", "bot.py", "entry.json"
"""Names of the files of an entry besides the gait files."""
_HASH = re.compile("[0-9a-f]{32}")


class Entry(msgspec.Struct, frozen=True, kw_only=True):
    """What a team plays with: its files and its bot."""

    robot: bytes
    postures: bytes | None
    locomotion: bytes | None
    bot: str = ""
    """Name of the bot that plays; "": people play."""
    program: bytes | None = None
    """Python source of the bot; None: the bot is installed."""

    @property
    def hash(self) -> str:
        """Hash of the entry, hexadecimal; another file or bot gives another hash."""
        return hashlib.blake2b(msgspec.msgpack.encode(self), digest_size=16).hexdigest()

    def join(self, seat: int, team: str) -> JoinSeat:
        """Return the join with which the team takes a seat."""
        postures, locomotion = (
            None if data is None else SentFile(name, data)
            for name, data in zip(GAIT_NAMES, (self.postures, self.locomotion), strict=True)
        )
        robot = SentFile(_ROBOT, self.robot)
        return JoinSeat(seat, team, robot, postures, locomotion, token_hash="")


def gather(folder: Path | None, bot: str, robot: str) -> Entry:
    """Read the files that a team hands in.

    Args:
        folder: folder with gait files, and a robot.toml if the robot is the team's own; None: the
            contest's robot with its sample gait.
        bot: an installed bot's name, or a Python file; "": people play.
        robot: the contest's robot: an installed one or a file.

    Raises:
        UserError: if the folder has no gait, or a file can't be read.
    """
    if folder is not None and not folder.is_dir():
        raise UserError(say("simulate.no-folder", folder=str(folder)))
    own = None if folder is None else folder / _ROBOT
    _, model = find_robot(str(own) if own is not None and own.exists() else robot)
    postures, locomotion = sample_gait_files(robot) if folder is None else gait_files_in(folder)
    if postures is None and locomotion is None:
        wanted = " or ".join(GAIT_NAMES)
        raise UserError(say("simulate.no-gait", wanted=wanted, folder=str(folder)))
    program = _read(Path(bot)) if bot.endswith(".py") else None
    return Entry(
        robot=model,
        postures=None if postures is None else postures.data,
        locomotion=None if locomotion is None else locomotion.data,
        bot=bot if program is None else text_of(Path(bot).stem),
        program=program,
    )


def weigh(entry: Entry, games: Iterable[Arena], limits: Mapping[str, Any]) -> None:
    """Check an entry: weigh in its files as a court does, let its robot stand, and check its bot.

    Args:
        entry: the entry.
        games: the arenas in which the team will play.
        limits: the contest's limits for robots.

    Raises:
        FileRefused: with every mistake of every file, or because the robot does not stand.
        UserError: if its bot is not installed, or its program has a mistake.
    """
    for arena in games:
        levels = arena.match.open_levels
        join = entry.join(0, "")
        fit = weigh_in(join.robot, join.postures, join.locomotion, Limits.of(limits), levels)
        if falls := try_standing(fit.robot, fit.gait, levels, join.robot.name):
            raise FileRefused(falls)
        if entry.bot and entry.program is None:
            brains.find(arena, entry.bot)
    if entry.program is not None:
        _check_program(f"{entry.bot}.py", entry.program)


def _check_program(name: str, source: bytes) -> None:
    """Check a bot's program without running it.

    Raises:
        UserError: if it is no Python, or nothing in it has the name `bot`.
    """
    try:
        code = compile(source, name, "exec", dont_inherit=True)
    except (SyntaxError, ValueError) as error:
        raise broken(name, error, name) from None
    if "bot" not in code.co_names:
        raise UserError(say("bot.no-function", path=name))


class EntryFolder:
    """The folder of all frozen entries; each has a folder of its own, named by its hash.

    Args:
        path: the folder; it is made when the first entry comes.
    """

    def __init__(self, path: Path) -> None:
        self.path = path

    def save(self, entry: Entry) -> str:
        """Keep an entry; return its hash. An entry that is there already is not written again.

        Raises:
            UserError: if it can't be written.
        """
        place = self.path / entry.hash
        if place.exists():
            return entry.hash
        part = None
        try:
            self.path.mkdir(parents=True, exist_ok=True)
            part = Path(tempfile.mkdtemp(dir=self.path, prefix="part-"))
            for name, data in _files(entry).items():
                (part / name).write_bytes(data)
            part.rename(place)  # so that a folder with this name is always whole
        except OSError as error:
            if part is not None:
                shutil.rmtree(part, ignore_errors=True)
            if not place.exists():  # another program may just have written the same entry
                why = error.strerror or str(error)
                raise UserError(say("command.cannot-write", path=str(place), why=why)) from None
        return entry.hash

    def load(self, entry_hash: str) -> Entry:
        """Read an entry.

        Raises:
            UserError: if it is not there, or if its files are not those that were frozen.
        """
        place = self.path / entry_hash
        if not _HASH.fullmatch(entry_hash):  # it may come from facts that a stranger wrote
            why = say("contest.no-hash")
            raise UserError(say("contest.no-entry", folder=str(place), why=why)) from None
        try:
            bot_file = (place / _BOT).read_bytes()
            bot = msgspec.json.decode(bot_file, type=dict[str, str])["bot"]
            robot = (place / _ROBOT).read_bytes()
            rest = [_read_if_there(place / name) for name in (*GAIT_NAMES, _PROGRAM)]
        except (OSError, KeyError, msgspec.MsgspecError) as error:
            raise UserError(say("contest.no-entry", folder=str(place), why=str(error))) from None
        entry = Entry(robot=robot, postures=rest[0], locomotion=rest[1], bot=bot, program=rest[2])
        if entry.hash != entry_hash or bot_file != _files(entry)[_BOT]:
            raise UserError(say("contest.entry-changed", folder=str(place)))
        return entry


def _files(entry: Entry) -> dict[str, bytes]:
    files = {
        _BOT: msgspec.json.encode({"bot": entry.bot}),
        _ROBOT: entry.robot,
        GAIT_NAMES[0]: entry.postures,
        GAIT_NAMES[1]: entry.locomotion,
        _PROGRAM: entry.program,
    }
    return {name: data for name, data in files.items() if data is not None}


def _read(path: Path) -> bytes:
    try:
        return path.expanduser().read_bytes()
    except OSError as error:
        why = error.strerror or str(error)
        raise UserError(say("command.cannot-read", path=str(path), why=why)) from None


def _read_if_there(path: Path) -> bytes | None:
    return path.read_bytes() if path.exists() else None
