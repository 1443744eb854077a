"""Reads files of a folder that a stranger may have made.

A name in such a folder can be a link to another file of this machine, a device that never ends, or
a pipe to which nobody writes. So only regular files below the folder are read, and only up to a
greatest size.
"""

import os
from pathlib import Path
from stat import S_ISDIR, S_ISREG

from lacoc_shared.mistakes import UserError, text_of
from lacoc_shared.words import say

_FLAGS = (
    os.O_RDONLY
    | getattr(os, "O_BINARY", 0)
    | getattr(os, "O_CLOEXEC", 0)
    | getattr(os, "O_NOFOLLOW", 0)
    | getattr(os, "O_NONBLOCK", 0)  # to open a pipe does not wait for its writer
)


class Missing(UserError):
    """Raised when there is no file of this name in the folder."""


def is_regular(path: Path) -> bool:
    """Return whether a path is a regular file, and not a symbolic link."""
    try:
        return S_ISREG(path.lstat().st_mode)
    except (OSError, ValueError):
        return False


def read(folder: Path, *names: str, most_bytes: int) -> bytes:
    """Read a regular file below a folder.

    Args:
        folder: the folder; it may be a link, because the user named it.
        names: the path of the file below the folder: names of folders, then of the file.
        most_bytes: a larger file is not read.

    Raises:
        Missing: if there is no such file.
        UserError: if it is not a regular file, is too large, or can't be read; or if a folder on
            the way is a link.
    """
    path = _inside(folder, names[:-1]) / _plain(folder, names[-1])
    try:
        if not S_ISREG(path.lstat().st_mode):
            raise _refused(path)
        with os.fdopen(os.open(path, _FLAGS), "rb") as file:
            # It may have been exchanged since.
            if not S_ISREG(os.fstat(file.fileno()).st_mode):
                raise _refused(path)
            data = file.read(most_bytes + 1)
    except OSError as error:
        raise _unreadable(path, error) from None
    if len(data) > most_bytes:
        raise UserError(say("regular.too-large", file=text_of(path), most=most_bytes))
    return data


def names(folder: Path, *below: str) -> list[str]:
    """List the names of files and folders in a folder below `folder`, in order; none if missing.

    Raises:
        UserError: if that folder is a file or a link, or can't be read.
    """
    try:
        return sorted(os.listdir(_inside(folder, below)))
    except Missing:
        return []


def _inside(folder: Path, below: tuple[str, ...]) -> Path:
    """Return a folder below `folder`, after a check that none of the folders between is a link."""
    path = folder
    for name in below:
        path = path / _plain(folder, name)
        try:
            if not S_ISDIR(path.lstat().st_mode):
                raise UserError(say("regular.no-folder", folder=text_of(path)))
        except OSError as error:
            raise _unreadable(path, error) from None
    return path


def _plain(folder: Path, name: str) -> str:
    if name in ("", ".", "..") or Path(name).name != name or "\0" in name:
        raise UserError(say("regular.bad-name", folder=text_of(folder), name=text_of(name)))
    return name


def _refused(path: Path) -> UserError:
    return UserError(say("regular.no-file", file=text_of(path)))


def _unreadable(path: Path, error: OSError) -> UserError:
    kind = Missing if isinstance(error, FileNotFoundError) else UserError
    why = error.strerror or str(error)
    return kind(say("command.cannot-read", path=text_of(path), why=why))
