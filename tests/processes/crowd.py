"""Runs a crowd in one process at little cost: pages, direct spectators, or scrapers of metrics.

    python -m tests.processes.crowd pages --address http://127.0.0.1:8080 --number 300
    python -m tests.processes.crowd direct --address tcp/127.0.0.1:7447 --number 100 --courts main
    python -m tests.processes.crowd scrapes --address http://127.0.0.1:9000/metrics --number 10

It prints a line of JSON when all are there. Each line on standard input ends a count and prints it:
seconds, and for each of the crowd its number of frames and of bytes. Scrapers are one, with the
number of scrapes and the microseconds that they took.
"""

import argparse
import asyncio
import base64
import json
import os
import sys
import time
import urllib.request
from collections.abc import Callable
from contextlib import ExitStack
from functools import partial
from urllib.parse import urlsplit

import msgspec
from arguments import arguments

from lacoc_shared.keyspace import KeySpace
from lacoc_shared.network.session import Mailbox, open_client

FRAME = 2
PROBES = 10
"""So many direct spectators count their frames."""
_PROBE_DEPTH = 4096
_OPEN_S = 60.0
_PING, _PONG, _BINARY = 0x9, 0xA, 0x2

Counts = list[tuple[int, int]]
"""For each of a crowd, how many frames and bytes it has got since the last count."""


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


async def _pages(options: argparse.Namespace, stack: ExitStack) -> Callable[[], Counts]:
    """Open pages; return what counts their frames once each has had one."""
    parts = urlsplit(options.address)
    courts = options.courts.split(",") if options.courts else [None]
    pages: list[Page] = []
    for number in range(options.number):
        make = partial(Page, parts.netloc, options.hz, courts[number % len(courts)])
        _, page = await asyncio.get_running_loop().create_connection(
            make, parts.hostname, parts.port
        )
        pages.append(page)
    while any(not page.frames for page in pages):
        await asyncio.sleep(0.05)

    def count() -> Counts:
        counts = [(page.frames, page.bytes) for page in pages]
        for page in pages:
            page.frames = page.bytes = 0
        return counts

    return count


async def _direct(options: argparse.Namespace, stack: ExitStack) -> Callable[[], Counts]:
    """Open sessions with all subscriptions of a spectator; return what counts the probes' frames.

    A ring is filled without Python; callbacks for all spectators would take a whole core.
    """
    keys = KeySpace(options.courts)
    probes: list[Mailbox] = []
    for number in range(options.number):
        session = stack.enter_context(open_client([options.address], _OPEN_S))
        if number < PROBES:
            probes.append(session.mailbox(keys.frame, _PROBE_DEPTH))
        kept = [] if number < PROBES else [session.ring(keys.frame, 1)]
        kept += [session.ring(keys.health, 1), session.ring(keys.sheet, 1)]
        kept.append(session.ring(keys.event, 64))
        stack.callback(kept.clear)
    return lambda: [_emptied(probe) for probe in probes]


def _emptied(probe: Mailbox) -> tuple[int, int]:
    """Empty a mailbox; return its number of frames and of bytes."""
    frames = size = 0
    while (mail := probe.take()) is not None:
        frames, size = frames + 1, size + len(mail.payload)
    return frames, size


async def _scrapes(options: argparse.Namespace, stack: ExitStack) -> Callable[[], Counts]:
    """Scrape metrics `number` times a second; return what counts scrapes and their time [us]."""
    counts = [[0, 0]]

    def scrape() -> int:
        begin_s = time.perf_counter()
        with urllib.request.urlopen(options.address, timeout=10) as reply:
            reply.read()
        return round(1e6 * (time.perf_counter() - begin_s))

    async def go_on() -> None:
        while True:
            next_s = time.monotonic() + 1 / options.number
            took_us = await asyncio.to_thread(scrape)
            counts[0] = [counts[0][0] + 1, counts[0][1] + took_us]
            await asyncio.sleep(max(0.0, next_s - time.monotonic()))

    task = asyncio.create_task(go_on())
    stack.callback(task.cancel)

    def count() -> Counts:
        (scrapes, took_us), counts[0] = counts[0], [0, 0]
        return [(scrapes, took_us)]

    return count


_KINDS = {"pages": _pages, "direct": _direct, "scrapes": _scrapes}


async def main() -> None:
    """Bring the crowd. At each line of the input, print what each got since the last line."""
    options = arguments(
        __doc__, _KINDS, address=str, number=1, hz=25.0, courts=("", "watched in turns")
    )
    with ExitStack() as stack:
        count = await _KINDS[options.what](options, stack)
        print(json.dumps({"open": options.number}), flush=True)
        began_s = time.monotonic()
        while await asyncio.to_thread(sys.stdin.readline):
            now_s = time.monotonic()
            print(json.dumps({"seconds": now_s - began_s, "counts": count()}), flush=True)
            began_s = now_s


if __name__ == "__main__":
    asyncio.run(main())
