"""The newest result of each court, shown as late as the director shows matches. Pure."""

from collections import deque
from collections.abc import Sequence

import msgspec

from lacoc_shared.seat import Phase
from lacoc_shared.words import Phrase

_SHOWN = 6
"""How many results are shown at most."""


class ShownResult(msgspec.Struct, frozen=True):
    """The result of a match, as pages show it."""

    court: str
    match: str
    """Id of the match."""
    title: str
    """Title of the game."""
    fixture: Phrase | None
    """The name of the match in its contest; None: it is in no contest."""
    teams: tuple[str, ...]
    """Names of the teams by seat."""
    scores: tuple[int, ...]
    phase: Phase


class Results:
    """Keeps the newest result of each court.

    Args:
        behind_s: how long after a result became known it is shown [s].
    """

    def __init__(self, behind_s: float) -> None:
        self._behind_s = behind_s
        self._known: dict[str, ShownResult] = {}
        """The newest result of each court; the newest of all is the last."""
        self._later: deque[tuple[float, tuple[ShownResult, ...]]] = deque()
        """Pairs of a time and the results that are shown from then on."""
        self._shown: tuple[ShownResult, ...] = ()

    def see(
        self, now_s: float, over: Sequence[ShownResult], going: Sequence[tuple[str, str]]
    ) -> None:
        """Note which matches are over now and which are not.

        Args:
            now_s: the time, by a clock that never goes back [s].
            over: the matches that are over; a referee may still correct one.
            going: court and match of each match that is not over. If a match was over before,
                and a referee has corrected this, its result is dropped.
        """
        before = tuple(self._known.values())
        for court, match in going:
            if court in self._known and self._known[court].match == match:
                del self._known[court]
        for one in over:
            known = self._known.get(one.court)
            if known is not None and known.match != one.match:
                del self._known[one.court]  # the new one is the newest of all
            self._known[one.court] = one
        if (after := tuple(self._known.values())) != before:
            self._later.append((now_s + self._behind_s, after))

    def shown(self, now_s: float) -> tuple[ShownResult, ...]:
        """Return the results that pages show at a time, the newest first."""
        while self._later and self._later[0][0] <= now_s:
            self._shown = self._later.popleft()[1]
        return self._shown[-_SHOWN:][::-1]
