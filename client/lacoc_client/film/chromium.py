"""Finds a Chromium that can draw the pages without a window and without a graphics card."""

import os
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path

from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

VARIABLE = "CHROMIUM"
"""Environment variable that gives the path of the browser."""

FLAGS = (
    "--no-sandbox",  # the user may be root, in a container; only our own pages are loaded
    "--enable-unsafe-swiftshader",
    "--use-gl=angle",
    "--use-angle=swiftshader",  # draws without a graphics card, the same on every machine
    "--ignore-gpu-blocklist",
    # Chromium composes the page in plain software, not with software OpenGL: half the time.
    "--disable-gpu-compositing",
    "--disable-background-networking",
)
"""Options with which Chromium draws without a graphics card."""

SHELL = "chromium-headless-shell"
"""Name of a Chromium without the code for windows; it draws pages in two thirds of the time."""
_NAMES = (
    SHELL,
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
    "chrome",
)
_MAC = ("Google Chrome.app/Contents/MacOS/Google Chrome", "Chromium.app/Contents/MacOS/Chromium")
_WINDOWS = ("Google/Chrome/Application/chrome.exe", "Chromium/Application/chrome.exe")


def on_path() -> str | None:
    """Return the path of the system's Chromium or Chrome; None if neither is installed."""
    found = (shutil.which(name) for name in (*_NAMES, *map(str, _places())))
    return next((path for path in found if path), None)


def find(own: str | None = None) -> str:
    """Return Chromium's path: the one that the environment names, Playwright's, or the system's.

    Args:
        own: path at which Playwright would have installed a Chromium.

    Raises:
        UserError: if there is none; the message says how to install one.
    """
    named = os.environ.get(VARIABLE)
    if named:
        program = shutil.which(named)
        if program is None:
            raise UserError(say("film.no-such-browser", variable=VARIABLE, name=named))
        return program
    found = own if own and Path(own).is_file() else on_path()
    if found is None:
        raise UserError(say("film.no-browser", variable=VARIABLE))
    return found


def _places() -> Iterator[Path]:
    yield from ()  # elsewhere the program is on the path
    if sys.platform == "darwin":
        yield from (Path("/Applications", name) for name in _MAC)
    if sys.platform == "win32":
        for variable in ("PROGRAMFILES", "PROGRAMFILES(X86)", "LOCALAPPDATA"):
            if folder := os.environ.get(variable):
                yield from (Path(folder, name) for name in _WINDOWS)
