"""The gateway's routes: of pages (one HTML file for all), files, recordings and the WebSocket."""

import asyncio
from collections.abc import AsyncIterator, Callable, Iterable, Sequence
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Protocol

import msgspec
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import RedirectResponse, Response
from starlette.routing import BaseRoute, Route, WebSocketRoute
from starlette.types import ASGIApp
from starlette.websockets import WebSocket

from lacoc_client.play.link.event import PATH as EVENT_PATH
from lacoc_client.play.link.event import LinkedEvent
from lacoc_client.web.gateway.body import read_body
from lacoc_client.web.gateway.cached import (
    A_SECOND,
    ASK_AGAIN,
    FOR_EVER,
    file_response,
    json_response,
    large_response,
)
from lacoc_client.web.gateway.courts import Courts
from lacoc_client.web.gateway.crowd import Crowd
from lacoc_client.web.gateway.files import NOT_BUILT, PageFiles
from lacoc_client.web.gateway.forks import ForkAsk, Forks, bots
from lacoc_client.web.gateway.guard import answer_browser, language_of, machine_of
from lacoc_client.web.gateway.health import GatewayHealth
from lacoc_client.web.gateway.home import Home
from lacoc_client.web.gateway.metrics import GatewayMetrics
from lacoc_client.web.gateway.page import Page
from lacoc_client.web.gateway.pieces.pictures import Pictures
from lacoc_client.web.gateway.pieces.route import piece_routes
from lacoc_client.web.gateway.published_route import published_routes
from lacoc_client.web.gateway.recordings import Recordings
from lacoc_client.web.gateway.rules_route import rules_route
from lacoc_client.web.gateway.scores import scores_route
from lacoc_client.web.gateway.shown import ShownRecords
from lacoc_client.web.gateway.wire import REQUEST_BYTES
from lacoc_shared import __version__
from lacoc_shared.messages import PROTOCOL
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

LESSON = "/leg"
"""Path of the lesson of one leg; every site with pages has it."""
PATHS = ("/", "/play", "/practice", "/referee", "/watch", "/overlay", "/replay", "/contest", LESSON)
"""Paths that all serve index.html; the page's script reads at which path the page was opened."""

_OLD_NAMES = {"favicon.ico": "icon.svg"}
KEY_HEADER = "X-Lacoc-Key"
"""HTTP header with the page key, or with a token that a court has accepted."""

_MCAP = "application/octet-stream"


class More(Protocol):
    """Further pages, from another part of the program, that a gateway serves."""

    paths: Sequence[str]
    """Paths of these pages."""

    @property
    def routes(self) -> Sequence[BaseRoute]:
        """The routes that these further pages need besides their HTML file, also of WebSockets."""

    async def close(self) -> None:
        """Close what these pages have opened, when the gateway ends."""


def site(home: Home, files: PageFiles, more: More | None = None) -> ASGIApp:
    """Make the web application of a gateway.

    Args:
        home: the gateway's settings.
        files: the built pages.
        more: pages of other parts of the program.
    """
    courts = Courts(home)
    shown = ShownRecords(home.sheet) if home.keeps_back and home.sheet is not None else None
    shelf = Recordings(home.recordings, courts.over, shown)
    forks = Forks(shelf.own)
    pictures, crowd = Pictures(courts), Crowd(courts)
    if home.exporter is not None:
        home.exporter.registry.register(GatewayMetrics(courts))

    @asynccontextmanager
    async def lifespan(_: Starlette) -> AsyncIterator[None]:
        courts.find(None)
        loop = asyncio.get_running_loop()
        tasks = [
            loop.create_task(work)
            for work in (courts.watch_files(), pictures.forget(), crowd.tell())
        ]
        yield
        for task in tasks:
            task.cancel()
        await courts.close()
        if more is not None:
            await more.close()
        forks.close()
        await asyncio.to_thread(shelf.close)

    async def page(websocket: WebSocket) -> None:
        await Page(websocket, courts, crowd).serve()

    others = [
        *recording_routes(shelf),
        *fork_routes(shelf, forks, courts.lets_act),
        event_route(home),
        sheet_route(home.sheet),
        *published_routes(home.sheet),
        scores_route(courts),
        rules_route(),
        *piece_routes(courts, pictures, crowd),
        WebSocketRoute("/ws", page),
    ]
    paths = PATHS if more is None else (*PATHS, *more.paths)
    others += more.routes if more is not None else ()
    routes = page_routes(files, paths, others, home.contest)
    return Starlette(routes=routes, lifespan=lifespan)


def recording_routes(shelf: Recordings) -> list[BaseRoute]:
    """Return three routes: of the list of recordings, of a recording, and of its odds."""

    async def recordings(request: Request) -> Response:
        found = await asyncio.to_thread(shelf.listed)
        return json_response(request, found)

    async def one_recording(request: Request) -> Response:
        name = request.path_params["name"]
        path = await asyncio.to_thread(shelf.find, name)
        if path is None:
            return _not_found(request)
        # The gateway's own copy of a match that is just over gives way to the court's record.
        cache = ASK_AGAIN if path.parent == shelf.own else FOR_EVER
        try:
            return large_response(request, path, _MCAP, cache)
        except OSError:  # it was moved at this moment
            return _not_found(request)

    async def odds(request: Request) -> Response:
        found = await asyncio.to_thread(shelf.odds, request.path_params["name"])
        # Most recordings have none, so that is no error.
        return Response(found or b"null", media_type="application/json")

    return [
        Route("/recordings", recordings),
        Route("/recordings/{name}", one_recording),
        Route("/recordings/{name}/odds", odds),
    ]


def fork_routes(
    shelf: Recordings, forks: Forks, lets_act: Callable[[str], bool]
) -> list[BaseRoute]:
    """Return the route on which a page asks for forks of a recording.

    A request needs a secret in a header, which no page of another site can send.

    Args:
        shelf: the recordings.
        forks: plays the forks.
        lets_act: returns whether a secret is the page key, or a token that a court has accepted.
    """

    async def fork(request: Request) -> Response:
        if not lets_act(request.headers.get(KEY_HEADER, "")):
            return answer_browser(request.scope, say("gateway.fork-key"), 403)
        record = await asyncio.to_thread(shelf.find, request.path_params["name"])
        if record is None:
            return _not_found(request)
        try:
            found: object
            if request.method == "POST":
                asked = msgspec.json.decode(await read_body(request, REQUEST_BYTES), type=ForkAsk)
                found = await forks.play(record, asked, language_of(request.scope))
            else:
                found = {"bots": await asyncio.to_thread(bots, record)}
        except msgspec.MsgspecError as error:
            return answer_browser(request.scope, say("gateway.bad-message", error=str(error)), 400)
        except UserError as error:
            return answer_browser(request.scope, error.phrase, 409)
        return Response(msgspec.json.encode(found), media_type="application/json")

    return [Route("/recordings/{name}/forks", fork, methods=["GET", "POST"])]


def event_route(home: Home) -> BaseRoute:
    """Return the route on which commands ask for an event's courts."""
    event = LinkedEvent(
        protocol=PROTOCOL, name=home.contest, courts=home.told, authority=home.authority
    )

    async def answer_event(request: Request) -> Response:
        return json_response(request, event)

    return Route(f"/{EVENT_PATH}", answer_event)


def sheet_route(path: Path | None) -> BaseRoute:
    """Return the route on which a contest's newest sheet is served.

    Args:
        path: the sheet's file, which need not exist yet; None: there is no contest.
    """
    files = None if path is None else PageFiles(path.parent)

    async def sheet(request: Request) -> Response:
        found = None
        if files is not None and path is not None:
            found = await asyncio.to_thread(files.find, path.name)
        if found is None:
            return answer_browser(request.scope, say("gateway.no-contest"), 404)
        return file_response(request, found, A_SECOND)

    return Route("/contest.json", sheet)


def page_routes(
    files: PageFiles, paths: Sequence[str], others: Iterable[BaseRoute], title: str = ""
) -> list[BaseRoute]:
    """Return the routes of a web site that has some of the built pages.

    Args:
        files: the built pages.
        paths: paths of the pages.
        others: routes of the site besides its pages and their parts.
        title: name of the contest; "" if there is none.
    """

    async def index(request: Request) -> Response:
        file = await asyncio.to_thread(files.find, "index.html")
        if file is None:
            return answer_browser(request.scope, NOT_BUILT, 503)
        return file_response(request, file, ASK_AGAIN)

    async def without_slash(request: Request) -> Response:
        """Redirect a path with a slash at its end to the page without it.

        The addresses on a page are relative to its path without the slash.
        """
        url = request.url
        name = url.path.rstrip("/").rpartition("/")[2]
        return RedirectResponse(f"../{name}" + (f"?{url.query}" if url.query else ""))

    async def asset(request: Request) -> Response:
        name = request.path_params["name"]
        file = await asyncio.to_thread(files.find, f"assets/{name}")
        return _not_found(request) if file is None else file_response(request, file, FOR_EVER)

    async def top_file(request: Request) -> Response:
        """Serve a file of the built pages that lies beside index.html.

        The icon can be fetched as favicon.ico too, the name that browsers try by themselves.
        """
        name = request.path_params["name"]
        file = await asyncio.to_thread(files.find, _OLD_NAMES.get(name, name))
        return _not_found(request) if file is None else file_response(request, file, "max-age=3600")

    async def healthz(request: Request) -> Response:
        """Answer that the gateway runs, and what the request looked like after any proxies."""
        forwarded = request.headers.get("x-forwarded-for", "")
        asks = [one.strip() for one in forwarded.split(",") if one]
        health = GatewayHealth(
            version=__version__,
            contest=title,
            host=request.headers.get("host", ""),
            unnamed_proxy=bool(asks) and machine_of(request.scope) not in asks,
            pages=tuple(paths),
        )
        return Response(msgspec.json.encode(health), media_type="application/json")

    return [
        Route("/healthz", healthz),
        *(Route(path, index) for path in paths),
        *(Route(f"{path}/", without_slash) for path in paths if path != "/"),
        Route("/assets/{name:path}", asset),
        *others,
        Route("/{name}", top_file),
    ]


def _not_found(request: Request) -> Response:
    return answer_browser(request.scope, say("gateway.no-page"), 404)
