"""Folders for files that are needed only while a program runs.

A program that is killed leaves its folder behind. So each folder has a file that its program keeps
locked; the system ends the lock with the program. Before a program makes a folder, it removes the
folders of programs that have ended.
"""

import contextlib
import shutil
import tempfile
import time
import weakref
from pathlib import Path
from typing import BinaryIO

from lacoc_shared.command.holding import hold

_PREFIX = "lacoc-"
_OWNER, _MAKING = "owner.lock", "owner.lock.new"
_MAKING_S = 3600.0
"""A folder that is still being made after this time [s] counts as left behind."""


class Scratch:
    """A folder of this program, deleted with all that is in it; used as a context manager.

    Only the user who runs the program can read it.

    Args:
        what: the purpose of the folder; part of its name.
        where: the folder in which it is made; None: the system's folder for temporary files.

    Raises:
        OSError: if the folder can't be made.
    """

    def __init__(self, what: str, where: Path | None = None) -> None:
        parent = Path(tempfile.gettempdir()) if where is None else where
        sweep(parent)
        self.path = Path(tempfile.mkdtemp(prefix=f"{_PREFIX}{what}-", dir=parent))
        """Path of the folder."""
        lock = _locked(self.path)
        self._remove = weakref.finalize(self, _remove, self.path, lock)

    def __enter__(self) -> Path:
        return self.path

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Delete this temporary folder and all that is in it."""
        self._remove()


def sweep(parent: Path) -> None:
    """Remove the temporary folders of programs that have ended; leave those that can't be removed.

    Args:
        parent: the folder that they are in.
    """
    for folder in parent.glob(f"{_PREFIX}*"):
        with contextlib.suppress(OSError):  # another user's, or removed at this moment
            if folder.is_dir() and not folder.is_symlink() and _is_left(folder):
                shutil.rmtree(folder, ignore_errors=True)


def _locked(folder: Path) -> BinaryIO:
    """Make and lock the file which shows that the folder's program is running."""
    made = folder / _MAKING
    lock = made.open("xb")
    hold(lock)
    made.rename(folder / _OWNER)  # so nobody finds it before it is locked
    return lock


def _is_left(folder: Path) -> bool:
    """Return whether a folder was made by this module for a program that has ended since.

    A folder without the lock file was made by somebody else, whatever its name is. Where a file
    system has no locks, every folder stays.
    """
    try:
        with (folder / _OWNER).open("rb+") as lock, (folder / _OWNER).open("rb+") as other:
            return hold(lock) and not hold(other)
    except FileNotFoundError:
        made = [*folder.iterdir()]
        was_made = [path.name for path in made] == [_MAKING]
        return was_made and time.time() - made[0].stat().st_mtime > _MAKING_S


def _remove(folder: Path, lock: BinaryIO) -> None:
    lock.close()  # Windows deletes no open file
    shutil.rmtree(folder, ignore_errors=True)
