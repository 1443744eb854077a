"""Signals that end a program: its loop checks for them, so that it leaves nothing half-done."""

import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

_SIGNALS = ("SIGINT", "SIGTERM", "SIGHUP")  # Ctrl-C, kill, a closed window


@contextmanager
def stop_signals() -> Iterator[Callable[[], bool]]:
    """Catch the signals that ask the program to end.

    Yield a function that returns whether such a signal has arrived. Signals are caught until the
    `with` block ends, or until the first one has arrived: a second one ends the program as usual.
    """
    asked: list[int] = []
    numbers = [getattr(signal, name) for name in _SIGNALS if hasattr(signal, name)]
    before = {number: signal.getsignal(number) for number in numbers}

    def note(number: int, _: object) -> None:
        asked.append(number)
        for each, handler in before.items():
            signal.signal(each, handler)

    for number in numbers:
        signal.signal(number, note)
    try:
        yield lambda: bool(asked)
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


@contextmanager
def unreached() -> Iterator[None]:
    """Let Ctrl-C reach no process that this thread starts in the `with` block.

    Windows knows no such thing: there a process must ignore Ctrl-C itself.
    """
    if sys.platform == "win32":
        yield
    else:
        before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        try:
            yield
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)
