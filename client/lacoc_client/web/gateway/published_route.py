"""Serves what the office has written for everybody: the published contest, teams' pictures."""

import asyncio
import mimetypes
from pathlib import Path

from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import BaseRoute, Route

from lacoc_client.web.gateway.cached import ASK_AGAIN, FOR_EVER, large_response
from lacoc_client.web.gateway.guard import answer_browser
from lacoc_shared.contest.file import picture_path, published_path
from lacoc_shared.words import say


def published_routes(sheet: Path | None) -> list[BaseRoute]:
    """Return two routes: of the published contest, and of the pictures of teams.

    Args:
        sheet: the contest's newest sheet; the published folder is beside it. None: there is no
            contest.
    """
    if sheet is None:
        return []
    folder = published_path(sheet).resolve()

    async def published(request: Request) -> Response:
        name = request.path_params["name"] or "index.html"
        path = await asyncio.to_thread(_find, folder, name)
        kind = mimetypes.guess_type(name)[0] or "application/octet-stream"
        try:
            if path is not None:
                return large_response(request, path, kind, ASK_AGAIN)
        except OSError:  # it was written again at this moment
            pass
        return answer_browser(request.scope, say("gateway.no-page"), 404)

    async def picture(request: Request) -> Response:
        path = picture_path(sheet, request.path_params["files"])
        try:
            if path is not None:
                return large_response(request, path, "image/webp", FOR_EVER)
        except OSError:  # the team has none
            pass
        return answer_browser(request.scope, say("gateway.no-page"), 404)

    return [
        Route("/published/{name:path}", published),
        Route("/pictures/{files}.webp", picture),
    ]


def _find(folder: Path, name: str) -> Path | None:
    """Return the path of a file in a folder; None if there is no such file, or it lies outside."""
    try:
        path = (folder / name).resolve()
        return path if path.is_relative_to(folder) and path.is_file() else None
    except (OSError, ValueError):  # a NUL in the name
        return None
