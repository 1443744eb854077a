"""Entries: the files and the bot with which a team plays, kept unchanged under their hash."""

import ast
import hashlib
import shutil
import tempfile
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import msgspec

from lacoc_arenas import brains
from lacoc_arenas.arena import Arena
from lacoc_arenas.checked_bot import broken
from lacoc_robots.library import GAIT_NAMES, find_robot, sample_gait_files
from lacoc_robots.limits import Limits
from lacoc_robots.seat_files import SeatFiles, files_in, gaits_in, remarks, to_send
from lacoc_robots.stand_test import try_standing
from lacoc_server.contest.kept.team_picture import small_picture
from lacoc_server.match.entry import Entry, weigh_in
from lacoc_shared.command import regular
from lacoc_shared.command.replacing import sync_folder, write
from lacoc_shared.contest.file import ENTRY_HASH, PICTURE
from lacoc_shared.gait.tables import Level
from lacoc_shared.inputs import JoinSeat
from lacoc_shared.messages import SentFile
from lacoc_shared.mistakes import FileRefused, UserError, text_of
from lacoc_shared.words import Phrase, say

_ROBOT, _PROGRAM, _BOT = "robot.toml", "bot.py", "entry.json"
"""Names of the files of an entry besides the gait files."""
_MOST_BYTES = 1 << 22
"""Largest file of an entry that is read."""


class ContestEntry(msgspec.Struct, frozen=True, kw_only=True):
    """What a team plays with: its files and its bot."""

    robot: bytes
    postures: bytes | None
    locomotion: bytes | None
    bot: str = ""
    """Name of the bot that plays; "": none, so people play, or without a network the bot that
    steers teams without one."""
    program: bytes | None = None
    """Python source of the bot; None: the bot is installed."""
    picture: bytes | None = None
    """The team's picture, as `team_picture` makes it; None: it has none."""

    @property
    def hash(self) -> str:
        """Hash of the entry, hexadecimal; another file or bot gives another hash."""
        parts = msgspec.structs.asdict(self)
        if self.picture is None:
            del parts["picture"]  # entries were kept before there were pictures
        return hashlib.blake2b(msgspec.msgpack.encode(parts), digest_size=16).hexdigest()

    def join(self, seat: int, team: str) -> JoinSeat:
        """Return the request with which the team takes a seat, made from this entry."""
        postures, locomotion = (
            None if data is None else SentFile(name, data)
            for name, data in zip(GAIT_NAMES, (self.postures, self.locomotion), strict=True)
        )
        robot = SentFile(_ROBOT, self.robot)
        return JoinSeat(seat, team, robot, postures, locomotion, token_hash="")


@dataclass(frozen=True)
class HandedIn:
    """What a team hands in, before it is weighed in."""

    robot: SentFile
    gaits: SeatFiles
    """The gait files as text, under the names that the team gave them."""
    bot: str = ""
    program: bytes | None = None
    """Python source of the bot; None: the bot is installed."""
    picture: bytes | None = None
    wrong: FileRefused | None = None
    """The error with all mistakes in workbooks; None: there are no mistakes."""
    taken: tuple[str, ...] = ()
    """Names of the files that were taken from a folder."""
    made: bool = False
    """Whether the locomotion file (level B) was made from the postures, because the team has
    none."""
    notes: tuple[Phrase, ...] = ()
    """Remarks on the folder and on its workbook."""

    @property
    def entry(self) -> ContestEntry:
        """The entry as the contest keeps it once these files are weighed in."""
        return ContestEntry(
            robot=self.robot.data,
            postures=self.gaits.postures.data if self.gaits.postures else None,
            locomotion=self.gaits.locomotion.data if self.gaits.locomotion else None,
            bot=self.bot,
            program=self.program,
            picture=self.picture,
        )


def hand_in(files: SeatFiles, robot: str) -> HandedIn:
    """Turn a team's files into the form that is weighed in: workbooks become text, as for a court.

    If there is no locomotion file, level B is made from the postures, as on the page /play.

    Args:
        files: the files as the team has them, at least one of them a gait file.
        robot: the contest's robot, for a team that brings none: an installed one or a file.

    Raises:
        UserError: if the contest's robot can't be read.
    """
    notes: list[Phrase] = []
    gaits, wrong = to_send(files, None, notes)
    return HandedIn(
        files.robot or SentFile(_ROBOT, find_robot(robot)[1]),
        gaits,
        wrong=wrong,
        made=files.locomotion is None and gaits.locomotion is not None,
        notes=tuple(notes),
    )


def gather_entry(folder: Path | None, bot: str, robot: str) -> HandedIn:
    """Read the files that a team hands in.

    Args:
        folder: folder with gait files, a robot.toml if the robot is the team's own, and a picture
            if the team has one; None: the contest's robot with its sample gait. Of several gait
            files for a level the newest one is taken, as `lacoc play` does.
        bot: an installed bot's name, or a Python file; "": people play.
        robot: the contest's robot: an installed one or a file.

    Raises:
        UserError: if there is no such folder, it has no gait, or a file can't be read.
    """
    if folder is None:
        handed = hand_in(SeatFiles(None, *sample_gait_files(robot)), robot)
    else:
        handed = _of_folder(folder, robot)
    program = _read(Path(bot)) if bot.endswith(".py") else None
    name = bot if program is None else text_of(Path(bot).stem)
    return replace(handed, bot=name, program=program)


def _of_folder(folder: Path, robot: str) -> HandedIn:
    if not folder.is_dir():
        raise UserError(say("contest.no-folder", folder=str(folder)))
    files = files_in(folder)
    if files.postures is None and files.locomotion is None:
        raise UserError(say("contest.no-gait", folder=str(folder)))
    if (own := folder / _ROBOT).exists():
        files = files._replace(robot=SentFile(*find_robot(str(own))))
    handed = hand_in(files, robot)
    taken = tuple(file.name for file in files if file is not None)
    notes = (*remarks(folder, gaits_in(folder)), *handed.notes)
    picture = next((path for path in sorted(folder.glob("picture.*")) if path.is_file()), None)
    if picture is None:
        return replace(handed, taken=taken, notes=notes)
    small = small_picture(SentFile(picture.name, _read(picture)))
    return replace(handed, taken=(*taken, picture.name), notes=notes, picture=small)


def weigh(handed: HandedIn, games: Iterable[Arena], limits: Mapping[str, Any]) -> ContestEntry:
    """Check an entry: weigh in its files as a court does, let its robot stand, and check its bot.

    Args:
        handed: what the team hands in.
        games: the arenas in which the team will play.
        limits: the contest's limits for robots.

    Returns:
        The entry, to be kept.

    Raises:
        FileRefused: with every mistake of every file, or because the robot does not stand. A
            mistake has the name that the team gave the file.
        UserError: if its bot is not installed, or its program has a mistake.
    """
    for arena in games:
        levels = arena.match.open_levels
        fit = _weigh_in(handed, limits, levels)
        if falls := try_standing(fit.robot, fit.gait, levels, handed.robot.name):
            raise FileRefused(falls)
        if handed.bot and handed.program is None:
            brains.find(arena, handed.bot)
    if handed.wrong is not None:  # the contest has no game yet
        raise handed.wrong
    if handed.program is not None:
        _check_program(f"{handed.bot}.py", handed.program)
    return handed.entry


def _weigh_in(handed: HandedIn, limits: Mapping[str, Any], levels: Collection[Level]) -> Entry:
    """Weigh in the files for one arena.

    Raises:
        FileRefused: with every mistake of every file.
    """
    _, postures, locomotion = handed.gaits
    try:
        return weigh_in(handed.robot, postures, locomotion, Limits.of(limits), levels)
    except FileRefused as refused:
        if handed.wrong is None:
            raise
        books = {mistake.file for mistake in handed.wrong.mistakes}  # they came without contents
        others = [mistake for mistake in refused.mistakes if mistake.file not in books]
        raise FileRefused([*handed.wrong.mistakes, *others]) from None


def _check_program(name: str, source: bytes) -> None:
    """Check a bot's program without running it.

    Raises:
        UserError: if it is no Python, nothing in it has the name `bot`, or it imports a module
            that is not installed here.
    """
    try:
        tree = ast.parse(source, name)
        code = compile(tree, name, "exec", dont_inherit=True)
    except (SyntaxError, ValueError, RecursionError) as error:
        raise broken(name, error, name) from None
    if "bot" not in code.co_names:
        raise UserError(say("bot.no-function", path=name))
    for line, module in _imports(tree):
        if not _is_installed(module):
            raise UserError(say("bot.no-module", bot=name, place=f"{name}:{line}", module=module))


def _imports(node: ast.AST) -> Iterator[tuple[int, str]]:
    """Yield each import below a node: its line, and the package or module that it needs.

    Imports inside a `try` are left out, because the program can do without them.
    """
    match node:
        case ast.Try():
            return
        case ast.Import():
            for one in node.names:
                yield node.lineno, one.name.partition(".")[0]
        case ast.ImportFrom():
            package = (node.module or "").partition(".")[0]
            yield node.lineno, "." * node.level + package
    for child in ast.iter_child_nodes(node):
        yield from _imports(child)


def _is_installed(module: str) -> bool:
    """Return whether a module is installed here, without running its code."""
    if module.startswith("."):  # a bot is in no package
        return False
    try:
        return find_spec(module) is not None
    except ValueError:  # a module without a specification, such as __main__
        return True


class EntryFolder:
    """The folder of all weighed-in entries; each has a folder of its own, named by its hash.

    Args:
        path: the folder; it is made when the first entry comes.
    """

    def __init__(self, path: Path) -> None:
        self.path = path

    def save(self, entry: ContestEntry) -> str:
        """Keep an entry; return its hash. An entry that the folder has is not written again.

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
                write(part / name, data, lasting=True)  # as the fact that names the entry
            part.rename(place)  # so that a folder with this name is always whole
            sync_folder(self.path)
        except OSError as error:
            if part is not None:
                shutil.rmtree(part, ignore_errors=True)
            if not place.exists():  # another program may just have written the same entry
                why = error.strerror or str(error)
                raise UserError(say("command.cannot-write", path=str(place), why=why)) from None
        return entry.hash

    def load(self, entry_hash: str) -> ContestEntry:
        """Read an entry.

        Raises:
            UserError: if the folder lacks it, or if its files have changed since they were saved.
        """
        place = self.path / entry_hash
        if not ENTRY_HASH.fullmatch(entry_hash):  # it may come from facts that a stranger wrote
            why = say("contest.no-hash")
            raise UserError(say("contest.no-entry", folder=str(place), why=why)) from None
        try:
            bot_file = self._read(entry_hash, _BOT)
            bot = msgspec.json.decode(bot_file, type=dict[str, str])["bot"]
            robot = self._read(entry_hash, _ROBOT)
            rest = [
                self._read_if_there(entry_hash, name) for name in (*GAIT_NAMES, _PROGRAM, PICTURE)
            ]
        except (UserError, KeyError, msgspec.MsgspecError, UnicodeDecodeError) as error:
            told = error.phrase if isinstance(error, UserError) else str(error)
            raise UserError(say("contest.no-entry", folder=str(place), why=told)) from None
        postures, locomotion, program, picture = rest
        entry = ContestEntry(
            robot=robot,
            postures=postures,
            locomotion=locomotion,
            bot=bot,
            program=program,
            picture=picture,
        )
        if entry.hash != entry_hash or bot_file != _files(entry)[_BOT]:
            raise UserError(say("contest.entry-changed", folder=str(place)))
        return entry

    def others(self, entry_hash: str) -> list[str]:
        """Return the names in an entry's folder that are not among the entry's files.

        Raises:
            UserError: if the folder can't be read, or files of the entry are missing or changed.
        """
        known = _files(self.load(entry_hash))
        return [name for name in regular.names(self.path, entry_hash) if name not in known]

    def _read(self, entry_hash: str, name: str) -> bytes:
        """Read a file of an entry; follow no symbolic link, because a stranger may have made it."""
        folder = self.path.parent  # so that a link in place of the folder of entries is found
        return regular.read(folder, self.path.name, entry_hash, name, most_bytes=_MOST_BYTES)

    def _read_if_there(self, entry_hash: str, name: str) -> bytes | None:
        try:
            return self._read(entry_hash, name)
        except regular.Missing:
            return None


def _files(entry: ContestEntry) -> dict[str, bytes]:
    files = {
        _BOT: msgspec.json.encode({"bot": entry.bot}),
        _ROBOT: entry.robot,
        GAIT_NAMES[0]: entry.postures,
        GAIT_NAMES[1]: entry.locomotion,
        _PROGRAM: entry.program,
        PICTURE: entry.picture,
    }
    return {name: data for name, data in files.items() if data is not None}


def _read(path: Path) -> bytes:
    try:
        return path.expanduser().read_bytes()
    except OSError as error:
        why = error.strerror or str(error)
        raise UserError(say("command.cannot-read", path=str(path), why=why)) from None
