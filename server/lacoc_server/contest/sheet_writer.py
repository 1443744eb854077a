"""Writes the sheet of a contest for pages, while its games are played."""

import time
from collections.abc import Callable

from lacoc_server.contest import sheet as sheets
from lacoc_server.contest.folder import ContestFolder
from lacoc_server.contest.league.contest import Contest
from lacoc_server.contest.publish import write
from lacoc_server.contest.sheet import ContestSheet
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

_SHEET_S = 2.0
"""Shortest time between two sheets."""

Progress = Callable[[int, int], None]
"""Called with how many matches are decided, and how many there are so far."""


class SheetWriter:
    """Writes the sheet of a contest for pages now and then."""

    def __init__(self, where: ContestFolder, progress: Progress) -> None:
        self._where = where
        self._progress = progress
        self._written_s = float("-inf")
        self._contest: Contest | None = None

    def __call__(self, contest: Contest) -> None:
        """Take note of the contest as it is now."""
        self._contest = contest
        matches = [match for view in contest.stages for match in view.matches]
        self._progress(sum(match.decided for match in matches), len(matches))
        if time.monotonic() - self._written_s > _SHEET_S:
            self.write()

    def write(self) -> ContestSheet:
        """Write the sheet of the contest as it is now, and return it."""
        assert self._contest is not None
        made = sheets.sheet(self._where.contest.name, self._contest)
        try:
            write(self._where.sheet, sheets.encode(made))
        except OSError as error:
            why, path = error.strerror or str(error), str(self._where.sheet)
            raise UserError(say("command.cannot-write", path=path, why=why)) from None
        self._written_s = time.monotonic()
        return made
