"""Workbooks are read in a process of its own, with limits."""

import os
import signal
import subprocess
import sys
import threading
from typing import IO

import pytest
from waiting import until

from lacoc_shared.gait.workbook import apart
from lacoc_shared.gait.workbook.file import read_workbook, write_workbook
from lacoc_shared.mistakes import FileRefused

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals and limits of POSIX")


def _under_limits(code: str) -> subprocess.CompletedProcess[bytes]:
    """Run code in a process with the limits of the one that reads, but 1 s of the processor."""
    limits = (
        "from lacoc_shared.gait.workbook import apart\napart._PROCESSOR_S = 1\n"
        "apart._limit_memory()\napart._limit_time()"
    )
    return subprocess.run([sys.executable, "-c", f"{limits}\n{code}"], capture_output=True)


@pytest.mark.slow
def test_the_process_that_reads_has_limits() -> None:
    """It can't take more memory than a workbook may need, nor more time of the processor."""
    assert b"MemoryError" in _under_limits("bytearray(apart._MEMORY_BYTES)").stderr
    assert _under_limits("while True: pass").returncode == -signal.SIGXCPU


def waiting_bytes(pipe: IO[bytes]) -> int:
    """Return how many bytes were written to a pipe and not read yet."""
    import fcntl  # POSIX only
    import termios

    count = bytearray(4)
    fcntl.ioctl(pipe.fileno(), termios.FIONREAD, count)
    return int.from_bytes(count, sys.byteorder)


def test_a_process_that_ends_refuses_its_own_workbook_only(workshop, legs) -> None:
    """If the system ends the process, that workbook is refused; the next one is read again."""
    data = write_workbook(workshop, legs)
    assert read_workbook(data, "x") == workshop
    process = apart._reader._process
    assert process is not None
    os.kill(process.pid, signal.SIGSTOP)
    refused: list[FileRefused] = []

    def read() -> None:
        try:
            read_workbook(data, "x")
        except FileRefused as error:
            refused.append(error)

    reading = threading.Thread(target=read)
    reading.start()
    until(lambda: waiting_bytes(process.stdin) > 0)
    process.kill()
    reading.join()
    assert [one.found.code for one in refused[0].mistakes] == ["gait.too-costly"]
    assert read_workbook(data, "x") == workshop
    assert apart._reader._process.pid != process.pid


def test_a_process_that_has_ended_is_started_again(workshop, legs) -> None:
    """A process that ended between two workbooks costs none of them."""
    data = write_workbook(workshop, legs)
    read_workbook(data, "x")
    process = apart._reader._process
    process.kill()
    process.wait()
    assert read_workbook(data, "x") == workshop
