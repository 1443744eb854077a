"""Open matches: friendly matches at courts that have no game; no fact is appended for them.

Their state is only at the courts. So an office that was started again goes on with them.
"""

import math
import secrets
from collections.abc import Callable, Iterator, Mapping

from lacoc_server.contest.kept.plans import OpenStage
from lacoc_server.contest.league.timetable.calling import OPEN_CALL, SeenCourt, is_open_call
from lacoc_server.contest.live.court_link import Asked, CourtLink
from lacoc_shared.contest.tokens import lasting_hash
from lacoc_shared.messages import Done, Refusal
from lacoc_shared.messages.office import Whereabouts, open_match
from lacoc_shared.seat import Phase
from lacoc_shared.words import Phrase, say

_SHOWN_S = 10.0
"""A result is shown for this long before the next open match follows it [s]."""
_AGAIN_S = 1.0
_OVER = (Phase.OFFICIAL, Phase.VOID)


class OpenMatches:
    """Assigns open matches to courts; never waits for an answer.

    Args:
        stage: the stage of open matches.
        token_of: returns the token of a court's open seat.
        tell: called with a phrase if a court refuses its open match.
    """

    def __init__(
        self,
        stage: OpenStage,
        token_of: Callable[[str, str], str],
        tell: Callable[[Phrase], None] = lambda _: None,
    ) -> None:
        self._stage = stage
        self._token_of = token_of
        self._tell = tell
        self._next: dict[str, str] = {}
        """By court: the call of its next open match, until the court has this match."""
        self._over: dict[str, tuple[str, float]] = {}
        """By court: the call of a match that is over, and when that was seen [s]."""
        self._asked: dict[str, Asked[Done]] = {}
        self._asked_s: dict[str, float] = {}
        self._refused: dict[str, Phrase] = {}

    def look(self, link: CourtLink, now_s: float) -> None:
        """Give the next open match to a court if it is free.

        This is called only for courts that have no game of the contest.

        Args:
            link: the connection to the court.
            now_s: the time of a clock that nobody sets, such as `time.monotonic` [s].
        """
        court, call = link.court, link.call
        if not self._is_answered(court) or call is None:
            return
        if call == self._next.get(court):
            del self._next[court]
        if not self._is_free(link, call, now_s):
            return
        if now_s - self._asked_s.get(court, -math.inf) < _AGAIN_S:
            return
        self._asked_s[court] = now_s
        stage, call = self._stage, self._next.setdefault(court, new_call())
        tokens = {seat: [lasting_hash(self._token_of(court, seat))] for seat in stage.seats}
        assigned = open_match(tokens, call)
        self._asked[court] = link.assign(
            call,
            assigned.fixture,
            assigned.seats,
            arena=stage.arena,
            arena_settings=stage.arena_settings,
            limits=stage.limits,
        )

    def whereabouts(
        self, seen: Mapping[str, SeenCourt], addresses: Mapping[str, str]
    ) -> Iterator[tuple[str, Whereabouts]]:
        """Yield for each open seat its token, and either its open match or that it waits for one.

        Args:
            seen: the courts.
            addresses: their addresses for contestants.
        """
        for court, one in seen.items():
            for seat in self._stage.seats:
                there = Whereabouts(
                    team="",
                    state="waits",
                    said=say("team.open-waits", court=court),
                    court=court,
                    open=True,
                )
                if is_open_call(one.call):
                    there = Whereabouts(
                        team="",
                        state="court",
                        said=say("team.open-seat", court=court, seat=seat),
                        court=court,
                        address=addresses[court],
                        seat=seat,
                        call=one.call,
                        fixture=say("fixture.open"),
                        open=True,
                    )
                yield self._token_of(court, seat), there

    def _is_answered(self, court: str) -> bool:
        asked = self._asked.get(court)
        answer = None if asked is None else asked.take()
        if asked is not None and answer is None:
            return False
        self._asked.pop(court, None)
        if not isinstance(answer, Refusal) or answer.again:
            return True
        if self._refused.get(court) != answer.why:
            self._refused[court] = answer.why
            self._tell(say("news.open-refused", court=court, why=answer.why))
        return True

    def _is_free(self, link: CourtLink, call: str, now_s: float) -> bool:
        """Return whether a court can get an open match.

        It can if it has no match, or has shown the result of its match for long enough.
        """
        if not call:
            return True
        if link.phase not in _OVER:
            self._over.pop(link.court, None)
            return False
        known, since_s = self._over.setdefault(link.court, (call, now_s))
        if known != call:
            self._over[link.court] = call, now_s
            return False
        return now_s - since_s >= _SHOWN_S


def new_call() -> str:
    """Make an id for the call of an open match."""
    return f"{OPEN_CALL}{secrets.token_hex(8)}"
