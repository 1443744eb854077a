"""The gait and robot files of a folder: list them, read them, save them, see what changed.

A file's version is a hash of its content. A page that saves a file names the version that it has
read. So a change that another program or page made meanwhile is not overwritten without a question.
"""

import hashlib
import os
import re
import threading
from pathlib import Path
from typing import Literal, NamedTuple

import msgspec

from lacoc_client.workshop.design.files import FileContent, file_bytes, read_file
from lacoc_client.workshop.design.saving.atomic import replace_file
from lacoc_client.workshop.design.table import FileTable
from lacoc_shared.gait.workbook.content import MAX_BYTES
from lacoc_shared.mistakes import FileRefused, Mistake, UserError
from lacoc_shared.words import Phrase, say

Slot = Literal["robot", "postures", "locomotion"]

MOST_FILES = 100
"""Most files of a folder that are listed."""
ABSENT = ""
"""Version of a file that does not exist."""

_GAIT = re.compile(r"loco.*\.(txt|xlsx)", re.IGNORECASE)
_SEQUENCES = re.compile(r"locotra", re.IGNORECASE)
_ROBOT = re.compile(r".*\.toml", re.IGNORECASE)
_BODY = re.compile(rb"^\s*\[body\]", re.MULTILINE)  # other TOML files are no robots
_FORBIDDEN = re.compile(r'[/\\:*?"<>|\x00-\x1f]')  # on one system or another
_LONGEST_NAME = 100


class FolderFile(msgspec.Struct, frozen=True):
    """A gait or robot file in the folder, with its version."""

    name: str
    slot: Slot
    version: str


class Read(msgspec.Struct, frozen=True, kw_only=True):
    """What was read from a file: a table, or the text of a robot file."""

    table: FileTable | None = None
    robot: str | None = None
    version: str
    notes: tuple[Phrase, ...] = ()
    mistakes: tuple[Mistake, ...] = ()
    """In a `Conflict`: why the file could not be read as a table."""


class SavedFile(msgspec.Struct, frozen=True):
    """The answer to a request to save, if the file was written."""

    version: str


class Conflict(msgspec.Struct, frozen=True):
    """The answer to a request to save, if the file had changed since it was read: not saved."""

    conflict: Read
    """The present content of the file."""


class _KnownFile(NamedTuple):
    modified_ns: int
    size: int
    file: FolderFile | None


class Folder:
    """The gait and robot files of a folder; may be used from any thread.

    Args:
        path: the folder.

    Raises:
        UserError: if there is no such folder.
    """

    def __init__(self, path: Path) -> None:
        if not path.is_dir():
            raise UserError(say("design.no-folder", path=str(path)))
        self.path = path.resolve()
        self._lock = threading.Lock()
        self._known: dict[str, _KnownFile] = {}
        self._changed: set[str] = set()
        self.files: tuple[FolderFile, ...] = ()
        """The files as they were last seen, sorted by name."""
        self.look()

    def look(self) -> tuple[str, ...]:
        """List the folder's files again.

        Return the names of files that were changed, added or removed since the last call.
        """
        with self._lock:
            self._look()
            changed, self._changed = self._changed, set()
            return tuple(sorted(changed))

    def read(self, name: str) -> Read:
        """Read a gait or robot file of the folder.

        Raises:
            FileRefused: with every mistake of a gait file.
            UserError: if it can't be read.
        """
        data = self._data(self._path(name))
        if data is None:
            raise UserError(say("design.no-file", name=name))
        return _as_read(name, data, read_file(name, data))

    def save(
        self, name: str, content: FileTable | str, version: str, force: bool
    ) -> SavedFile | Conflict:
        """Save a table or the text of a robot file; if this fails, the old file stays as it is.

        Args:
            name: name of the file; the suffix of a new file decides its format.
            content: the table, or the robot file's text.
            version: version of the file that the content was made from; `ABSENT`: a new file.
            force: save even if the file has changed since that version. Remarks and sheets beside
                a table of postures stay as they are in the file now.

        Raises:
            FileRefused: with every mistake of the table, or of the workbook to change.
            UserError: if the name is not allowed, or the file can't be read or written.
        """
        with self._lock:
            path = self._path(name)
            while True:
                before = self._data(path)
                if not force and version_of(before) != version:
                    return Conflict(_conflicting(name, before))
                data = file_bytes(name, content, before)
                if self._data(path) == before:  # else another program saved just now: begin again
                    break
            if data != before:
                replace_file(path, data)
            self._look()
            return SavedFile(version_of(data))

    def _look(self) -> None:
        now: dict[str, _KnownFile] = {}
        for name, modified_ns, size in _listed(self.path):
            known = self._known.get(name)
            if known is None or known[:2] != (modified_ns, size):
                try:
                    data = self._data(self.path / name)
                except UserError:  # it is locked by another program: look again the next time
                    now |= {name: known} if known is not None else {}
                    continue
                known = _KnownFile(modified_ns, size, None if data is None else _file(name, data))
            now[name] = known
        self._known = now
        files = [known.file for known in now.values() if known.file is not None]
        before = self.files
        self.files = tuple(sorted(files, key=lambda file: file.name.casefold()))[:MOST_FILES]
        self._changed |= {file.name for file in {*before} ^ {*self.files}}

    def _path(self, name: str) -> Path:
        fits = _GAIT.fullmatch(name) or _ROBOT.fullmatch(name)
        if not fits or name.startswith(".") or len(name) > _LONGEST_NAME or _FORBIDDEN.search(name):
            raise UserError(say("design.bad-name", name=name))
        return self.path / name

    def _data(self, path: Path) -> bytes | None:
        """Read the bytes of a file; return None if it does not exist."""
        try:
            with path.open("rb") as file:
                return file.read(MAX_BYTES + 1)
        except FileNotFoundError:
            return None
        except OSError as error:
            raise UserError(
                say("design.cannot-read", name=path.name, why=error.strerror or str(error))
            ) from None


def version_of(data: bytes | None) -> str:
    """Return the version of a file: a hash of its content `data`; None: there is no file."""
    return ABSENT if data is None else hashlib.blake2b(data, digest_size=8).hexdigest()


def _listed(folder: Path) -> list[tuple[str, int, int]]:
    """List the files that may be gaits or robots: name, time of change [ns] and size [bytes]."""
    found = []
    try:
        with os.scandir(folder) as entries:
            for entry in entries:
                if not (_GAIT.fullmatch(entry.name) or _ROBOT.fullmatch(entry.name)):
                    continue
                try:
                    entry.name.encode()  # a name that is not text can't be sent to a page
                    if entry.is_file():
                        stat = entry.stat()
                        found.append((entry.name, stat.st_mtime_ns, stat.st_size))
                except (OSError, UnicodeEncodeError):
                    continue
    except OSError:  # the folder was removed, or its drive unplugged
        return []
    return found


def _file(name: str, data: bytes) -> FolderFile | None:
    if _ROBOT.fullmatch(name):
        slot: Slot | None = "robot" if _BODY.search(data) else None
    else:
        slot = "locomotion" if _SEQUENCES.match(name) else "postures"
    return slot and FolderFile(name, slot, version_of(data))


def _as_read(name: str, data: bytes, read: FileContent) -> Read:
    return Read(table=read.table, robot=read.robot, version=version_of(data), notes=read.notes)


def _conflicting(name: str, data: bytes | None) -> Read:
    """Read a file that another program has changed; return a gait's mistakes, don't raise them."""
    if data is None:
        return Read(version=ABSENT)
    try:
        return _as_read(name, data, read_file(name, data))
    except FileRefused as refused:
        return Read(version=version_of(data), mistakes=tuple(refused.mistakes))
    except UserError:  # it is no text any more
        return Read(version=version_of(data))
