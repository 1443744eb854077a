"""The three standard streams: closed ones are opened, and output that fails says so.

A shell may start a command with a closed stream (`>&-`) or one that takes nothing (`> /dev/full`).
Python then has None for a stream, and the next file that is opened gets its number, so that output
would go into that file. And a failed write can't be told from that of any other file.
"""

import io
import os
import sys
from typing import TYPE_CHECKING, Literal, TextIO

if TYPE_CHECKING:
    from _typeshed import ReadableBuffer

_MODES = (os.O_WRONLY, os.O_RDONLY, os.O_WRONLY)
"""How the null device is opened in place of each stream: input and output then fail, as they would
with a closed stream; messages to standard error vanish."""


class OutputFailed(OSError):
    """Standard output can't be written."""


def open_all() -> None:
    """Open the streams that are closed, and let a failed write to standard output say so."""
    for number, mode in enumerate(_MODES):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, mode)  # gets the lowest free number, which is this one
    sys.stdin = sys.stdin or _opened(0, "r")
    sys.stdout = sys.stdout or _opened(1, "w")
    sys.stderr = sys.stderr or _opened(2, "w")
    out = sys.stdout
    if isinstance(out, io.TextIOWrapper) and _number(out) == 1 and not out.isatty():
        out.flush()
        sys.stdout = io.TextIOWrapper(
            io.BufferedWriter(_Output(1, "w", closefd=False)),
            encoding=out.encoding,
            errors=out.errors,
            line_buffering=out.line_buffering,
            write_through=out.write_through,
        )


def drop_output() -> None:
    """Let everything that is still written to standard output vanish."""
    null = os.open(os.devnull, os.O_WRONLY)
    os.dup2(null, sys.stdout.fileno())
    os.close(null)


class _Output(io.FileIO):
    """Standard output, whose errors differ from those of other files."""

    def write(self, data: "ReadableBuffer", /) -> int:
        try:
            return super().write(data)
        except BrokenPipeError:
            raise
        except OSError as error:
            raise OutputFailed(error.errno, error.strerror) from None


def _opened(number: int, mode: Literal["r", "w"]) -> TextIO:
    return open(number, mode, encoding="utf-8", closefd=False)


def _number(stream: io.TextIOWrapper) -> int | None:
    try:
        return stream.fileno()
    except io.UnsupportedOperation:  # a test has replaced it
        return None
