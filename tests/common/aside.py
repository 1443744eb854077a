"""Runs functions in a thread of their own: a test's browser leaves an event loop in its thread."""

import asyncio
from collections.abc import Callable, Coroutine
from concurrent.futures import ThreadPoolExecutor
from typing import Any, TypeVar

T = TypeVar("T")


def aside(do: Callable[[], T]) -> T:
    """Call a function in a thread of its own, and return its result."""
    with ThreadPoolExecutor(1) as thread:
        return thread.submit(do).result()


def run_async(do: Callable[[], Coroutine[Any, Any, T]]) -> T:
    """Run the coroutine that a function makes, in a thread of its own."""
    return aside(lambda: asyncio.run(do()))
