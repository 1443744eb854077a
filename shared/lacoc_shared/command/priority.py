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
    if sys.platform != "linux":
        return False
    policy = os.SCHED_FIFO | os.SCHED_RESET_ON_FORK
    with contextlib.suppress(PermissionError):
        os.sched_setscheduler(0, policy, os.sched_param(_LOWEST_REAL_TIME))
        return True
    return False


def take_turns() -> None:
    """Give this thread the usual priority again."""
    if sys.platform == "linux":
        os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))


def give_way() -> None:
    """Lower the priority of this process, on systems that have `nice`.

    Threads that run already keep theirs, so call it first.
    """
    if hasattr(os, "nice"):
        os.nice(BACKGROUND)
