"""Finds out whether the segments of an HLS stream are really on the disk.

FFmpeg says nothing when one can't be written.
"""

from pathlib import Path

_PACKET_BYTES = 188
"""Length of a packet of MPEG-TS; a whole segment has only whole packets."""


class SegmentWatch:
    """Looks after the list of an HLS stream and its newest segment.

    Args:
        path: the list.
        patience: after so many pictures without a new segment in the list, it counts as broken.
    """

    def __init__(self, path: Path, patience: int) -> None:
        self._path, self._patience = path, patience
        self._seen = self._state()
        self._unchanged = 0

    def is_whole(self) -> bool:
        """Return whether the stream is on the disk so far; called after each picture."""
        state = self._state()
        if state == self._seen:
            self._unchanged += 1
            return self._unchanged < self._patience
        self._seen, self._unchanged = state, 0
        try:
            lines = self._path.read_text("utf-8").splitlines()
            *_, newest = (line for line in lines if line[:1] != "#")
            size = (self._path.parent / newest).stat().st_size
        except (OSError, ValueError):  # the list or its newest segment is missing, or it has none
            return False
        return size > 0 and size % _PACKET_BYTES == 0

    def _state(self) -> tuple[int, int] | None:
        """Return what changes whenever the list is written; None: there is no list."""
        try:
            found = self._path.stat()
        except OSError:
            return None
        return found.st_mtime_ns, found.st_ino
