"""Locks files; a lock ends with the process that holds it, however the process ends."""

import sys
from typing import BinaryIO

_LOCKED_BYTE = 2**40  # beyond any file of ours: Windows lets nobody read a locked part


def hold(file: BinaryIO) -> bool:
    """Lock an open file until it is closed or its process ends.

    Returns:
        False if another process has locked the file; else True, also if the file system has no
        locks.
    """
    try:
        _lock(file)
    except (BlockingIOError, PermissionError):
        return False
    except OSError:  # a file system without locks: other processes can't be told
        return True
    return True


def _lock(file: BinaryIO) -> None:
    if sys.platform == "win32":
        import msvcrt

        at = file.tell()
        file.seek(_LOCKED_BYTE)
        try:
            msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
        finally:
            file.seek(at)
    else:
        import fcntl

        fcntl.flock(file.fileno(), fcntl.LOCK_EX | fcntl.LOCK_NB)
