"""The routes of pieces: which are there, and each of them."""

import re

import msgspec
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import BaseRoute, Route

from lacoc_client.web.gateway.cached import A_SECOND, FOR_EVER, file_response, json_response
from lacoc_client.web.gateway.courts import Courts
from lacoc_client.web.gateway.guard import answer_browser
from lacoc_client.web.gateway.pieces.pictures import Pictures
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

_NUMBER = re.compile(r"[0-9]{1,9}")
_ROOM_PART = 4
"""There is room for pages when a quarter of the places is free: else each would be sent back."""


class PiecesNow(msgspec.Struct, frozen=True):
    """Which pieces of a picture there are."""

    run: str
    """Name of the run; another one begins when the gateway starts, or after a time unasked."""
    closed: int
    """Number of pieces that are whole: the newest has this number less one."""
    room: bool
    """Whether there is room for pages on WebSockets."""


def piece_routes(courts: Courts, pictures: Pictures) -> list[BaseRoute]:
    """Return the routes of pieces.

    A page that watches in pieces takes no place of a spectator. All its requests can be answered
    by a cache on the way.

    Args:
        courts: the courts of the gateway.
        pictures: their pictures in pieces.
    """

    async def now(request: Request) -> Response:
        courts.pieces_asked += 1
        try:
            cutter = pictures.find(request.path_params["picture"])
        except UserError as error:
            return answer_browser(request.scope, error.phrase, 404)
        room = courts.free_places() * _ROOM_PART >= courts.home.viewers_most
        return json_response(request, PiecesNow(cutter.run, cutter.closed(), room))

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
        Route("/live/{picture:path}/{run}/{number}", piece),
    ]
