"""How soon a group sees a number that one of its members typed, in a whole class.

python -m benchmarks.group_table --students 30 --groups 8 --seconds 60

All students have a page's own connection and a table of their group. Each types a number every two
seconds. The sender gets an answer when the number is on the disk; the others get it earlier.
"""

import asyncio
import random
import tempfile
import time
from pathlib import Path
from typing import Any

from arguments import arguments
from class_room import ClassRoom
from page_table import PageTable
from tests.campaigns.kill.lesson import Page
from websockets.asyncio.client import connect

from benchmarks.figures import finish, spread
from lacoc_client.web.gateway.wire import MessageKind

_TYPE_S = 2.0
_AIM_MS = 200.0


class Member:
    """A scripted member of a group.

    Args:
        name: the nickname.
        group: name of the group.
        sent_s: when each update of anybody was sent.
    """

    def __init__(self, name: str, group: str, sent_s: dict[bytes, float]) -> None:
        self._name = name
        self._group = group
        self._sent_s = sent_s
        self._rng = random.Random(name)
        self._table: PageTable | None = None
        self.seen_ms: list[float] = []
        """For each number of another member: time from its sending to its arrival here."""
        self.kept_ms: list[float] = []
        """For each own number: time from its sending until it was on the disk."""

    async def work(self, url: str, code: str, ends_s: float) -> None:
        """Come in, join the group, and type until the time is over."""
        address = f"{url.replace('http', 'ws', 1)}/design/ws"
        async with connect(address, max_size=None, compression=None) as socket:
            page = Page(socket)
            reading = asyncio.ensure_future(page.read(self._told))
            hello = await page.ask("hello", code=code, name=self._name)
            first = PageTable(hello["table"])
            sample = (await page.ask("sample"))["table"]
            await page.ask("table", **first.write(sample, [[0], [8, 7, 6, 5], [1, 2, 3, 4]]))
            await page.ask("group", act="join", text=self._group)
            while time.monotonic() < ends_s:
                await asyncio.sleep(self._rng.uniform(0.5, 1.5) * _TYPE_S)
                await self._type(page)
            reading.cancel()

    async def _type(self, page: Page) -> None:
        assert self._table is not None
        cell = f"p6/{self._rng.randrange(9)}.0/{self._rng.randrange(18)}"
        fields = self._table.put({cell: round(self._rng.uniform(-90, 90), 6)})
        begin_s = self._sent_s[fields["update"]] = time.monotonic()
        await page.ask("table", **fields)
        self.kept_ms.append(1000 * (time.monotonic() - begin_s))

    def _told(self, kind: int, body: dict[str, Any]) -> None:
        if kind != MessageKind.TABLE or not body["table"]:
            return
        if "state" in body:
            self._table = PageTable({**body, "others": 0})
        elif "update" in body and self._table is not None:
            if body["update"] in self._sent_s:
                passed_s = time.monotonic() - self._sent_s[body["update"]]
                self.seen_ms.append(1000 * passed_s)
            self._table.take(body["update"])


def main() -> None:
    """Measure, print, and exit with 1 if the aim is missed."""
    options = arguments(__doc__, students=30, groups=8, seconds=60.0)
    sent_s: dict[bytes, float] = {}
    members = [
        Member(f"student {number}", f"group {number % options.groups}", sent_s)
        for number in range(options.students)
    ]

    async def lesson(room: ClassRoom) -> None:
        ends_s = time.monotonic() + options.seconds
        await asyncio.gather(*(one.work(room.url, room.code, ends_s) for one in members))

    with tempfile.TemporaryDirectory() as name:
        room = ClassRoom(Path(name), fresh=True)
        try:
            asyncio.run(lesson(room))
        finally:
            room.close()
    seen_ms = [ms for one in members for ms in one.seen_ms]
    kept_ms = [ms for one in members for ms in one.kept_ms]
    found = {
        "students": options.students,
        "groups": options.groups,
        "numbers": len(kept_ms),
        **spread(seen_ms, "seen_{}_ms"),
        **spread(kept_ms, "kept_{}_ms"),
    }
    finish(found, found["seen_p95_ms"] <= _AIM_MS)


if __name__ == "__main__":
    main()
