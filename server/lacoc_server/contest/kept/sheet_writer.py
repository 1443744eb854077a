"""Writes the sheet of a contest for pages, while its games are played."""

import time
from collections.abc import Callable, Mapping

from lacoc_server.contest.kept.folder import ContestFolder
from lacoc_server.contest.kept.replays import shown
from lacoc_server.contest.league import sheet as sheets
from lacoc_server.contest.league.contest import Contest
from lacoc_server.contest.league.sheet import ContestSheet
from lacoc_shared.command.replacing import write
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

_SHEET_S = 1.0
"""Shortest time between two writings of the sheet [s]."""
_LEAST_SHARE = 10
"""After a sheet, wait at least this many times as long as it took to compute. With 200 teams the
ratings alone take a second."""

Progress = Callable[[int, int], None]
"""Called with the number of decided matches, and the number of all matches so far."""


class SheetWriter:
    """Writes the sheet of a contest for pages, soon after each change but not too often.

    Args:
        where: the contest.
        progress: called with the numbers of decided and of all matches, after each change.
    """

    def __init__(self, where: ContestFolder, progress: Progress) -> None:
        self._where = where
        self._progress = progress
        self._contest: Contest | None = None
        self._expected = sheets.EXPECTED_NOTHING
        self._is_new = False
        self._next_s = 0.0

    def __call__(
        self,
        contest: Contest,
        expected: Mapping[str, tuple[str, int]] = sheets.EXPECTED_NOTHING,
    ) -> None:
        """Report progress if the contest has changed.

        Write its sheet if it has changed and enough time has passed. Call this again and again,
        also without a change, so that a sheet that had to wait is written.

        Args:
            contest: the contest as it is now; the same object as before if nothing has changed.
            expected: where and when matches to come will probably begin, by pairing.

        Raises:
            UserError: if the sheet can't be written.
        """
        if contest is not self._contest:
            self._contest, self._is_new = contest, True
            matches = [match for view in contest.stages for match in view.matches]
            self._progress(sum(match.decided for match in matches), len(matches))
        if expected != self._expected:
            self._expected, self._is_new = expected, True
        if self._is_new and time.monotonic() >= self._next_s:
            self.write()

    def write(self) -> ContestSheet:
        """Write the sheet for pages, without the records that are still hidden.

        Return the complete sheet.

        Raises:
            UserError: if it can't be written.
        """
        assert self._contest is not None
        begun_s = time.monotonic()
        file = self._where.contest
        made = sheets.sheet(file.name, self._contest, self._expected, file.closes_ms)
        public = shown(made, file.replays)
        try:
            write(self._where.sheet, sheets.encode(public))
        except OSError as error:
            why, path = error.strerror or str(error), str(self._where.sheet)
            raise UserError(say("command.cannot-write", path=path, why=why)) from None
        ended_s = time.monotonic()
        self._is_new = False
        self._next_s = ended_s + max(_SHEET_S, _LEAST_SHARE * (ended_s - begun_s))
        return made
