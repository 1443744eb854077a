"""The files of a record: segments while a match runs; afterwards one compressed, packed file."""

import re
from pathlib import Path

from lacoc_shared.command.holding import hold
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

_SEGMENT = re.compile(r"(?P<match_id>.+)\.(?P<segment>\d{3,})\.live\.mcap")


def segment_path(folder: Path, match_id: str, segment: int) -> Path:
    """Return the path of a segment of a match's record."""
    return folder / f"{match_id}.{segment:03d}.live.mcap"


def packed_path(folder: Path, match_id: str) -> Path:
    """Return the path of the one file into which a match's segments are joined (packed)."""
    return folder / f"{match_id}.mcap"


def unfinished_path(packed: Path) -> Path:
    """Return the path at which a record's one packed file is written until it is complete."""
    return packed.with_name(f"{packed.name}.part")


def odds_path(record: Path, match_id: str) -> Path:
    """Return the path of a match's odds, beside its record (`lacoc replay odds`)."""
    return record.parent / f"{match_id}.odds.json"


def segment_name(path: Path) -> tuple[str, int] | None:
    """Return the match id and number of a segment; None if the file's name is not a segment's."""
    name = _SEGMENT.fullmatch(path.name)
    return name and (name["match_id"], int(name["segment"]))


def segment_paths(folder: Path, match_id: str) -> list[Path]:
    """Return the paths of those segments of a match that exist, in order."""
    found = [
        (name[1], path)
        for path in folder.glob("*.live.mcap")
        if (name := segment_name(path)) and name[0] == match_id
    ]
    return [path for _, path in sorted(found)]


def record_paths(path: Path) -> list[Path]:
    """Return the paths of all files of a record.

    Args:
        path: a packed file, or any one of the segments of a match.

    Raises:
        UserError: if there is no such file, or it is a folder.
    """
    if path.is_dir():
        raise UserError(say("recording.folder", folder=str(path)))
    if not path.is_file():
        raise UserError(say("recording.none", file=str(path)))
    name = segment_name(path)
    return segment_paths(path.parent, name[0]) if name else [path]


def is_held(path: Path) -> bool:
    """Return whether another process is working on a segment: writing it, or packing it.

    True also if the file has gone, because packing removes it.
    """
    try:
        with path.open("rb+") as file:
            return not hold(file)
    except FileNotFoundError:  # it was packed just now
        return True
