"""Keeps a copy of what other pages say about their contest, for a gateway without any secret."""

import ssl
import threading
import urllib.error
import urllib.request
from pathlib import Path
from typing import Self

from lacoc_shared.command.replacing import write

_EVERY_S = 2.0
_WAIT_S = 10.0
_MOST_BYTES = 16 << 20


class SheetMirror:
    """Copies the newest sheet of a contest from its pages into a file; a context manager.

    While the pages do not answer, the file stays as it was.

    Args:
        pages: address of the pages.
        authority: certificate (PEM) of the pages' own authority; "": none.
        path: the file.
    """

    def __init__(self, pages: str, authority: str, path: Path) -> None:
        self._address = f"{pages}/contest.json"
        self._context = ssl.create_default_context(cadata=authority) if authority else None
        self._path = path
        self._tag = ""
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, name="mirror", daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ended.set()

    def _run(self) -> None:
        while True:
            self._copy()
            if self._ended.wait(_EVERY_S):
                return

    def _copy(self) -> None:
        asked = urllib.request.Request(self._address, headers={"If-None-Match": self._tag})
        try:
            with urllib.request.urlopen(asked, timeout=_WAIT_S, context=self._context) as answer:
                data = answer.read(_MOST_BYTES)
                self._tag = answer.headers.get("ETag", "")
            write(self._path, data)
        except (OSError, ValueError):  # also 304: what is here is the newest
            return
