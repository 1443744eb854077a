"""The files a gateway gives away: the built pages, and recordings."""

import gzip
import mimetypes
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, NamedTuple

PAGES = Path(__file__).parents[1] / "pages"
NOT_BUILT = (
    "The pages are not built: run 'npm ci && npm run build' in client/web, "
    "or install lacoc from its wheel."
)

_RECORDING = ".mcap"
_SEGMENT = ".live.mcap"  # of a match that is still being recorded
_PACKED_FROM_BYTES = 1024
_PACKED = ("text/", "application/json", "image/svg+xml")
_TYPES = {".js": "text/javascript", ".svg": "image/svg+xml", ".wasm": "application/wasm"}


class PageFile(NamedTuple):
    """A file of the pages."""

    data: bytes
    packed: bytes | None
    """The same with gzip, if that is shorter."""
    media_type: str


class PageFiles:
    """The built pages; each file is read and packed once."""

    def __init__(self, folder: Path = PAGES) -> None:
        self._folder = folder.resolve()
        self._files: dict[tuple[str, int], PageFile] = {}

    @property
    def built(self) -> bool:
        """Whether there are any."""
        return (self._folder / "index.html").is_file()

    def find(self, name: str) -> PageFile | None:
        """A file by its path below the folder; None: there is none, or it is not below."""
        try:
            path = (self._folder / name).resolve()
            if not path.is_relative_to(self._folder) or not path.is_file():
                return None
            version = path.stat().st_mtime_ns
            file = self._files.get((name, version))
            if file is None:
                file = self._files[name, version] = _read(path)
        except (OSError, ValueError):  # a NUL in the name, a file that is being built anew
            return None
        return file


def _read(path: Path) -> PageFile:
    kind = _TYPES.get(path.suffix) or mimetypes.guess_type(path.name)[0]
    kind = kind or "application/octet-stream"
    data = path.read_bytes()
    packed = None
    if len(data) >= _PACKED_FROM_BYTES and kind.startswith(_PACKED):
        packed = gzip.compress(data, 9, mtime=0)
    return PageFile(data, packed, kind)


def recordings_in(folder: Path | None) -> list[dict[str, Any]]:
    """The finished recordings of a folder, the newest first."""
    found = []
    for path in folder.glob(f"*{_RECORDING}") if folder is not None else ():
        if path.name.endswith(_SEGMENT) or not path.is_file():
            continue
        stat = path.stat()
        found.append((stat.st_mtime, path.name, stat.st_size))
    return [
        {
            "name": name,
            "bytes": size,
            "modified": datetime.fromtimestamp(at_s, UTC).isoformat(timespec="seconds"),
        }
        for at_s, name, size in sorted(found, reverse=True)
    ]


def recording(folder: Path | None, name: str) -> Path | None:
    """A finished recording by its name; None: there is none in the folder."""
    if name not in {entry["name"] for entry in recordings_in(folder)} or folder is None:
        return None
    return folder / name
