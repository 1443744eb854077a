"""A command that serves a page to one person, and a browser for it, as the tests of pages use."""

import contextlib
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from chromium import FLAGS, SLOW_SCREEN, find_chromium
from playwright.sync_api import Browser, sync_playwright

__all__ = ["SLOW_SCREEN", "chromium", "own_page"]

_ROOMS = ("arenas", "client", "robots", "server", "shared")


@contextlib.contextmanager
def own_page(*words: str, checkout: Path | None = None) -> Iterator[str]:
    """Run a `lacoc` command in an empty folder; give the address of its page, with the page key.

    Args:
        words: the command.
        checkout: root of another checkout whose code runs; None: this one's.
    """
    rooms = [str(checkout / room) for room in _ROOMS] if checkout else []
    with (
        tempfile.TemporaryDirectory() as folder,
        subprocess.Popen(
            [sys.executable, "-u", "-m", "lacoc_shared", *words, "--no-open"],
            cwd=folder,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(rooms)},
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        ) as process,
    ):
        try:
            assert process.stdout is not None
            said = ""
            for line in process.stdout:
                said += line
                if found := re.search(r"http://\S+#key=\S+", line):
                    yield found[0]
                    break
            else:
                raise RuntimeError(f"{words} did not open: {said}")
        finally:
            process.terminate()
            process.wait(30)


@contextlib.contextmanager
def chromium(*flags: str) -> Iterator[Browser]:
    """Run a browser that draws without a graphics card.

    Args:
        flags: further flags of Chromium.
    """
    with (
        sync_playwright() as playwright,
        contextlib.closing(
            playwright.chromium.launch(executable_path=find_chromium(), args=[*FLAGS, *flags])
        ) as browser,
    ):
        yield browser
