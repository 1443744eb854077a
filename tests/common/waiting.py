"""Waits in tests for what another process or thread does."""

import time
from collections.abc import Callable

LIMIT_S = 90
"""Longer than anything takes on a busy machine, unless it hangs [s]."""
LIMIT_MS = 1000 * LIMIT_S
"""The same for pages [ms]."""


def until(true: Callable[[], object], timeout_s: float = LIMIT_S) -> None:
    """Wait until a condition is true; fail after `timeout_s`."""
    end_s = time.monotonic() + timeout_s
    while not true():
        assert time.monotonic() < end_s, "it did not come true"
        time.sleep(0.002)
