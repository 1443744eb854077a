"""Runs hundreds of spectators' pages in one process at little cost, and counts their frames.

Each line on standard input ends a count and prints it as JSON: seconds, frames and bytes of each.
"""

import argparse
import asyncio
import base64
import json
import os
import sys
import time
from functools import partial
from urllib.parse import urlsplit

import msgspec

FRAME = 2
_PING, _PONG, _BINARY = 0x9, 0xA, 0x2


class Page(asyncio.Protocol):
    """A page's WebSocket: asks for frames, counts them, answers pings.

    Args:
        host: host and port of the gateway.
        hz: how many frames a second it asks for.
        court: the court that it watches; None: the gateway's first one.
    """

    def __init__(self, host: str, hz: float, court: str | None = None) -> None:
        self._host = host
        self._hz = hz
        self._court = court
        self._data = b""
        self._open = False
        self.frames = self.bytes = 0

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Ask for the WebSocket."""
        assert isinstance(transport, asyncio.Transport)
        self._transport = transport
        key = base64.b64encode(os.urandom(16)).decode()
        transport.write(
            f"GET /ws HTTP/1.1\r\nHost: {self._host}\r\nUpgrade: websocket\r\nConnection: Upgrade"
            f"\r\nSec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode()
        )

    def data_received(self, data: bytes) -> None:
        """Count frames, answer pings, and ignore other messages."""
        self._data += data
        if not self._open:
            head, end, rest = self._data.partition(b"\r\n\r\n")
            if not end:
                return
            assert b" 101 " in head, head
            self._open, self._data = True, rest
            watch = {"id": 1, "do": "watch", "hz": self._hz, "court": self._court}
            self._send(_BINARY, msgspec.msgpack.encode(watch))
        at, data = 0, self._data
        while len(data) - at >= 10 or (len(data) - at >= 2 and data[at + 1] < 126):
            size, begin = data[at + 1], at + 2
            if size == 126:
                size, begin = int.from_bytes(data[at + 2 : at + 4]), at + 4
            elif size == 127:
                size, begin = int.from_bytes(data[at + 2 : at + 10]), at + 10
            if len(data) < begin + size:
                break
            if data[at] & 0xF == _PING:
                self._send(_PONG, data[begin : begin + size])
            elif data[begin] == FRAME:
                self.frames += 1
                self.bytes += begin + size - at
            at = begin + size
        self._data = data[at:]

    def _send(self, code: int, payload: bytes) -> None:
        mask = os.urandom(4)
        masked = bytes(byte ^ mask[index & 3] for index, byte in enumerate(payload))
        self._transport.write(bytes((0x80 | code, 0x80 | len(payload))) + mask + masked)


async def main() -> None:
    """Open the pages. At each line of the input, print what each page got since the last line."""
    parser = argparse.ArgumentParser()
    parser.add_argument("url")
    parser.add_argument("pages", type=int)
    parser.add_argument("hz", type=float)
    parser.add_argument("courts", nargs="*", default=[None], help="watched in turns")
    options = parser.parse_args()
    parts = urlsplit(options.url)
    loop = asyncio.get_running_loop()
    pages: list[Page] = []
    for number in range(options.pages):
        court = options.courts[number % len(options.courts)]
        _, page = await loop.create_connection(
            partial(Page, parts.netloc, options.hz, court), parts.hostname, parts.port
        )
        pages.append(page)
    while any(not page.frames for page in pages):
        await asyncio.sleep(0.05)
    print(json.dumps({"open": len(pages)}), flush=True)
    began_s = time.monotonic()
    while await loop.run_in_executor(None, sys.stdin.readline):
        now_s = time.monotonic()
        counts = [(page.frames, page.bytes) for page in pages]
        for page in pages:
            page.frames = page.bytes = 0
        print(json.dumps({"seconds": now_s - began_s, "counts": counts}), flush=True)
        began_s = now_s


if __name__ == "__main__":
    asyncio.run(main())
