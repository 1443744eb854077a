"""Threads for what asks a court and waits, so that the event loop never does."""

import asyncio
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

T = TypeVar("T")


class Threads:
    """A few threads; who comes when all are busy waits for one.

    Args:
        count: how many.
    """

    def __init__(self, count: int) -> None:
        self._pool = ThreadPoolExecutor(count, thread_name_prefix="asks")

    async def run(self, do: Callable[[], T]) -> T:
        """Run a function on one of the threads."""
        return await asyncio.get_running_loop().run_in_executor(self._pool, do)

    def close(self) -> None:
        """Take nothing more on; what runs is left to end."""
        self._pool.shutdown(wait=False, cancel_futures=True)
