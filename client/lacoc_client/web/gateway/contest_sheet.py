"""The sheet of a contest, which its office writes again and again: the parts that clients read."""

from pathlib import Path

import msgspec

NAME = "contest.json"
"""Name of the file."""


class SheetGame(msgspec.Struct, frozen=True):
    """A game that counts, or a void one."""

    record: str = ""
    """File name of its record; "": it has none."""
    outcome: str = ""


class SheetMatch(msgspec.Struct, frozen=True):
    """A match, with the games of it that were played."""

    games: tuple[SheetGame, ...] = ()


class SheetStage(msgspec.Struct, frozen=True):
    """A stage that was drawn."""

    matches: tuple[SheetMatch, ...] = ()


class SheetDay(msgspec.Struct, frozen=True):
    """Whether games are called now."""

    paused: bool = False
    until_ms: int = 0
    reason: str = ""


class SheetLine(msgspec.Struct, frozen=True):
    """The organiser's line to all."""

    text: str = ""


class PublishedSheet(msgspec.Struct, frozen=True):
    """The part of a sheet that clients read."""

    stages: tuple[SheetStage, ...] = ()
    day: SheetDay = SheetDay()
    announced: SheetLine | None = None

    @property
    def games(self) -> list[SheetGame]:
        """All games, in the sheet's order."""
        return [game for stage in self.stages for match in stage.matches for game in match.games]


def read(path: Path) -> PublishedSheet:
    """Read a sheet.

    Raises:
        OSError: if the file can't be read.
        ValueError: if it is no sheet.
    """
    return msgspec.json.decode(path.read_bytes(), type=PublishedSheet)


class NewestSheet:
    """Reads a sheet whenever it has changed.

    Args:
        path: the sheet, which need not exist yet.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._read: tuple[int, PublishedSheet] = (0, PublishedSheet())

    def take(self) -> PublishedSheet | None:
        """Return the newest sheet; None: there is none, or it can't be read now."""
        try:
            version = self._path.stat().st_mtime_ns
            if self._read[0] != version:
                self._read = version, read(self._path)
        except (OSError, ValueError):  # it is looked at again
            return None
        return self._read[1]
