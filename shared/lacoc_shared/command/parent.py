"""Ends a process when the process that started it has ended, for whatever reason.

The parent keeps one end of a pipe open. The system closes it when the parent ends, even after kill
-9. On Windows and macOS there is no other way.
"""

import os
import signal
import threading

VARIABLE = "LACOC_PARENT"
"""Environment variable. If it is set, this process's standard input is a pipe from its parent."""


_followed = threading.Event()


def follow() -> None:
    """Make this process get SIGTERM when its parent has ended, if the parent has asked for it."""
    if os.environ.pop(VARIABLE, None) is not None:
        _followed.set()
        threading.Thread(target=_wait, name="parent", daemon=True).start()


def is_followed() -> bool:
    """Return whether this process ends together with its parent."""
    return _followed.is_set()


def _wait() -> None:
    while os.read(0, 1024):
        pass  # nobody writes; only the end of the pipe matters
    os.kill(os.getpid(), signal.SIGTERM)
