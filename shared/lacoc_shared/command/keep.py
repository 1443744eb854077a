"""Makes folders, and writes files without losing older ones of the same name."""

import contextlib
import itertools
import os
from io import FileIO
from pathlib import Path

from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say


def make_folder(folder: Path) -> None:
    """Make a folder, and those above it, if they do not exist.

    Raises:
        UserError: if a folder can't be made, for example because a file has its name.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        why = error.strerror or str(error)
        raise UserError(say("command.cannot-make-folder", folder=str(folder), why=why)) from None


def save(path: Path, data: bytes) -> Path | None:
    """Write a file; an older one of the same name is kept under a numbered name.

    Returns:
        Path of the older file ("Loco-data.1.txt"), or None if there was none.

    Raises:
        UserError: if the file can't be written; then the older one has its name again.
    """
    kept = None
    while True:
        kept = make_room(path) or kept
        try:
            file = path.open("xb", buffering=0)
        except FileExistsError:
            continue  # another program just made it: that file is kept too
        except OSError as error:
            _put_back(kept, path)
            raise _cannot_write(path, error) from error
        try:
            with file:
                _write(file, data)
        except OSError as error:
            path.unlink(missing_ok=True)  # a part of a file would be taken for the whole
            _put_back(kept, path)
            raise _cannot_write(path, error) from error
        return kept


def _write(file: FileIO, data: bytes) -> None:
    left = memoryview(data)
    while left:
        left = left[file.write(left) :]


def _put_back(kept: Path | None, path: Path) -> None:
    """Give an older file its own name again, if that is possible."""
    if kept is not None:
        with contextlib.suppress(OSError):
            os.replace(kept, path)


def make_room(path: Path) -> Path | None:
    """Rename a file: add the first free number, so that its name is free for a new file.

    Returns:
        New path of the file ("Loco-data.1.txt"), or None if there is no such file.

    Raises:
        UserError: if it can't be renamed, or is a folder.
    """
    if path.is_dir():
        raise UserError(say("command.folder-has-name", path=str(path)))
    if not os.path.lexists(path):
        return None
    try:
        kept = _claimed(path)
        try:
            os.replace(path, kept)
        except OSError:
            kept.unlink()
            raise
    except FileNotFoundError:
        return None  # another program renamed it first
    except OSError as error:
        raise _cannot_write(path, error) from error
    return kept


def _claimed(path: Path) -> Path:
    """Make an empty file whose name has the first free number; return its path.

    While this file is there, no other program can take the number.
    """
    for number in itertools.count(1):
        numbered = path.with_name(f"{path.stem}.{number}{path.suffix}")
        try:
            numbered.open("xb").close()
        except FileExistsError:
            continue
        return numbered
    raise AssertionError("numbers do not end")


def _cannot_write(path: Path, error: OSError) -> UserError:
    return UserError(say("command.cannot-write", path=str(path), why=error.strerror or str(error)))
