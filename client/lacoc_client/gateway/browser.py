"""Opens a page in this person's browser, without a secret in a command line.

Every user of a machine can read the command lines of all programs, and a browser gets
there what it is to open. So an address that has a key is written into a file that only
its owner can read, and the browser opens the file, which leads on to the address.
"""

import html
import os
import sys
import tempfile
import threading
import webbrowser
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

_BROWSER_S = 2.0
_LEADS_ON = (
    '<!doctype html><meta charset="utf-8"><title>LACOC</title>'
    '<meta http-equiv="refresh" content="0; url={0}"><a href="{0}">LACOC</a>\n'
)


@contextmanager
def unseen(address: str) -> Iterator[str]:
    """An address that leads to another one and shows nothing of it; it holds until the end.

    Where no file can be written it is the address itself.

    Args:
        address: with a key in its fragment.
    """
    with ExitStack() as stack:
        try:
            way = stack.enter_context(_file(address)).as_uri()
        except (OSError, RuntimeError):  # the latter: nobody knows where this person's home is
            way = address
        yield way


@contextmanager
def _file(address: str) -> Iterator[Path]:
    # In sight in the home folder: browsers in a sandbox (snap, flatpak) have a /tmp of their own,
    # and see no hidden folders.
    with tempfile.TemporaryDirectory(
        prefix="lacoc-", dir=Path.home(), ignore_cleanup_errors=True
    ) as folder:  # its owner's alone
        path = Path(folder, "lacoc.html")
        with open(path, "x", encoding="utf-8", opener=_private) as file:
            file.write(_LEADS_ON.format(html.escape(address)))
        yield path


def _private(name: str, flags: int) -> int:
    return os.open(name, flags, 0o600)


def open_browser(address: str) -> bool:
    """Show a page in this person's browser; False if there is none to be opened."""
    if sys.platform.startswith("linux") and not any(
        os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER")
    ):
        return False  # a browser for terminals would take the terminal away
    found: list[bool] = []

    def open_it() -> None:
        try:
            found.append(webbrowser.open(address))
        except (webbrowser.Error, OSError):
            found.append(False)

    # Some browsers are waited for until they are closed.
    opening = threading.Thread(target=open_it, daemon=True)
    opening.start()
    opening.join(_BROWSER_S)
    return not found or found[0]
