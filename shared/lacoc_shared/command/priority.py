"""Lets a process give way to others where there are not enough processors for all."""

import os

TO_ALL = 10
"""For work in the background."""


def give_way(steps: int) -> None:
    """Lower the priority of this process, on systems that have `nice`.

    Threads that run already keep theirs, so call it first.

    Args:
        steps: by how much, such as `TO_ALL`.
    """
    if hasattr(os, "nice"):
        os.nice(steps)
