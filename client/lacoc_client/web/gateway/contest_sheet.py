"""The parts of a contest's sheet that clients read; the office writes the sheet again and again."""

from pathlib import Path

import msgspec

NAME = "contest.json"
"""Name of the sheet's file."""


class SheetGame(msgspec.Struct, frozen=True):
    """A game that was played in a match of the contest; also a game that was declared void."""

    record: str = ""
    """File name of the game's record; "": it has no record."""
    outcome: str = ""
    scores: tuple[int, ...] = ()
    """The points that count, by seat: the court's, or those that the organiser gave instead."""


class SheetMatch(msgspec.Struct, frozen=True):
    """A match of the contest, with those of its games that were played."""

    games: tuple[SheetGame, ...] = ()


class SheetStage(msgspec.Struct, frozen=True):
    """A stage of the contest whose draw has been made."""

    matches: tuple[SheetMatch, ...] = ()


class SheetDay(msgspec.Struct, frozen=True):
    """Whether the office gives games to courts now, or the contest is paused."""

    paused: bool = False
    until_ms: int = 0
    reason: str = ""


class SheetLine(msgspec.Struct, frozen=True):
    """A line of text from the organiser to everybody."""

    text: str = ""


class PublishedSheet(msgspec.Struct, frozen=True):
    """The part of a contest's sheet that clients read."""

    stages: tuple[SheetStage, ...] = ()
    day: SheetDay = SheetDay()
    announced: SheetLine | None = None

    @property
    def games(self) -> list[SheetGame]:
        """All games of all stages of the contest, in the order of the sheet."""
        return [game for stage in self.stages for match in stage.matches for game in match.games]


def read(path: Path) -> PublishedSheet:
    """Read the sheet of a contest from its file.

    Raises:
        OSError: if the file can't be read.
        ValueError: if it is not a sheet.
    """
    return msgspec.json.decode(path.read_bytes(), type=PublishedSheet)


class NewestSheet:
    """Reads the sheet of a contest again whenever its file has changed.

    Args:
        path: the sheet, which need not exist yet.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._read: tuple[int, PublishedSheet] = (0, PublishedSheet())

    def take(self) -> PublishedSheet | None:
        """Return the contest's newest sheet; None: it has none, or it can't be read now."""
        try:
            version = self._path.stat().st_mtime_ns
            if self._read[0] != version:
                self._read = version, read(self._path)
        except (OSError, ValueError):  # it is looked at again
            return None
        return self._read[1]
