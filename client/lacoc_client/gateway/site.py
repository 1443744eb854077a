"""The gateway's paths: of pages (all are one HTML file), files, recordings and the WebSocket."""

import asyncio
import hmac
from collections.abc import AsyncIterator, Iterable, Sequence
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Protocol

import msgspec
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import FileResponse, Response
from starlette.routing import BaseRoute, Route, WebSocketRoute
from starlette.types import ASGIApp
from starlette.websockets import WebSocket

from lacoc_client.gateway.courts import Courts
from lacoc_client.gateway.files import NOT_BUILT, PageFile, PageFiles
from lacoc_client.gateway.forks import ForkAsk, Forks, bots
from lacoc_client.gateway.guard import Guard, answer, language_of
from lacoc_client.gateway.home import Home
from lacoc_client.gateway.metrics import GatewayMetrics
from lacoc_client.gateway.page import Page
from lacoc_client.gateway.recordings import Recordings
from lacoc_client.gateway.scores import scores_route
from lacoc_client.gateway.wire import REQUEST_BYTES, too_long
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

PATHS = ("/", "/play", "/practice", "/referee", "/watch", "/overlay", "/replay", "/contest")
"""Paths that all serve index.html; the page itself looks at its path."""

KEY_HEADER = "X-Lacoc-Key"
"""HTTP header with the page key."""

_FOR_EVER = "public, max-age=31536000, immutable"  # names of assets contain their hash
_MCAP = "application/octet-stream"


class More(Protocol):
    """Pages that a gateway has besides its own."""

    paths: Sequence[str]
    """Paths of the pages."""

    @property
    def routes(self) -> Sequence[BaseRoute]:
        """Routes besides the routes of the pages."""

    async def close(self) -> None:
        """Close what the pages need."""


def site(home: Home, files: PageFiles, more: More | None = None) -> ASGIApp:
    """Make the application of a gateway.

    Args:
        home: the gateway's settings.
        files: the built pages.
        more: further pages.
    """
    courts = Courts(home)
    shelf = Recordings(home.recordings, courts.over)
    forks = Forks(shelf.own)
    if home.exporter is not None:
        home.exporter.registry.register(GatewayMetrics(courts))

    @asynccontextmanager
    async def lifespan(_: Starlette) -> AsyncIterator[None]:
        courts.find(None)
        watching = asyncio.get_running_loop().create_task(courts.watch_files())
        yield
        watching.cancel()
        await courts.close()
        if more is not None:
            await more.close()
        forks.close()
        await asyncio.to_thread(shelf.close)

    async def page(websocket: WebSocket) -> None:
        await Page(websocket, courts).serve()

    others = [
        *recording_routes(shelf),
        *fork_routes(shelf, forks, home.key),
        sheet_route(home.sheet),
        scores_route(courts),
        WebSocketRoute("/ws", page),
    ]
    paths = PATHS if more is None else (*PATHS, *more.paths)
    routes = page_routes(files, paths, [*others, *(more.routes if more is not None else ())])
    return Guard(Starlette(routes=routes, lifespan=lifespan), home.names)


def recording_routes(shelf: Recordings) -> list[BaseRoute]:
    """Return three routes: of the list of recordings, of a recording, and of its odds."""

    async def recordings(_: Request) -> Response:
        found = await asyncio.to_thread(shelf.listed)
        return Response(msgspec.json.encode(found), media_type="application/json")

    async def one_recording(request: Request) -> Response:
        name = request.path_params["name"]
        path = await asyncio.to_thread(shelf.find, name)
        return _not_found(request) if path is None else FileResponse(path, media_type=_MCAP)

    async def odds(request: Request) -> Response:
        found = await asyncio.to_thread(shelf.odds, request.path_params["name"])
        # Most recordings have none, so that is no error.
        return Response(found or b"null", media_type="application/json")

    return [
        Route("/recordings", recordings),
        Route("/recordings/{name}", one_recording),
        Route("/recordings/{name}/odds", odds),
    ]


def fork_routes(shelf: Recordings, forks: Forks, key: str) -> list[BaseRoute]:
    """Return the route on which a page asks for forks of a recording.

    A request needs the page key in a header, which no page of another site can send.

    Args:
        shelf: the recordings.
        forks: plays the forks.
        key: the page key.
    """

    async def fork(request: Request) -> Response:
        given = request.headers.get(KEY_HEADER, "").encode("utf-8", "surrogatepass")
        if not hmac.compare_digest(given, key.encode()):
            return answer(request.scope, say("gateway.fork-key"), 403)
        record = await asyncio.to_thread(shelf.find, request.path_params["name"])
        if record is None:
            return _not_found(request)
        try:
            found: object
            if request.method == "POST":
                asked = msgspec.json.decode(await _body(request), type=ForkAsk)
                found = await forks.play(record, asked, language_of(request.scope))
            else:
                found = {"bots": await asyncio.to_thread(bots, record)}
        except msgspec.MsgspecError as error:
            return answer(request.scope, say("gateway.bad-message", error=str(error)), 400)
        except UserError as error:
            return answer(request.scope, error.phrase, 409)
        return Response(msgspec.json.encode(found), media_type="application/json")

    return [Route("/recordings/{name}/forks", fork, methods=["GET", "POST"])]


async def _body(request: Request) -> bytes:
    """Read the body of a request.

    Raises:
        UserError: if it is too long.
    """
    data = b""
    async for part in request.stream():
        data += part
        if len(data) > REQUEST_BYTES:
            raise too_long(len(data), REQUEST_BYTES)
    return data


def sheet_route(path: Path | None) -> BaseRoute:
    """Return the route of a contest's newest sheet.

    Args:
        path: the sheet's file, which need not exist yet; None: there is no contest.
    """
    files = None if path is None else PageFiles(path.parent)

    async def sheet(request: Request) -> Response:
        found = None
        if files is not None and path is not None:
            found = await asyncio.to_thread(files.find, path.name)
        if found is None:
            return answer(request.scope, say("gateway.no-contest"), 404)
        return _response(request, found, "no-cache")

    return Route("/contest.json", sheet)


def page_routes(
    files: PageFiles, paths: Iterable[str], others: Iterable[BaseRoute]
) -> list[BaseRoute]:
    """Return the routes of a site with pages.

    Args:
        files: the built pages.
        paths: paths of the pages.
        others: routes of the site besides its pages and their parts.
    """

    async def index(request: Request) -> Response:
        file = await asyncio.to_thread(files.find, "index.html")
        if file is None:
            return answer(request.scope, NOT_BUILT, 503)
        return _response(request, file, "no-store")

    async def asset(request: Request) -> Response:
        name = request.path_params["name"]
        file = await asyncio.to_thread(files.find, f"assets/{name}")
        return _not_found(request) if file is None else _response(request, file, _FOR_EVER)

    async def top_file(request: Request) -> Response:
        """Serve a file beside index.html: the icon."""
        file = await asyncio.to_thread(files.find, request.path_params["name"])
        return _not_found(request) if file is None else _response(request, file, "max-age=3600")

    return [
        *(Route(path, index) for path in paths),
        Route("/assets/{name:path}", asset),
        *others,
        Route("/{name}", top_file),
    ]


def _response(request: Request, file: PageFile, cache: str) -> Response:
    tag = f'W/"{file.hash}"'
    headers = {"Cache-Control": cache, "Vary": "Accept-Encoding", "ETag": tag}
    if request.headers.get("if-none-match") == tag:
        return Response(status_code=304, headers=headers)
    data = file.data
    if file.packed is not None and "gzip" in request.headers.get("accept-encoding", ""):
        data = file.packed
        headers["Content-Encoding"] = "gzip"
    return Response(data, headers=headers, media_type=file.media_type)


def _not_found(request: Request) -> Response:
    return answer(request.scope, say("gateway.no-page"), 404)
