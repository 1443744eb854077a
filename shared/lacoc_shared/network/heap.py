"""Limits how much freed memory glibc keeps (other C libraries have no such calls).

glibc gives each of Zenoh's many threads its own heap, and each heap keeps its largest size
ever. Without these limits a court grows for hours as visitors come and go.
"""

import ctypes
import sys
from contextlib import suppress

_M_MMAP_THRESHOLD, _M_ARENA_MAX = -3, -8  # in malloc.h
_HEAPS = 2
_BLOCK_BYTES = 1 << 20
"""Blocks above this size, such as a MuJoCo model, are allocated outside the heaps and returned when
freed. Without a fixed size, glibc raises it whenever a larger block is freed, and later blocks of
that size then stay in the heaps.
"""


def share() -> None:
    """Set two limits for the freed memory that glibc keeps.

    Threads that start later share a few heaps. Large blocks go back to the system when freed.
    """
    _call("mallopt", _M_ARENA_MAX, _HEAPS)
    _call("mallopt", _M_MMAP_THRESHOLD, _BLOCK_BYTES)


def give_back() -> None:
    """Return memory that glibc has freed to the system; this takes a few milliseconds."""
    _call("malloc_trim", 0)


def _call(name: str, *arguments: int) -> None:
    if sys.platform == "linux":
        with suppress(AttributeError):
            getattr(ctypes.CDLL(None), name)(*arguments)
