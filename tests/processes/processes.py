"""Starts modules in processes of their own, asks and measures them, and ends them at once."""

import json
import os
import subprocess
import sys
import threading
from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import psutil
from waiting import LIMIT_S

LACOC = "lacoc_shared"
"""The module that is the command `lacoc`."""
_END_S = 30


@contextmanager
def started(module: str, *words: str, quiet: bool = False) -> Iterator[subprocess.Popen[str]]:
    """Start a process, and ask it to end when the block has ended.

    Args:
        module: the module that `python -m` runs.
        words: its arguments.
        quiet: whether to throw away its error output.
    """
    process = subprocess.Popen(
        [sys.executable, "-m", module, *words],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL if quiet else None,
        env={name: value for name, value in os.environ.items() if not name.startswith("LACOC_")},
        text=True,
    )
    try:
        yield process
    finally:
        process.terminate()
        process.communicate(timeout=_END_S)


def read_line(process: subprocess.Popen[str]) -> Any:
    """Return the next line of JSON that a process prints.

    Raises:
        RuntimeError: if the process has ended.
    """
    assert process.stdout is not None
    line = process.stdout.readline()
    if not line:
        raise RuntimeError(f"{process.args!r} ended with {process.wait()}")
    return json.loads(line)


def hush(process: subprocess.Popen[str]) -> None:
    """Throw away all further output of a process: a full pipe would stop the process."""
    assert process.stdout is not None
    said = process.stdout

    def read() -> None:
        with suppress(ValueError):  # closed at the end
            deque(said, maxlen=0)

    threading.Thread(target=read, daemon=True).start()


def ask(process: subprocess.Popen[str], word: str) -> Any:
    """Send a word to a process and wait for its answer."""
    assert process.stdin is not None
    process.stdin.write(f"{word}\n")
    process.stdin.flush()
    return read_line(process)


def children_s() -> float:
    """Return the processor time of this process's descendants, such as a browser's processes [s].

    One that has ended does not count.
    """
    used = 0.0
    for child in psutil.Process().children(recursive=True):
        with suppress(psutil.NoSuchProcess):
            times = child.cpu_times()
            used += times.user + times.system
    return used


def used_s(process: subprocess.Popen[str]) -> float:
    """Return the processor time of all threads of a process, as the kernel counts it [s]."""
    fields = Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def everything_of(process: "subprocess.Popen[Any]") -> list[psutil.Process]:
    """Return a process, and all that it started."""
    found = psutil.Process(process.pid)
    return [found, *found.children(recursive=True)]


def cut_power(process: "subprocess.Popen[Any]") -> None:
    """Kill a process and all that it started at once, and wait until they are gone."""
    everything = everything_of(process)
    for one in everything:
        with suppress(psutil.NoSuchProcess):  # it has ended with its parent
            one.kill()
    process.communicate(timeout=LIMIT_S)
    _, left = psutil.wait_procs(everything, LIMIT_S)
    assert not left, left
