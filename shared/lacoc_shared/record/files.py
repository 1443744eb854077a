"""Where the files of a record lie: segments while a match runs, one packed file after it."""

import os
import re
from pathlib import Path

from lacoc_shared.mistakes import UserError

_SEGMENT = re.compile(r"(?P<match_id>.+)\.(?P<segment>\d{3,})\.live\.mcap")


def segment_path(folder: Path, match_id: str, segment: int) -> Path:
    """The file of one segment."""
    return folder / f"{match_id}.{segment:03d}.live.mcap"


def packed_path(folder: Path, match_id: str) -> Path:
    """The one file that the segments become."""
    return folder / f"{match_id}.mcap"


def segment_paths(folder: Path, match_id: str) -> list[Path]:
    """The segments of a match that are there, in their order."""
    found = [
        (int(name["segment"]), path)
        for path in folder.glob("*.live.mcap")
        if (name := _SEGMENT.fullmatch(path.name)) and name["match_id"] == match_id
    ]
    return [path for _, path in sorted(found)]


def record_paths(path: Path) -> list[Path]:
    """All files of the record that a path belongs to.

    Args:
        path: a packed file, or any one of the segments of a match.

    Raises:
        UserError: if there is no such file.
    """
    if not path.is_file():
        raise UserError(f"There is no record {path}. Give the path of a .mcap file.")
    name = _SEGMENT.fullmatch(path.name)
    return segment_paths(path.parent, name["match_id"]) if name else [path]


def sync_folder(folder: Path) -> None:
    """Bring the names in a folder to the disk, so that a new file survives a power cut.

    Raises:
        OSError: if the disk refuses. Where folders can't be opened (Windows) nothing is done.
    """
    if os.name != "posix":
        return
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
