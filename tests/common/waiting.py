"""Waits in tests for what another process or thread does."""

import time
from collections.abc import Callable


def until(true: Callable[[], object], timeout_s: float = 60.0) -> None:
    """Wait until a condition is true; fail after `timeout_s`."""
    end_s = time.monotonic() + timeout_s
    while not true():
        assert time.monotonic() < end_s, "it did not come true"
        time.sleep(0.002)
