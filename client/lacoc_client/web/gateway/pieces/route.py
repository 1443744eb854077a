"""The routes for pieces: the list of pieces, each piece, and reports of pages that watch."""

import re
import time
from typing import Annotated

import msgspec
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import BaseRoute, Route

from lacoc_client.web.gateway.body import read_body
from lacoc_client.web.gateway.cached import A_SECOND, FOR_EVER, file_response, json_response
from lacoc_client.web.gateway.courts import Courts
from lacoc_client.web.gateway.crowd import HEARD_MOST, LOOKS_S, SYMBOLS, Crowd
from lacoc_client.web.gateway.guard import answer_browser
from lacoc_client.web.gateway.pieces.pictures import Pictures
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.allowance import Allowance
from lacoc_shared.words import say

HERE_HZ, HERE_BURST = 4.0 * HEARD_MOST / LOOKS_S, 4 * HEARD_MOST
HERE_BYTES = 256
_NUMBER = re.compile(r"[0-9]{1,9}")
_ROOM_PART = 4
"""Pages are told that there is room on WebSockets if one place in so many is free. With fewer free
places many pages would come and be refused."""


class PiecesNow(msgspec.Struct, frozen=True):
    """Which pieces of a match pages can fetch now."""

    run: str
    """Name of the run. A new run begins when the gateway starts, or when somebody asks again after
    a pause."""
    closed: int
    """Number of complete pieces; the newest complete one has this number less one."""
    room: bool
    """Whether enough places on WebSockets are free that this page should ask for one."""
    share: float
    """The chance with which a page reports every 10 s that it is there."""


class Here(msgspec.Struct, frozen=True):
    """The report of a page that fetches pieces: that it is there, and how often it cheered."""

    cheers: Annotated[list[Annotated[int, msgspec.Meta(ge=0)]], msgspec.Meta(max_length=SYMBOLS)]


def piece_routes(courts: Courts, pictures: Pictures, crowd: Crowd) -> list[BaseRoute]:
    """Return the routes on which pages fetch the pieces of a match.

    A page that watches in pieces does not count as a spectator with a place. A cache on the way can
    answer its requests for pieces.

    Args:
        courts: the courts of the gateway.
        pictures: their pictures in pieces.
        crowd: counts who watches.
    """
    spoken = Allowance(HERE_HZ, HERE_BURST)

    async def now(request: Request) -> Response:
        courts.pieces_asked += 1
        try:
            cutter = pictures.find(request.path_params["picture"])
        except UserError as error:
            return answer_browser(request.scope, error.phrase, 404)
        room = courts.free_places() * _ROOM_PART >= courts.home.viewers_most
        found = PiecesNow(cutter.run, cutter.closed(), room, crowd.share)
        return json_response(request, found)

    async def here(request: Request) -> Response:
        audience = pictures.audience(request.path_params["picture"])
        if audience is not None and spoken.take(1, time.monotonic()):
            try:
                said = msgspec.json.decode(await read_body(request, HERE_BYTES), type=Here)
            except (msgspec.MsgspecError, UserError) as error:
                return answer_browser(
                    request.scope, say("gateway.bad-message", error=str(error)), 400
                )
            crowd.hear(audience, said.cheers)
        return Response(status_code=204)

    async def piece(request: Request) -> Response:
        courts.pieces_asked += 1
        asked = request.path_params
        cutter = pictures.known(asked["picture"])
        found = None
        if cutter is not None and asked["run"] == cutter.run and _NUMBER.fullmatch(asked["number"]):
            found = cutter.find(int(asked["number"]))
        if found is not None:
            return file_response(request, found, FOR_EVER)
        missing = answer_browser(request.scope, say("gateway.no-page"), 404)
        missing.headers["Cache-Control"] = A_SECOND  # a crowd that comes too early asks once
        return missing

    return [
        Route("/live/{picture:path}/now.json", now),
        Route("/live/{picture:path}/here", here, methods=["POST"]),
        Route("/live/{picture:path}/{run}/{number}", piece),
    ]
