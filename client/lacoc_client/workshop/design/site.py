"""The web application of a gateway that `lacoc design` runs."""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import RedirectResponse, Response
from starlette.routing import Route, WebSocketRoute
from starlette.types import ASGIApp
from starlette.websockets import WebSocket

from lacoc_client.web.gateway.files import PageFiles
from lacoc_client.web.gateway.site import LESSON, page_routes
from lacoc_client.workshop.design.design_page import DesignPage
from lacoc_client.workshop.design.designer import Designer

PATH = "/design"


def design_site(designer: Designer, files: PageFiles) -> ASGIApp:
    """Make the web application of a gateway with /design and the lesson of one leg.

    Args:
        designer: has the folder and the studio that all pages share.
        files: the built pages.
    """

    @asynccontextmanager
    async def lifespan(_: Starlette) -> AsyncIterator[None]:
        async with designer.running():
            yield

    async def page(websocket: WebSocket) -> None:
        await DesignPage(websocket, designer).serve()

    async def start(_: Request) -> Response:
        return RedirectResponse(PATH[1:])

    others = [Route("/", start), WebSocketRoute(f"{PATH}/ws", page)]
    return Starlette(routes=page_routes(files, [PATH, LESSON], others), lifespan=lifespan)
