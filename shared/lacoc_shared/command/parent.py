"""Lets a process end when the process that started it has gone, however that one ended.

The parent keeps one end of a pipe open, and the system closes it with the parent, also after
kill -9. Windows and macOS have no other means for this.
"""

import os
import signal
import threading

VARIABLE = "LACOC_PARENT"
"""Environment variable that is set if this process's standard input is such a pipe."""


_followed = threading.Event()


def follow() -> None:
    """End this process with SIGTERM when its parent has gone, if its parent asked for this."""
    if os.environ.pop(VARIABLE, None) is not None:
        _followed.set()
        threading.Thread(target=_wait, name="parent", daemon=True).start()


def is_followed() -> bool:
    """Return whether this process ends with its parent, which started it for itself."""
    return _followed.is_set()


def _wait() -> None:
    while os.read(0, 1024):
        pass  # nobody writes; only the end of the pipe matters
    os.kill(os.getpid(), signal.SIGTERM)
