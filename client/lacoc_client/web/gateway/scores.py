"""How the matches at a gateway's courts stand, as /contest shows it: clock and scores."""

import msgspec
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import BaseRoute, Route

from lacoc_client.web.gateway.cached import json_response
from lacoc_client.web.gateway.courts import Courts
from lacoc_client.web.gateway.feed import CourtFeed
from lacoc_shared.seat import BEAT_S


class CourtScore(msgspec.Struct, frozen=True, kw_only=True):
    """How the match at a court stands."""

    court: str
    call: str
    """Id of the call with which the office gave the match to the court; "": it gave none."""
    phase: int
    clock_s: float
    """How long the match has been played [s]."""
    duration_s: float
    """Length of the match [s]; 0: it has no time limit."""
    scores: tuple[int, ...]
    """Points by seat."""


def scores_route(courts: Courts) -> BaseRoute:
    """Return the route that says how the matches at all courts stand.

    A page that asks does not count as a spectator with a place: it gets a few hundred bytes, not
    frames.

    Args:
        courts: the courts of the gateway.
    """

    async def scores(request: Request) -> Response:
        found = [_score(courts.find(name)[0]) for name in courts.home.courts]
        return json_response(request, [one for one in found if one is not None])

    return Route("/courts.json", scores)


def _score(feed: CourtFeed) -> CourtScore | None:
    """Return how a court's match stands; None before its first frame or while it is silent."""
    stands, played = feed.picture.stands(), feed.picture.played()
    if not feed.connected or stands is None or played is None:
        return None
    return CourtScore(
        court=feed.court,
        call=played.call,
        phase=stands.phase,
        clock_s=stands.clock_ticks * BEAT_S,
        duration_s=played.duration_s,
        scores=stands.scores,
    )
