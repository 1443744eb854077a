"""Memory that the C library keeps (glibc; others have one heap and no such calls).

It gives each of Zenoh's many threads a heap of its own, and each heap keeps the most that it
ever held: without this a court whose visitors come and go grows for hours.
"""

import ctypes
import sys
from contextlib import suppress

_M_MMAP_THRESHOLD, _M_ARENA_MAX = -3, -8  # in malloc.h
_HEAPS = 2
_BLOCK_BYTES = 1 << 20
"""A larger block, such as a world of MuJoCo, is never part of a heap and goes back when it is free.
Else the bound rises to the largest that was ever freed, and its place fills with small things."""


def share() -> None:
    """Let the threads that will be started share few heaps."""
    _call("mallopt", _M_ARENA_MAX, _HEAPS)
    _call("mallopt", _M_MMAP_THRESHOLD, _BLOCK_BYTES)


def give_back() -> None:
    """Give what is free back to the system; takes some milliseconds."""
    _call("malloc_trim", 0)


def _call(name: str, *arguments: int) -> None:
    if sys.platform == "linux":
        with suppress(AttributeError):
            getattr(ctypes.CDLL(None), name)(*arguments)
