"""The recordings that a gateway serves: finished ones, copies of matches just over, and forks.

A court joins the segments of a match's record into one file when the next match opens. Until then
the match that has just ended would be missing from the list. So the gateway makes a copy of its
segments as one file.
"""

import contextlib
import subprocess
from collections.abc import Callable, Collection, Iterable
from datetime import UTC, datetime
from pathlib import Path
from threading import Lock

import msgspec

from lacoc_shared.command import regular
from lacoc_shared.command.scratch import Scratch
from lacoc_shared.mistakes import UserError
from lacoc_shared.record import files
from lacoc_shared.record.pack import copy_in_background
from lacoc_shared.record.summary import Summary, summary

_RECORDING = ".mcap"
_SEGMENT = ".live.mcap"  # a match that is still being recorded
_KEPT = 2000
_ODDS_BYTES = 1 << 20
"""A file of odds above this size is not served; one of 50 moments has 10 kB."""


class ListedRecord(msgspec.Struct, frozen=True):
    """One recording, as the list of recordings shows it."""

    name: str
    bytes: int
    modified: str
    """Time when the recording last changed, ISO 8601, UTC."""
    match: Summary | None
    """Summary of the match; None: the file contains no summary."""


class Recordings:
    """The recordings of one folder; its methods may be called from any thread.

    A symbolic link does not count as a recording: it could lead to any file of the machine.

    Args:
        folder: the folder; None: there are no recordings.
        over: returns the ids of the matches that are over but still open at their courts.
        shown: returns the names of those recordings in the folder that everybody may see; None: all
            of them.
    """

    def __init__(
        self,
        folder: Path | None,
        over: Callable[[], Iterable[str]],
        shown: Callable[[], Collection[str]] | None = None,
    ) -> None:
        self._folder = folder
        self._over = over
        self._shown = shown
        self._copies = Scratch("recordings")
        self.own = self._copies.path
        """Folder of the gateway's own recordings: copies, and forks that pages asked for."""
        self._copying: dict[str, subprocess.Popen[bytes]] = {}
        self._summaries: dict[tuple[Path, int, int], Summary | None] = {}
        self._lock = Lock()

    def listed(self) -> list[ListedRecord]:
        """List all recordings that may be seen, the newest first; start to copy missing ones."""
        with self._lock:
            self._copy()
            found = []
            for path in self._paths().values():
                with contextlib.suppress(FileNotFoundError):  # it was moved at this moment
                    stat = path.stat()
                    found.append((stat.st_mtime, path, stat))
            return [
                ListedRecord(
                    path.name,
                    stat.st_size,
                    datetime.fromtimestamp(at_s, UTC).isoformat(timespec="seconds"),
                    self._summary(path, stat.st_mtime_ns, stat.st_size),
                )
                for at_s, path, stat in sorted(found, reverse=True)
            ]

    def find(self, name: str) -> Path | None:
        """Return a recording's path by its name; None if there is none."""
        return self._paths().get(name)

    def odds(self, name: str) -> bytes | None:
        """Read the odds of a recording; None if there are none, or their file is too large."""
        if self._folder is None or self.find(name) is None:
            return None
        path = files.odds_path(self._folder / name, name.removesuffix(_RECORDING))
        with contextlib.suppress(UserError):
            return regular.read(self._folder, path.name, most_bytes=_ODDS_BYTES)
        return None

    def close(self) -> None:
        """Delete the gateway's own recordings: copies and forks."""
        for copying in self._copying.values():
            copying.terminate()
            copying.wait()
        self._copies.close()

    def _paths(self) -> dict[str, Path]:
        if self._folder is None:
            return {}
        own = self.own.glob(f"*{_RECORDING}")
        packed = list(self._folder.glob(f"*{_RECORDING}"))
        if self._shown is not None:
            shown = self._shown()
            packed = [path for path in packed if path.name in shown]
        return {
            path.name: path
            for path in (*own, *packed)
            if regular.is_regular(path) and not path.name.endswith(_SEGMENT)
        }

    def _copy(self) -> None:
        """Start to copy the segments of matches that are over but have no finished record yet.

        Copy none if the contest shows only some of its recordings.
        """
        folder = self._folder
        for match_id in self._over() if folder is not None and self._shown is None else ():
            assert folder is not None
            segments = files.segment_paths(folder, match_id)
            if match_id in self._copying or not segments:
                continue
            out = files.packed_path(self.own, match_id)
            with contextlib.suppress(OSError):  # no resources for a process: it is packed later
                self._copying[match_id] = copy_in_background(segments, out)

    def _summary(self, path: Path, modified_ns: int, size: int) -> Summary | None:
        key = (path, modified_ns, size)
        if key not in self._summaries:
            if len(self._summaries) >= _KEPT:
                self._summaries.clear()
            self._summaries[key] = summary(path)
        return self._summaries[key]
