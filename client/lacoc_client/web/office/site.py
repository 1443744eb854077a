"""The paths of the organiser's page /office and of /enter, on which teams enter."""

from collections.abc import Sequence

from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import BaseRoute, Route, WebSocketRoute
from starlette.websockets import WebSocket

from lacoc_client.web.gateway.cached import json_response
from lacoc_client.web.gateway.guesses import Guesses
from lacoc_client.web.office.desk import DeskLine
from lacoc_client.web.office.desk_page import DeskPage
from lacoc_client.web.office.hand_ins import HandIns
from lacoc_client.web.office.links import LinkMaker
from lacoc_shared.messages.desk import DESK_MAX_BYTES

DESK_BYTES = DESK_MAX_BYTES + 1024
"""Longest message of a page [bytes]."""


class DeskSite:
    """The pages /office and /enter of a gateway.

    Args:
        desk: address of the office's desk.
        address: address of the pages, as other machines can open it.
        authority: fingerprint of the event's own authority; "": it has none.
    """

    paths: Sequence[str] = ("/office", "/enter")

    def __init__(self, desk: str, address: str, authority: str = "") -> None:
        self._line = DeskLine(desk)
        self._guesses = Guesses()
        self._hand_ins = HandIns()
        self._make = LinkMaker(address, authority)

    @property
    def routes(self) -> Sequence[BaseRoute]:
        """The routes of the WebSockets of these pages, and of the address where teams enter."""

        async def page(websocket: WebSocket) -> None:
            await DeskPage(websocket, self._line, self._guesses, self._hand_ins, self._make).serve()

        def enter(request: Request) -> Response:
            return json_response(request, {"pages": self._make.address})

        return [WebSocketRoute("/office/ws", page), Route("/enter.json", enter)]

    async def close(self) -> None:
        """Close the connection to the desk."""
        await self._line.close()
