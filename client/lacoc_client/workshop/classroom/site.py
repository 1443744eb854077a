"""The paths that the web application of a class answers."""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import RedirectResponse, Response
from starlette.routing import Route, WebSocketRoute
from starlette.types import ASGIApp
from starlette.websockets import WebSocket

from lacoc_client.web.gateway.files import PageFiles
from lacoc_client.web.gateway.recordings import Recordings
from lacoc_client.web.gateway.site import LESSON, page_routes, recording_routes
from lacoc_client.workshop.classroom.classroom import Classroom
from lacoc_client.workshop.classroom.teacher.page import TeacherPage
from lacoc_client.workshop.design.design_page import DesignPage
from lacoc_client.workshop.design.site import PATH as STUDENTS

PATH = "/class"


def class_site(classroom: Classroom, files: PageFiles) -> ASGIApp:
    """Make the web application of a class: /design for students, /class for their teacher.

    Args:
        classroom: the class.
        files: the built pages.
    """
    shelf = Recordings(classroom.tournament.recordings, tuple)

    @asynccontextmanager
    async def lifespan(_: Starlette) -> AsyncIterator[None]:
        async with classroom.running():
            yield

    async def student(websocket: WebSocket) -> None:
        await DesignPage(websocket, classroom).serve()

    async def teacher(websocket: WebSocket) -> None:
        await TeacherPage(websocket, classroom).serve()

    async def start(_: Request) -> Response:
        return RedirectResponse(STUDENTS[1:])

    others = [
        Route("/", start),
        WebSocketRoute(f"{STUDENTS}/ws", student),
        WebSocketRoute(f"{PATH}/ws", teacher),
        *recording_routes(shelf),
    ]
    routes = page_routes(files, [STUDENTS, PATH, LESSON, "/replay"], others)
    return Starlette(routes=routes, lifespan=lifespan)
