"""HTTP answers that a browser, or a proxy on the way, may keep; each says for how long."""

from functools import lru_cache
from pathlib import Path
from typing import Any

import msgspec
from starlette.requests import Request
from starlette.responses import FileResponse, Response

from lacoc_client.web.gateway.files import PageFile, page_file

FOR_EVER = "public, max-age=31536000, immutable"
"""For things that never change under their name: finished records, pieces of a match, pictures of
teams, and assets, whose names contain their hash."""
ASK_AGAIN = "no-cache"
"""For things that change: the browser asks each time whether its copy is still the newest."""
A_SECOND = "public, max-age=1"
"""For things that a crowd asks for again and again: a proxy then asks the gateway only once a
second."""

_packed = lru_cache(maxsize=16)(page_file)


def file_response(request: Request, file: PageFile, cache: str) -> Response:
    """Answer with a file, or with "not modified" if the browser has this version of it already.

    Args:
        request: the request.
        file: the file.
        cache: how long the answer may be kept.
    """
    tag = f'W/"{file.hash}"'
    headers = {"Cache-Control": cache, "Vary": "Accept-Encoding", "ETag": tag}
    if request.headers.get("if-none-match") == tag:
        return Response(status_code=304, headers=headers)
    data = file.data
    if file.packed is not None and "gzip" in request.headers.get("accept-encoding", ""):
        data = file.packed
        headers["Content-Encoding"] = "gzip"
    return Response(data, headers=headers, media_type=file.media_type)


def json_response(request: Request, found: Any) -> Response:
    """Answer with JSON that changes often and that many pages ask for; keep it for a second."""
    file = _packed(msgspec.json.encode(found), "application/json")
    return file_response(request, file, A_SECOND)


def large_response(request: Request, path: Path, media_type: str, cache: str) -> Response:
    """Answer as `file_response` does, but read the file piece by piece, because it is large.

    Raises:
        OSError: if the file has gone.
    """
    headers = {"Cache-Control": cache}
    found = FileResponse(path, headers=headers, media_type=media_type, stat_result=path.stat())
    if request.headers.get("if-none-match") == found.headers["ETag"]:
        return Response(status_code=304, headers=headers | {"ETag": found.headers["ETag"]})
    return found
