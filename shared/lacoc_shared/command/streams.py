"""The three standard streams: opens closed ones, and reports if output fails.

A shell may start a command with a closed stream (`>&-`), or with one that can't be written (`>
/dev/full`). Python then has None for a closed stream, and the next file that is opened gets the
stream's number, so that output would go into that file. And without this module a failed write to
standard output looks like a failed write to any other file.
"""

import io
import os
import sys
from typing import TYPE_CHECKING, Literal, TextIO

if TYPE_CHECKING:
    from _typeshed import ReadableBuffer

_MODES = (os.O_WRONLY, os.O_RDONLY, os.O_WRONLY)
"""With which modes the null device is opened in place of a closed stream. Input and output then
fail, as with a closed stream; messages to standard error are lost."""


class OutputFailed(OSError):
    """Raised when standard output can't be written; a broken pipe raises `BrokenPipeError`."""


def open_all() -> None:
    """Open streams that are closed, and make a failed write to standard output recognisable."""
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
    """Discard everything that is written to standard output from now on."""
    null = os.open(os.devnull, os.O_WRONLY)
    os.dup2(null, sys.stdout.fileno())
    os.close(null)


class _Output(io.FileIO):
    """Standard output; a failed write raises `OutputFailed`, which no other file raises."""

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
