"""Reads the body of an HTTP request, up to a greatest length."""

from starlette.requests import Request

from lacoc_client.web.gateway.wire import too_long


async def read_body(request: Request, most: int) -> bytes:
    """Read the body of an HTTP request.

    Args:
        request: the request.
        most: longest body [bytes].

    Raises:
        UserError: if the body is longer.
    """
    data = b""
    async for part in request.stream():
        data += part
        if len(data) > most:
            raise too_long(len(data), most)
    return data
