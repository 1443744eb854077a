"""Replaces a file in one step: whoever reads it meanwhile gets the whole old or new file."""

import errno
import os
from collections.abc import Callable
from pathlib import Path


def write(path: Path, content: bytes, *, secret: bool = False, lasting: bool = False) -> None:
    """Write a file in place of an older one.

    Args:
        path: the file.
        content: its new content.
        secret: whether other users can at no time read it.
        lasting: whether it is on the disk when this call returns, so that a power cut does not
            bring the older one back. That takes some milliseconds.

    Raises:
        OSError: if it can't be written.
    """

    def write_part(part: Path) -> None:
        with open(part, "xb", opener=_for_its_owner if secret else None) as file:
            file.write(content)
            if lasting:
                file.flush()
                os.fsync(file.fileno())

    replace(path, write_part)
    if lasting:
        sync_folder(path.parent)


def replace(path: Path, write_part: Callable[[Path], object]) -> None:
    """Replace a file: `write_part` writes a new file beside it, which then gets its path."""
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    part.unlink(missing_ok=True)  # of a killed program that had this number
    try:
        write_part(part)
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)


def _for_its_owner(name: str, flags: int) -> int:
    return os.open(name, flags, 0o600)


def sync_folder(folder: Path) -> None:
    """Write the folder's list of names to the disk, so that a new file survives a power cut.

    Raises:
        OSError: if the disk refuses. If folders can't be opened (Windows), nothing is done.
    """
    if os.name != "posix":
        return
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    except OSError as error:
        if error.errno not in (errno.EINVAL, errno.ENOTSUP):  # some file systems can't do it
            raise
    finally:
        os.close(descriptor)
