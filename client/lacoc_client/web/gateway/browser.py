"""Opens a page in the user's browser, without a secret in a command line.

Every user of a machine can read the command lines of all programs, and a browser gets the address
of a page in its command line. So the address with the page key is written into a file that only
this person can read. The browser opens the file, which redirects to the address.
"""

import html
import os
import sys
import threading
import webbrowser
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

from lacoc_shared.command.scratch import Scratch

_BROWSER_S = 2.0
_LEADS_ON = (
    '<!doctype html><meta charset="utf-8"><title>LACOC</title>'
    '<meta http-equiv="refresh" content="0; url={0}"><a href="{0}">LACOC</a>\n'
)


@contextmanager
def unseen(address: str) -> Iterator[str]:
    """Yield an address that leads to `address` without containing it, until the `with` block ends.

    If no file can be written, yield `address` itself.

    Args:
        address: an address with a page key in its fragment.
    """
    with ExitStack() as stack:
        try:
            way = stack.enter_context(_file(address)).as_uri()
        except (OSError, RuntimeError):  # RuntimeError: the home folder is not known
            way = address
        yield way


@contextmanager
def _file(address: str) -> Iterator[Path]:
    # Visible, and in the home folder: browsers in a sandbox (snap, flatpak) have their own /tmp and
    # see no hidden folders.
    with Scratch("opens", Path.home()) as folder:
        path = folder / "lacoc.html"
        with open(path, "x", encoding="utf-8", opener=_private) as file:
            file.write(_LEADS_ON.format(html.escape(address)))
        yield path


def _private(name: str, flags: int) -> int:
    return os.open(name, flags, 0o600)


def open_browser(address: str) -> bool:
    """Show a page in the user's browser; return False if no browser could be opened."""
    if sys.platform.startswith("linux") and not any(
        os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER")
    ):
        return False  # a text browser would take over the terminal
    found: list[bool] = []

    def open_it() -> None:
        try:
            found.append(webbrowser.open(address))
        except (webbrowser.Error, OSError):
            found.append(False)

    # Some browsers block this call until they are closed.
    opening = threading.Thread(target=open_it, daemon=True)
    opening.start()
    opening.join(_BROWSER_S)
    return not found or found[0]
