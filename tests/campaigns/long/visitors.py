"""Runs spectators that come and go, for `tests.campaigns.long.soak`.

    python -m tests.campaigns.long.visitors (direct | pages) --address ADDRESS --most N

Direct spectators have a session of their own with the court; pages are WebSockets through a
gateway. Each visit has a random length. A line "go" on standard input sends all visitors away,
"come" lets them come again, and "rush" lets them come for short visits. Each line is answered with
the counts so far; the answer to "go" comes when all have gone.
"""

import asyncio
import json
import random
import sys
from collections.abc import Callable, Coroutine
from typing import Any
from urllib.parse import urlsplit

from arguments import arguments
from crowd import Page

from lacoc_client.play.spectator import Spectator
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.session import open_client

STAY_S = {b"come": 15.0, b"rush": 2.0}
"""Mean length of a visit [s] after each word; the lengths are random."""
_PAUSE_S = 0.5
_LOOK_S = 0.05

Visit = Callable[[str, "_Door"], Coroutine[Any, Any, int]]


class _Door:
    """Tells visitors when they may come and must go, and counts visits."""

    def __init__(self, chance: random.Random) -> None:
        self.chance = chance
        self.open = asyncio.Event()
        self.stay_s = 0.0
        self.inside = self.visits = self.frames = 0
        self.unanswered = 0

    async def stay(self) -> None:
        """Wait until this visitor's time is over, or until all visitors are sent away."""
        loop = asyncio.get_running_loop()
        end_s = loop.time() + self.chance.expovariate(1 / self.stay_s)
        while self.open.is_set() and loop.time() < end_s:
            await asyncio.sleep(_LOOK_S)

    async def come(self, visit: Visit, address: str) -> None:
        """Visit, pause, and visit again, for ever."""
        while True:
            await self.open.wait()
            self.inside += 1
            try:
                self.frames += await visit(address, self)
                self.visits += 1
            except UserError:
                self.unanswered += 1
            self.inside -= 1
            await asyncio.sleep(self.chance.uniform(0, 2 * _PAUSE_S))


async def _direct(address: str, door: _Door) -> int:
    """Visit a court with a session; return the number of frames that the visitor saw."""
    frames = 0
    with await asyncio.to_thread(open_client, [address], 20.0) as session:
        view = await asyncio.to_thread(Spectator, session, "main")
        staying = asyncio.ensure_future(door.stay())
        while not staying.done():
            frames += view.poll() is not None
            await asyncio.sleep(_LOOK_S)
        # Closing waits for Zenoh's threads.
        await asyncio.to_thread(session.close)
    return frames


async def _page(url: str, door: _Door) -> int:
    """Visit as a page, and return its number of frames; half of the pages go without a goodbye."""
    parts = urlsplit(url)
    loop = asyncio.get_running_loop()
    transport, page = await loop.create_connection(
        lambda: Page(parts.netloc, 25.0), parts.hostname, parts.port
    )
    await door.stay()
    if door.chance.random() < 0.5:
        transport.abort()
    else:
        transport.close()
    return page.frames


_WAYS: dict[str, Visit] = {"direct": _direct, "pages": _page}


async def main() -> None:
    """Let visitors come and go until the standard input ends."""
    options = arguments(__doc__, _WAYS, address=str, most=10)
    door = _Door(random.Random(options.what))
    visit = _WAYS[options.what]
    reader = asyncio.StreamReader()
    await asyncio.get_running_loop().connect_read_pipe(
        lambda: asyncio.StreamReaderProtocol(reader), sys.stdin
    )
    async with asyncio.TaskGroup() as visitors:
        tasks = [
            visitors.create_task(door.come(visit, options.address)) for _ in range(options.most)
        ]
        while word := (await reader.readline()).strip():
            if word in STAY_S:
                door.stay_s = STAY_S[word]
                door.open.set()
            else:
                door.open.clear()
                while door.inside:
                    await asyncio.sleep(_LOOK_S)
            counts = {name: getattr(door, name) for name in ("visits", "frames", "unanswered")}
            print(json.dumps(counts), flush=True)
        for task in tasks:
            task.cancel()


if __name__ == "__main__":
    asyncio.run(main())
