"""Says which work goes first where there are not enough processors for all."""

import contextlib
import os
import sys

BACKGROUND = 10
"""By how much the priority of work in the background is lower (`nice`)."""
_LOWEST_REAL_TIME = 1


def go_first() -> bool:
    """Give this thread real-time priority, so that it need not wait for ordinary programs.

    For a thread that has little to do, at moments that matter. Threads and processes that it starts
    have the usual priority.

    Returns:
        Whether the system allows it. Only Linux does, for root and for those with a limit `rtprio`.
    """
    return sys.platform == "linux" and _schedule(os.SCHED_FIFO, _LOWEST_REAL_TIME)


def take_turns() -> None:
    """Give this thread the usual priority again."""
    if sys.platform == "linux":
        _schedule(os.SCHED_OTHER, 0)


def _schedule(policy: int, priority: int) -> bool:
    """Set how this thread is scheduled; return whether the system allows it."""
    if sys.platform != "linux":
        return False
    with contextlib.suppress(PermissionError):
        # Only root may take the flag away again, so it is always there.
        os.sched_setscheduler(0, policy | os.SCHED_RESET_ON_FORK, os.sched_param(priority))
        return True
    return False


def give_way() -> None:
    """Lower the priority of this process, on systems that have `nice`.

    Threads that run already keep theirs, so call it first.
    """
    if hasattr(os, "nice"):
        os.nice(BACKGROUND)
