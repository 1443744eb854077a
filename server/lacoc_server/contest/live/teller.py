"""Tells every court of a contest where the teams are, so that a team can ask any of them."""

import math
import time
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from secrets import token_bytes

from lacoc_arenas import arena as arenas
from lacoc_server.contest.league.contest import Contest
from lacoc_server.contest.league.facts import AnyFact, Planned
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.league.timetable.calling import SeenCourt
from lacoc_server.contest.league.timetable.foreseen import foreseen
from lacoc_server.contest.league.timetable.whereabouts import (
    ContestPace,
    SeenCourts,
    full_minute,
    game_ms,
    starts,
    whereabouts,
)
from lacoc_server.contest.live.court_link import Asked, CourtLink
from lacoc_server.contest.live.open_matches import OpenMatches
from lacoc_shared import seal
from lacoc_shared.messages import Done
from lacoc_shared.messages.office import Whereabouts
from lacoc_shared.words import say

_LOOK_S = 1.0
"""Time between two estimates of when matches begin, if nothing else has changed [s]."""
_AGAIN_S = 3.0
"""After this time a court is told again where the teams are, even without a change: it may have
restarted [s]."""
_BETWEEN_MS = 60_000
"""Guess for the time from the call of a game to the start of play, until a game has ended [ms]."""
_SALT_BYTES = 16


class Teller:
    """Sends all courts the whereabouts of all teams; never waits for an answer.

    Args:
        links: the courts by name; None: a court that is not connected.
        addresses: their addresses for contestants.
        token_of: returns a team's token.
        least_rest_ms: shortest time between two matches of a team.
        open_matches: says where the open seats are; None: there are none.
        applicants: returns the names of the teams that wait for the organiser.
    """

    def __init__(
        self,
        links: Mapping[str, CourtLink | None],
        addresses: Mapping[str, str],
        token_of: Callable[[str], str],
        least_rest_ms: int,
        open_matches: OpenMatches | None = None,
        applicants: Callable[[], tuple[str, ...]] = tuple,
    ) -> None:
        self._links = links
        self._addresses = addresses
        self._least_rest_ms = least_rest_ms
        salt = token_bytes(_SALT_BYTES)
        self._hash = cache(lambda token: seal.hash_token(token, salt))
        self._token_of = token_of
        self._open_matches = open_matches
        self._applicants = applicants
        self.pace = ContestPace(0, 0, least_rest_ms)
        """How long games take, as of the newest estimate."""
        self.expected: dict[str, tuple[str, int]] = {}
        """By pairing: where and when the next matches will probably begin, by the newest estimate.
        Times are full minutes, so that they seldom change."""
        self._teams: dict[str, Whereabouts] = {}
        self._contest: Contest | None = None
        self._calls: tuple[str, ...] = ()
        self._waiting: tuple[str, ...] = ()
        """`_contest`, `_calls` and `_waiting`: the contest, the courts' calls and the waiting
        teams, as of the newest estimate."""
        self._looked_s = -math.inf
        """When the newest estimate was made; as all times in seconds, of `time.monotonic`."""
        self._first_ms = 0
        self._told: dict[str, tuple[float, dict[str, Whereabouts]]] = {}
        """By court: when it was last told where the teams are, and what it was told."""
        self._asked: dict[str, Asked[Done]] = {}

    def tell(
        self, contest: Contest, facts: Sequence[AnyFact], seen: Mapping[str, SeenCourt], now_ms: int
    ) -> None:
        """Find out where each team plays or waits, and send this to the courts.

        A court is told again if this has changed since the last time, or after `_AGAIN_S`.

        Args:
            contest: the contest.
            facts: its facts, in their order.
            seen: the state of each court, in the order in which they get games.
            now_ms: the time, in milliseconds since 1970, UTC.

        Raises:
            UserError: if a team has no token yet, and a new one can't be written.
        """
        now_s = time.monotonic()
        calls = tuple(court.call for court in seen.values())
        waiting = self._applicants()
        is_new = contest is not self._contest
        is_new = is_new or (calls, waiting) != (self._calls, self._waiting)
        if is_new or now_s - self._looked_s >= _LOOK_S:
            self._contest, self._calls, self._waiting = contest, calls, waiting
            self._looked_s = now_s
            usual_ms = game_ms(facts, self._guess_ms(contest))
            self.pace = ContestPace(now_ms, usual_ms, self._least_rest_ms)
            coming = foreseen(contest, FORMATS)
            begins = dict(starts(contest, coming, seen, self.pace))
            held = contest.day.paused  # nobody knows for how long
            self.expected = {
                pairing: (start.court, 0 if held else full_minute(start.at_ms))
                for pairing, start in begins.items()
            }
            found = whereabouts(contest, SeenCourts(seen, self._addresses), self.pace, begins)
            awaits = say("team.awaits-approval")
            applied = {name: Whereabouts(team=name, state="waits", said=awaits) for name in waiting}
            here = [(self._token_of(team), there) for team, there in (applied | found).items()]
            if self._open_matches is not None:
                here += self._open_matches.whereabouts(seen, self._addresses)
            self._teams = {self._hash(token): there for token, there in here}
        for name, link in self._links.items():
            if (asked := self._asked.get(name)) is not None and asked.take() is None:
                continue
            self._asked.pop(name, None)
            told_s, told = self._told.get(name, (-math.inf, {}))
            is_due = now_s - told_s >= _AGAIN_S
            if link is not None and link.is_there and (is_due or told != self._teams):
                self._told[name] = now_s, self._teams
                self._asked[name] = link.tell(self._teams)

    def _guess_ms(self, contest: Contest) -> int:
        """Guess how long a game takes before any has ended: from the first stage's arena."""
        plans: list[Planned] = [view.plan for view in contest.stages] or list(contest.planned)
        if not self._first_ms and plans:
            arena = arenas.load_installed(plans[0].arena, plans[0].arena_settings)
            self._first_ms = round(1000 * arena.match.duration_s) + _BETWEEN_MS
        return self._first_ms
