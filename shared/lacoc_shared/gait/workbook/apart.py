"""Reads workbooks in a process of its own, with limits of memory and time.

Workbooks come from strangers. If one of them crashes or blocks the process that reads it, the file
is refused, and the gateway, office or class goes on. The process starts with the first workbook,
starts again after one that ended it, and ends with the program for which it reads.
"""

import atexit
import contextlib
import os
import subprocess
import sys
import threading
from typing import IO

import msgspec

from lacoc_shared.gait.workbook.content import WorkbookSheet, read_sheet, refused
from lacoc_shared.mistakes import FileRefused, Mistake
from lacoc_shared.words import say

_MEMORY_BYTES = 512 << 20
_PROCESSOR_S = 3
"""Longest time of the processor for a workbook [s]; a usual workbook takes 0.1."""
_WALL_S = 60.0
"""Longest time for a workbook [s], also on a busy machine."""
_LENGTH_BYTES = 4

_Asked = tuple[str, bytes]
"""Message to the process: the name of a file, and its content."""
_Answer = WorkbookSheet | list[Mistake]
"""Message from the process: a sheet, or why the file is refused."""


def read_sheet_apart(data: bytes, name: str) -> WorkbookSheet:
    """Read the sheet of a workbook that has the gait, as `content.read_sheet` does.

    Args:
        data: the .xlsx file.
        name: the file's name, for error messages.

    Raises:
        FileRefused: if the file is no such workbook, or needs too much memory or time.
    """
    answer = _reader.ask((name, data))
    if answer is None:
        raise refused(name, say("gait.too-costly"), say("gait.table"))
    if isinstance(answer, WorkbookSheet):
        return answer
    raise FileRefused(answer)


class _ReaderProcess:
    """The process that reads workbooks, one at a time.

    If a workbook has ended it, it is started again for the next one.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._process: subprocess.Popen[bytes] | None = None
        self._owner = 0
        atexit.register(self.close)

    def ask(self, asked: _Asked) -> _Answer | None:
        """Let the process read a workbook; return None if the process has ended meanwhile."""
        with self._lock:
            process = self._started()
            assert process.stdin is not None
            assert process.stdout is not None
            limit = threading.Timer(_WALL_S, process.kill)
            limit.daemon = True
            limit.start()
            try:
                _put(process.stdin, msgspec.msgpack.encode(asked))
                answer = _take(process.stdout)
            except OSError:
                answer = None
            finally:
                limit.cancel()
            if answer is None:
                self._end()
                return None
            found: _Answer = msgspec.msgpack.decode(answer, type=_Answer)
            return found

    def close(self) -> None:
        """End the process that reads workbooks."""
        with self._lock:
            self._end()

    def _started(self) -> subprocess.Popen[bytes]:
        if self._owner != os.getpid():  # after a fork, the process belongs to the parent
            self._process = None
        if self._process is None or self._process.poll() is not None:
            self._end()
            self._owner = os.getpid()
            self._process = subprocess.Popen(
                [sys.executable, "-m", __spec__.name],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                start_new_session=True,  # Ctrl-C ends the program, and with it the process
            )
        return self._process

    def _end(self) -> None:
        process, self._process = self._process, None
        if process is None or self._owner != os.getpid():
            return
        process.kill()
        process.wait()
        for pipe in (process.stdin, process.stdout):
            with contextlib.suppress(OSError):  # what was not sent goes nowhere
                if pipe is not None:
                    pipe.close()


_reader = _ReaderProcess()


def _put(pipe: IO[bytes], message: bytes) -> None:
    pipe.write(len(message).to_bytes(_LENGTH_BYTES))
    pipe.write(message)
    pipe.flush()


def _take(pipe: IO[bytes]) -> bytes | None:
    """Read a message from a pipe; None: the other process has closed the pipe."""
    length = pipe.read(_LENGTH_BYTES)
    message = pipe.read(int.from_bytes(length)) if len(length) == _LENGTH_BYTES else b""
    return message if message and len(message) == int.from_bytes(length) else None


def _serve() -> None:
    """Read the workbooks that come through standard input, and answer each; end with the input."""
    sys.modules["numpy"] = None  # type: ignore[assignment] # openpyxl would load it for nothing
    answers, sys.stdout = sys.stdout.buffer, sys.stderr  # whatever else prints, goes elsewhere
    _limit_memory()
    while (message := _take(sys.stdin.buffer)) is not None:
        _limit_time()
        name, data = msgspec.msgpack.decode(message, type=_Asked)
        try:
            answer: _Answer = read_sheet(data, name)
        except FileRefused as error:
            answer = error.mistakes
        _put(answers, msgspec.msgpack.encode(answer))


def _limit_memory() -> None:
    if sys.platform == "win32":  # it has no such limits
        return
    with contextlib.suppress(ValueError, OSError):
        import resource

        _, hard = resource.getrlimit(resource.RLIMIT_DATA)
        resource.setrlimit(resource.RLIMIT_DATA, (_MEMORY_BYTES, hard))


def _limit_time() -> None:
    """Let the system end this process when it has worked on a workbook for too long."""
    if sys.platform == "win32":
        return
    with contextlib.suppress(ValueError, OSError):
        import resource

        used = resource.getrusage(resource.RUSAGE_SELF)
        until_s = int(used.ru_utime + used.ru_stime) + 1 + _PROCESSOR_S
        _, hard = resource.getrlimit(resource.RLIMIT_CPU)
        resource.setrlimit(resource.RLIMIT_CPU, (until_s, hard))


if __name__ == "__main__":
    _serve()
