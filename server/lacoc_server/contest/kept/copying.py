"""Keeps copies of records in the contest's folder here, while a court elsewhere writes them.

A copy grows while the match is played. It is always the beginning of a record, like the
record of a killed court, so any court can go on from it. After a match, its record is packed: its
segments become one file.
"""

import os
from collections.abc import Mapping
from enum import Enum
from pathlib import Path

from lacoc_shared.command.replacing import sync_folder
from lacoc_shared.messages.office import Copied
from lacoc_shared.mistakes import UserError
from lacoc_shared.record import files
from lacoc_shared.words import say


class Taken(Enum):
    """What another machine's answer added to the copy of a match's record."""

    MORE = "more"
    """The copy has grown."""
    NOTHING = "nothing"
    """The answer does not continue the copy: the other machine has no more at present."""
    WHOLE = "whole"
    """The finished record is here completely, as one file."""


def have(folder: Path, match_id: str) -> dict[str, int]:
    """Return the files of a match's record that this machine has, each with its length in bytes.

    Args:
        folder: folder of the records.
        match_id: the match.
    """
    packed = files.packed_path(folder, match_id)
    paths = [*files.segment_paths(folder, match_id), _unfinished(packed)]
    sizes = {path.name: path.stat().st_size for path in paths if path.exists()}
    if (size := sizes.pop(_unfinished(packed).name, None)) is not None:
        sizes[packed.name] = size
    return sizes


def take(folder: Path, match_id: str, part: Copied) -> Taken:
    """Add a part to the copy of a match's record; a part that does not continue it is dropped.

    Args:
        folder: folder of the records; it is made.
        match_id: the match.
        part: what the other machine answered when it was told what this copy has (`have`).

    Raises:
        UserError: if the copy can't be written.
    """
    packed = files.packed_path(folder, match_id)
    try:
        if part.is_whole:
            _finish(folder, match_id, packed)
            return Taken.WHOLE
        if not continues(match_id, have(folder, match_id), part):
            return Taken.NOTHING
        path = folder / part.file
        folder.mkdir(parents=True, exist_ok=True)
        with (_unfinished(packed) if path == packed else path).open("ab") as file:
            file.write(part.data)
    except OSError as error:
        why = error.strerror or str(error)
        raise UserError(say("command.cannot-write", path=str(folder), why=why)) from None
    return Taken.MORE


def _finish(folder: Path, match_id: str, packed: Path) -> None:
    """Give the complete copy of a finished record its final name; delete the match's segments."""
    unfinished = _unfinished(packed)
    if not unfinished.exists():
        return
    with unfinished.open("rb+") as file:
        os.fsync(file.fileno())
    unfinished.rename(packed)
    for segment in files.segment_paths(folder, match_id):
        segment.unlink(missing_ok=True)
    sync_folder(folder)


def continues(match_id: str, have: Mapping[str, int], part: Copied) -> bool:
    """Return whether a part belongs to a match's record, and begins where this machine's copy ends.

    So a machine that only pretends to be the court can't write other files on this machine.

    Args:
        match_id: the match.
        have: length in bytes of each file that this machine has, by the file's name.
        part: what the other machine sent.
    """
    segment = files.segment_name(Path(part.file))
    is_segment = segment is not None and segment[0] == match_id
    is_named = is_segment or part.file == f"{match_id}.mcap"
    return is_named and Path(part.file).name == part.file and part.offset == have.get(part.file, 0)


def _unfinished(packed: Path) -> Path:
    """Return the path for the copy of a finished record, as long as the copy is not complete."""
    return packed.with_name(f"{packed.name}.copy")
