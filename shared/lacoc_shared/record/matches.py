"""The matches of a court in a folder of records: their names, and which of them are over."""

import os
import re
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path

from mcap.writer import MCAP0_MAGIC

from lacoc_shared.record import files

_ID = re.compile(r"(?P<opened>[0-9]{8}-[0-9]{6})-(?P<court>.+)-(?P<number>[0-9]{3}|[1-9][0-9]{3,})")
_TIME = "%Y%m%d-%H%M%S"


@dataclass(frozen=True, order=True)
class MatchName:
    """A match id in parts: when the match was opened, at which court, and its number there.

    Matches of one court sort in the order in which they were opened.
    """

    opened: str
    """Time (UTC) when the match was opened, in the form 20260501-100000."""
    number: int
    """Number of the match at its court, from 1."""
    court: str

    def __str__(self) -> str:
        return f"{self.opened}-{self.court}-{self.number:03d}"

    @classmethod
    def new(cls, folder: Path | None, court: str, number: int) -> "MatchName":
        """Make the name of a match that is opened now.

        It gets a later time than all matches of the court in the folder, also if the clock was set
        back since, or the court is started twice within a second.

        Args:
            folder: folder of the court's records; None: the name need not be free.
            court: the court's name.
            number: number of the match at its court.
        """
        opened = datetime.now(UTC)
        if folder is not None and (matches := court_matches(folder, court)):
            newest = _time_of(next(reversed(matches)).opened)
            opened = max(opened, newest + timedelta(seconds=1))
        return cls(opened.strftime(_TIME), number, court)

    @classmethod
    def parse(cls, match_id: str) -> "MatchName | None":
        """Read a match id into its parts; None if it is not one that a court makes."""
        found = _ID.fullmatch(match_id)
        if found is None:
            return None
        try:
            _time_of(found["opened"])
        except ValueError:
            return None
        return cls(found["opened"], int(found["number"]), found["court"])


def _time_of(opened: str) -> datetime:
    return datetime.strptime(opened, _TIME).replace(tzinfo=UTC)


def court_matches(folder: Path, court: str) -> dict[MatchName, dict[int, Path]]:
    """Return the recorded matches of a court, the oldest first, each with its segments by number.

    A match without segments has all of them joined in one packed file.
    """
    found: dict[MatchName, dict[int, Path]] = {}
    for path in sorted(folder.glob("*.mcap")):
        segment = files.segment_name(path)
        name = MatchName.parse(path.stem if segment is None else segment[0])
        if name is None or name.court != court:
            continue
        segments = found.setdefault(name, {})
        if segment is not None:
            segments[segment[1]] = path
    return {name: dict(sorted(found[name].items())) for name in sorted(found)}


def is_over(name: MatchName, segments: Mapping[int, Path]) -> bool:
    """Return whether a match is over: its court has ended it, so no court will continue it."""
    if not segments:
        return True
    newest = segments[max(segments)]
    return files.packed_path(newest.parent, str(name)).exists() or _is_finished(newest)


def unpacked(folder: Path, court: str) -> list[str]:
    """Return the ids of a court's matches that are over, but whose segments are not joined yet.

    A match whose files a process still has open is left out.
    """
    return [
        str(name)
        for name, segments in court_matches(folder, court).items()
        if segments and is_over(name, segments) and not any(map(files.is_held, segments.values()))
    ]


def _is_finished(segment: Path) -> bool:
    """Return whether a segment was ended properly; a court that is killed or fails ends none."""
    try:
        with segment.open("rb") as file:
            if file.seek(0, os.SEEK_END) < 2 * len(MCAP0_MAGIC):
                return False
            file.seek(-len(MCAP0_MAGIC), os.SEEK_END)
            return file.read() == MCAP0_MAGIC
    except FileNotFoundError:  # only packing removes a segment
        return True
