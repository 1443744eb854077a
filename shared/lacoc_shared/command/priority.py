"""Lets work in the background give way where there are not enough processors for all."""

import os

BACKGROUND = 10
"""By how much the priority of work in the background is lower (`nice`)."""


def give_way() -> None:
    """Lower the priority of this process, on systems that have `nice`.

    Threads that run already keep theirs, so call it first.
    """
    if hasattr(os, "nice"):
        os.nice(BACKGROUND)
