"""The records that a contest which keeps some back shows: those that its sheet names."""

from pathlib import Path

import msgspec


class _Game(msgspec.Struct):
    record: str = ""


class _Match(msgspec.Struct):
    games: tuple[_Game, ...] = ()


class _Stage(msgspec.Struct):
    matches: tuple[_Match, ...] = ()


class _Sheet(msgspec.Struct):
    stages: tuple[_Stage, ...] = ()


class ShownRecords:
    """The names of these records, as the newest sheet says; may be used from any thread.

    Args:
        sheet: the newest sheet of the contest, which its office writes.
    """

    def __init__(self, sheet: Path) -> None:
        self._path = sheet
        self._known: tuple[int, frozenset[str]] = (0, frozenset())

    def __call__(self) -> frozenset[str]:
        """Return the names; none before there is a sheet."""
        try:
            version = self._path.stat().st_mtime_ns
            if self._known[0] != version:
                sheet = msgspec.json.decode(self._path.read_bytes(), type=_Sheet)
                matches = (match for stage in sheet.stages for match in stage.matches)
                records = (game.record for match in matches for game in match.games)
                self._known = version, frozenset(Path(one).name for one in records if one)
        except (OSError, msgspec.MsgspecError):
            return frozenset()
        return self._known[1]
