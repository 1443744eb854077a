"""Threads on which calls wait for a court's answer, so that the event loop need not wait."""

import asyncio
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

T = TypeVar("T")


class Threads:
    """A few threads on which calls run; more calls wait while all threads are busy.

    Args:
        count: number of threads.
    """

    def __init__(self, count: int) -> None:
        self._pool = ThreadPoolExecutor(count, thread_name_prefix="asks")

    async def run(self, do: Callable[[], T]) -> T:
        """Run a function on one of the threads, and return its result."""
        return await asyncio.get_running_loop().run_in_executor(self._pool, do)

    def close(self) -> None:
        """Take no more calls; calls that run may finish."""
        self._pool.shutdown(wait=False, cancel_futures=True)
