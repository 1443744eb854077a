"""Sets which threads and processes run first when there are not enough processors for all."""

import contextlib
import os
import sys

BACKGROUND = 10
"""Work in the background has a `nice` value that is higher by this."""
_LOWEST_REAL_TIME = 1


def go_first() -> bool:
    """Give this thread real-time priority, so that it need not wait for ordinary programs.

    It is for a thread that has little work and must not do it late. Threads and processes that it
    starts have the usual priority.

    Returns:
        Whether the system allows it. Only Linux does, for root and for users who have a limit
        `rtprio`.
    """
    return sys.platform == "linux" and _schedule(os.SCHED_FIFO, _LOWEST_REAL_TIME)


def take_turns() -> None:
    """Give this thread the usual priority again, after `go_first`."""
    if sys.platform == "linux":
        _schedule(os.SCHED_OTHER, 0)


def _schedule(policy: int, priority: int) -> bool:
    """Set the scheduling policy and priority of this thread; return False if not allowed."""
    if sys.platform != "linux":
        return False
    with contextlib.suppress(PermissionError):
        # Only root may take the flag away again, so it is always there.
        os.sched_setscheduler(0, policy | os.SCHED_RESET_ON_FORK, os.sched_param(priority))
        return True
    return False


def give_way() -> None:
    """Lower the priority of this process, on systems that have `nice`.

    Threads that are running already keep their priority, so call this first.
    """
    if hasattr(os, "nice"):
        os.nice(BACKGROUND)
