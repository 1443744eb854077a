"""Ends a process and all that it started at once, as a power cut does."""

import subprocess
from contextlib import suppress
from typing import Any

import psutil
from waiting import LIMIT_S


def everything_of(process: "subprocess.Popen[Any]") -> list[psutil.Process]:
    """Return a process, and all that it started."""
    found = psutil.Process(process.pid)
    return [found, *found.children(recursive=True)]


def cut_power(process: "subprocess.Popen[Any]") -> None:
    """Kill a process and all that it started, and wait until they are gone."""
    everything = everything_of(process)
    for one in everything:
        with suppress(psutil.NoSuchProcess):  # it has ended with its parent
            one.kill()
    process.communicate(timeout=LIMIT_S)
    _, left = psutil.wait_procs(everything, LIMIT_S)
    assert not left, left
