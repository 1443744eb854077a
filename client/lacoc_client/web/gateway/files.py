"""Files that a gateway serves: built pages, a contest's sheet, pieces of a match, JSON."""

import gzip
import hashlib
import mimetypes
from pathlib import Path
from typing import NamedTuple

from lacoc_shared.words import say

PAGES = Path(__file__).parents[2] / "pages"
NOT_BUILT = say("gateway.not-built")

_PACKED_FROM_BYTES = 1024
PIECES_TYPE = "application/vnd.lacoc.piece"
"""Media type of a piece of a match."""
_PACKED = ("text/", "application/json", "image/svg+xml", PIECES_TYPE)
_TYPES = {".js": "text/javascript", ".svg": "image/svg+xml", ".wasm": "application/wasm"}


class PageFile(NamedTuple):
    """A file as a gateway serves it."""

    data: bytes
    packed: bytes | None
    """The data compressed with gzip; None: the data is short, or not a text."""
    media_type: str
    hash: str
    """A hash of the data, by which a browser sees whether its copy is the newest."""


class PageFiles:
    """The files of a folder; each version of a file is read and compressed once."""

    def __init__(self, folder: Path = PAGES) -> None:
        self._folder = folder.resolve()
        self._files: dict[Path, tuple[int, PageFile]] = {}
        """Files by their real path, because one file can be asked for with many spellings."""

    @property
    def built(self) -> bool:
        """Whether the pages have been built."""
        return (self._folder / "index.html").is_file()

    def find(self, name: str) -> PageFile | None:
        """Return a file by its path in the folder; None if it does not exist or lies outside."""
        try:
            path = (self._folder / name).resolve()
            if not path.is_relative_to(self._folder) or not path.is_file():
                return None
            version = path.stat().st_mtime_ns
            known, file = self._files.get(path, (0, None))
            if file is None or known != version:
                file = _read(path)
                self._files[path] = version, file
        except (OSError, ValueError):  # a NUL in the name, or a file being rebuilt
            return None
        return file


def _read(path: Path) -> PageFile:
    kind = _TYPES.get(path.suffix) or mimetypes.guess_type(path.name)[0]
    kind = kind or "application/octet-stream"
    return page_file(path.read_bytes(), kind)


def page_file(data: bytes, kind: str) -> PageFile:
    """Make the file that a gateway serves, from its bytes and its media type."""
    packed = None
    if len(data) >= _PACKED_FROM_BYTES and kind.startswith(_PACKED):
        packed = gzip.compress(data, 9, mtime=0)
    name = hashlib.blake2b(data, digest_size=12).hexdigest()
    return PageFile(data, packed, kind, name)
