"""Copies the records of a court on another machine, over the office's connection to that court."""

import time
from pathlib import Path

from lacoc_server.contest.kept.copying import Taken, have, take
from lacoc_server.contest.live.court_link import Asked, CourtLink
from lacoc_shared.messages.office import Copied
from lacoc_shared.record import files
from lacoc_shared.record.matches import MatchName

_AGAIN_S = 0.1
"""Time between two requests for more of a record [s]."""


class RecordCopy:
    """Copies records of one court; `step` is called again and again, and never waits for the court.

    Args:
        folder: folder of the contest's records.
        court: the court's name.
    """

    def __init__(self, folder: Path, court: str) -> None:
        self._folder = folder
        self._court = court
        self._wanted: list[str] = []
        """Ids of the matches whose records are still to be copied, the next one first."""
        self._asked: tuple[str, Asked[Copied]] | None = None
        """The match whose next part was asked for, and the request; None: no answer is awaited."""
        self._next_s = 0.0

    @property
    def is_whole(self) -> bool:
        """Whether all matches given to `want` are copied completely."""
        return not self._wanted

    def want(self, match_id: str) -> None:
        """Begin to copy a match's record from the court, unless the folder has the whole record."""
        name = MatchName.parse(match_id)
        if name is None or name.court != self._court or match_id in self._wanted:
            return
        if not files.packed_path(self._folder, match_id).exists():
            self._wanted.append(match_id)

    def step(self, link: CourtLink) -> None:
        """Write the part that has arrived, and ask for the next one.

        Raises:
            UserError: if a part can't be written.
        """
        if self._asked is not None:
            match_id, asked = self._asked
            if (answer := asked.take()) is None:
                return
            self._asked = None
            if isinstance(answer, Copied):
                self._take(match_id, answer)
        now_s = time.monotonic()
        if self._wanted and link.is_there and now_s >= self._next_s:
            self._next_s = now_s + _AGAIN_S
            match_id = self._wanted[0]
            self._asked = match_id, link.copy(match_id, have(self._folder, match_id))

    def _take(self, match_id: str, part: Copied) -> None:
        match take(self._folder, match_id, part):
            case Taken.WHOLE:
                self._wanted.remove(match_id)
            case Taken.NOTHING:
                self._wanted.append(self._wanted.pop(0))  # the other matches, then this one again
            case Taken.MORE:
                self._next_s = 0.0
