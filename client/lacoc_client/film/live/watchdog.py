"""Ends a browser that hangs: Playwright would wait for it for ever."""

import os
import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

from playwright.sync_api import Browser

from lacoc_shared.words import Phrase, say

_LOOK_S = 0.5
_STOPPING_S = 5.0
"""A stream that is told to stop waits for its browser for this long [s]."""
_KILL = getattr(signal, "SIGKILL", signal.SIGTERM)
"""Windows has one signal for this."""


class Watchdog:
    """Watches a browser on a thread, and ends its processes if nothing comes from it.

    Args:
        browser: the browser; only the thread that opened it may make this object.
        stopping: whether the stream is to stop.
        patience_s: for so long the browser may show nothing [s].
    """

    def __init__(self, browser: Browser, stopping: Callable[[], bool], patience_s: float) -> None:
        self.why: Phrase | None = None
        """Why the browser was ended; None: it was not."""
        self._tools = browser.new_browser_cdp_session()
        self._stopping, self._patience_s = stopping, patience_s
        self.look()
        self._seen_s = time.monotonic()
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def look(self) -> None:
        """Note which processes the browser has; a page that is opened may get a new one.

        Raises:
            Error: if the browser has ended.
        """
        found = self._tools.send("SystemInfo.getProcessInfo")["processInfo"]
        self._processes: list[int] = [one["id"] for one in found]

    def see(self, patience_s: float) -> None:
        """Note that something came from the browser, which has `patience_s` for the next [s]."""
        self._seen_s, self._patience_s = time.monotonic(), patience_s

    def end(self) -> None:
        """Watch the browser no longer."""
        self._over.set()
        self._thread.join()

    def _run(self) -> None:
        while not self._over.wait(_LOOK_S):
            patience_s = _STOPPING_S if self._stopping() else self._patience_s
            if time.monotonic() - self._seen_s > patience_s:
                self.why = say("stream.browser-hangs", seconds=patience_s)
                for process in self._processes:
                    with suppress(OSError):
                        os.kill(process, _KILL)
                return


@contextmanager
def watched(
    browser: Browser, stopping: Callable[[], bool], patience_s: float
) -> Iterator[Watchdog]:
    """Watch a browser until the `with` block ends; the arguments are as in `Watchdog`.

    Raises:
        Error: if the browser has ended.
    """
    watchdog = Watchdog(browser, stopping, patience_s)
    try:
        yield watchdog
    finally:
        watchdog.end()
