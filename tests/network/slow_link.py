"""A bad link between a program and a court: a TCP proxy that delays, loses, stalls and cuts."""

import asyncio
import random
import threading
from collections.abc import Callable
from typing import Self


class SlowLink:
    """A proxy on a thread of its own; a program connects to its `address` instead of the court's.

    As with TCP, everything arrives in order. Each packet is delayed in each direction by `delay_s`,
    plus or minus `jitter_s`. A lost packet is sent again: it and all packets behind it arrive
    `RESEND_S` later. The attributes may be changed at any time.

    Args:
        address: the court's address, "tcp/HOST:PORT".
        delay_s: delay one way; a round trip takes twice as long.
        jitter_s: jitter one way; at most `delay_s`.
        loss: share of the packets that are lost, 0-1.
        seed: the same seed gives the same jitter and losses.
    """

    RESEND_S = 0.2
    """The shortest time after which TCP sends a lost packet again (Linux)."""

    def __init__(
        self,
        address: str,
        delay_s: float = 0.0,
        jitter_s: float = 0.0,
        loss: float = 0.0,
        seed: int = 1,
    ) -> None:
        self.delay_s = delay_s
        self.jitter_s = jitter_s
        self.loss = loss
        self.address = ""
        """Address to which a program connects; its port does not change."""
        host, _, port = address.removeprefix("tcp/").rpartition(":")
        self._court = (host, int(port))
        self._chance = random.Random(seed)
        self._is_cut = False
        self._writers: set[asyncio.StreamWriter] = set()
        self._loop = asyncio.new_event_loop()
        self._flowing = asyncio.Event()
        self._flowing.set()
        self._closing = asyncio.Event()
        self._listening = threading.Event()
        self._thread = threading.Thread(target=self._loop.run_until_complete, args=(self._serve(),))

    def __enter__(self) -> Self:
        self._thread.start()
        assert self._listening.wait(10.0)
        return self

    def __exit__(self, *_: object) -> None:
        self._loop.call_soon_threadsafe(self._closing.set)
        self._thread.join()
        self._loop.close()

    def stall(self) -> None:
        """Let nothing through and close nothing, like a pulled cable."""
        self._do(self._flowing.clear)

    def flow(self) -> None:
        """Let data through again, beginning with what has waited."""
        self._do(self._flowing.set)

    def cut(self) -> None:
        """Break all connections and refuse new ones; data on its way is lost."""
        self._do(self._cut)

    def mend(self) -> None:
        """Accept new connections again."""
        self._do(self._mend)

    def _do(self, what: Callable[[], None]) -> None:
        """Call a function on the link's thread, and wait until it has returned."""
        done = threading.Event()
        self._loop.call_soon_threadsafe(lambda: (what(), done.set()))
        assert done.wait(10.0)

    def _cut(self) -> None:
        self._is_cut = True
        for writer in self._writers:
            writer.transport.abort()

    def _mend(self) -> None:
        self._is_cut = False

    async def _serve(self) -> None:
        server = await asyncio.start_server(self._connect, "127.0.0.1", 0)
        self.address = f"tcp/127.0.0.1:{server.sockets[0].getsockname()[1]}"
        self._listening.set()
        await self._closing.wait()
        server.close()
        connections = asyncio.all_tasks() - {asyncio.current_task()}
        for task in connections:
            task.cancel()
        await asyncio.gather(*connections, return_exceptions=True)

    async def _connect(self, near: asyncio.StreamReader, back: asyncio.StreamWriter) -> None:
        self._writers.add(back)
        try:
            if self._is_cut:
                return
            far, forth = await asyncio.open_connection(*self._court)
            self._writers.add(forth)
            try:
                ways = [
                    asyncio.ensure_future(self._carry(reader, writer))
                    for reader, writer in ((near, forth), (far, back))
                ]
                try:
                    await asyncio.wait(ways, return_when=asyncio.FIRST_COMPLETED)
                finally:
                    for way in ways:
                        way.cancel()
                    await asyncio.gather(*ways, return_exceptions=True)
            finally:
                self._hang_up(forth)
        except (OSError, asyncio.CancelledError):  # one side is missing or gone, or the test ends
            pass
        finally:
            self._hang_up(back)

    def _hang_up(self, writer: asyncio.StreamWriter) -> None:
        self._writers.discard(writer)
        writer.close()

    async def _carry(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Forward data in one direction until its sender closes and everything is delivered."""
        under_way: asyncio.Queue[tuple[float, bytes]] = asyncio.Queue()
        delivering = asyncio.ensure_future(self._deliver(under_way, writer))
        try:
            due_s = 0.0
            while packet := await reader.read(65_536):
                due_s = max(due_s, self._loop.time() + self._takes_s())
                under_way.put_nowait((due_s, packet))
                await self._flowing.wait()  # while stalled, read nothing: the sender's buffers fill
            await under_way.join()
        finally:
            delivering.cancel()

    async def _deliver(
        self, under_way: asyncio.Queue[tuple[float, bytes]], writer: asyncio.StreamWriter
    ) -> None:
        while True:
            due_s, packet = await under_way.get()
            await asyncio.sleep(due_s - self._loop.time())
            await self._flowing.wait()
            writer.write(packet)
            await writer.drain()
            under_way.task_done()

    def _takes_s(self) -> float:
        jitter_s = self._chance.uniform(-self.jitter_s, self.jitter_s)
        lost = self._chance.random() < self.loss
        return self.delay_s + jitter_s + (self.RESEND_S if lost else 0.0)
