"""A virtual cable (veth) to a second network namespace, which acts as another machine."""

import ctypes
import os
import subprocess
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

from hall import Hall
from waiting import LIMIT_S

from lacoc_shared.seat import SeatFlag

CLONE_NEWNET = 0x40000000
"""The flag of `unshare` for a new network namespace, from linux/sched.h."""


def ip(*words: str) -> None:
    """Run the `ip` command, which sets up network namespaces and their interfaces."""
    subprocess.run(["ip", *words], check=True, capture_output=True)


@contextmanager
def cable() -> Iterator[tuple[str, tuple[str, ...], Callable[[str], None]]]:
    """Connect this process's network namespace to a new one by a cable.

    Yields:
        The address of this side; the words to put before a command so that it runs on the other
        side; a function that sets the cable "up" or "down".
    """
    name = f"lacoc{os.getpid()}"
    ip("netns", "add", name)
    try:
        ip("link", "add", "near", "type", "veth", "peer", "name", "far", "netns", name)
        ip("address", "add", "10.213.0.1/24", "dev", "near")
        ip("link", "set", "near", "up")
        ip("-n", name, "address", "add", "10.213.0.2/24", "dev", "far")
        ip("-n", name, "link", "set", "far", "up")
        inside = ("ip", "netns", "exec", name)
        yield "10.213.0.1", inside, lambda state: ip("link", "set", "near", state)
    finally:
        subprocess.run(["ip", "netns", "delete", name], check=False, capture_output=True)


def pull_a_real_cable(folder: Path) -> bool:
    """Check that a match survives the loss of the left bot's cable, and that its court can end.

    While the cable is down, the left robot stands and the right bot plays on. Once the cable is up,
    the left bot's keys take effect again. While the cable is down a second time, SIGTERM ends the
    court with exit code 0. This process moves to a new network namespace and stays there.

    Returns:
        False if this user may not make network namespaces; then nothing was played.
    """
    if ctypes.CDLL(None).unshare(CLONE_NEWNET):
        return False
    ip("link", "set", "lo", "up")
    with cable() as (host, there, cable_is), ExitStack() as stack:
        hall = Hall(folder, stack, host)
        hall.bot("left", before=there)
        hall.bot("right")
        hall.play()
        hall.walks()
        hall.loses(lambda: cable_is("down"))
        hall.walks(1)
        cable_is("up")
        hall.until(lambda: not hall.left.flags & SeatFlag.SILENT)
        hall.walks()
        cable_is("down")
        hall.walks(1)
        hall.process.terminate()
        assert hall.process.wait(LIMIT_S) == 0
    return True
