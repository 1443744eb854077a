"""What the director knows of a court at one time. Pure."""

from typing import NamedTuple

from lacoc_client.web.director.stakes import USUAL
from lacoc_shared.seat import Phase

LAST_S = 30.0
"""Length of the last part of a match [s]: in it the director does not cut away from a close
match."""

_CLOSE = 0.2
"""A match is close while the difference is at most this share of all points."""

OVER = (Phase.FINISHED, Phase.OFFICIAL, Phase.VOID)
"""The phases after the end of a match: the match has a result, or is void."""


class CourtNow(NamedTuple):
    """How the match at a court stands at one time."""

    name: str
    match: str
    """Id of the match. Points and moments of one match do not carry over to the next."""
    phase: Phase
    left_s: float | None
    """Time left of the match [s]; None: it has no time limit."""
    scores: tuple[int, ...]
    """Points of each seat."""
    stake: float = USUAL
    """Weight of the match in its contest; see `stakes.stake`."""
    has_begun: bool = False
    """Whether the clock of the match has run. If so, a countdown resumes a halted match."""

    @property
    def ahead(self) -> int:
        """How many points the first seat is ahead; negative: the second seat leads."""
        return self.scores[0] - self.scores[1] if len(self.scores) > 1 else 0

    @property
    def is_close(self) -> bool:
        """Whether the points of the two seats differ by at most a fifth of their sum."""
        return len(self.scores) > 1 and abs(self.ahead) <= _CLOSE * sum(map(abs, self.scores))

    @property
    def is_played(self) -> bool:
        """Whether the match is in play, halted, or in a countdown after the clock has run."""
        resumes = self.phase is Phase.COUNTDOWN and self.has_begun
        return resumes or self.phase in (Phase.PLAYING, Phase.HALTED)

    @property
    def is_over(self) -> bool:
        """Whether the match has a result, or is void."""
        return self.phase in OVER

    @property
    def is_closing(self) -> bool:
        """Whether the last 30 s of a close match are being played."""
        return (
            self.is_played and self.left_s is not None and self.left_s <= LAST_S and self.is_close
        )
