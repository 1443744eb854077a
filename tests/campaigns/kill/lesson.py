"""A class for a lesson: its processor time, how late the teacher sees trials, what kills lose.

    python -m tests.campaigns.kill.lesson --students 30 --minutes 45 --speed 2 --kills 10

Each student changes a number every 5 s and tries every 10 s, through a page's own connection. With
`--speed 2` all pauses are half as long, and the same work is done in half the time. At random
moments the gateway, or its studio, is killed (SIGKILL). A gateway is started again on the same
folder, and everybody comes in again with the token that the page keeps.
"""

import argparse
import asyncio
import random
import sys
import tempfile
import time
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import msgpack
import psutil
from arguments import arguments
from class_room import ClassRoom
from page_table import PageTable, from_kept
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed

from lacoc_client.web.gateway.wire import MessageKind
from lacoc_client.workshop.classroom.classroom import CLASS_FILE
from lacoc_client.workshop.design.learning.student import TABLE
from lacoc_client.workshop.phases.class_file import ClassFile
from lacoc_client.workshop.phases.evidence import Edited, Tried

_EDIT_S, _TRY_S = 5.0, 10.0
_AGAIN_S = 0.2
_OLD_S = 2.0
"""An edit that was acknowledged so long before a kill must not be lost."""
_SEEN_S, _MOST_CORES = 1.0, 1.0
_SEQUENCES = [[0], [4, 3, 2, 1], [1, 2, 3, 4], [2, 1, 4, 3]]


class Page:
    """One open connection; requests are answered in any order."""

    def __init__(self, socket: ClientConnection) -> None:
        self._socket = socket
        self._asked: dict[int, asyncio.Future[dict[str, Any]]] = {}
        self._last = 0

    async def ask(self, do: str, **fields: Any) -> Any:
        """Ask the gateway to do something; return the value of the reply.

        Raises:
            ConnectionClosed: if the gateway has gone.
            RuntimeError: if the gateway refuses.
        """
        self._last += 1
        answer = self._asked[self._last] = asyncio.get_running_loop().create_future()
        await self._socket.send(msgpack.packb({"id": self._last, "do": do, **fields}))
        reply = await answer
        if not reply["ok"]:
            raise RuntimeError(reply["error"]["code"])
        return reply["value"]

    async def read(self, told: Any = None) -> None:
        """Take in messages until the gateway has gone; `told` gets all except replies."""
        try:
            async for message in self._socket:
                assert isinstance(message, bytes)
                body = msgpack.unpackb(message[1:])
                if message[0] == MessageKind.REPLY:
                    self._asked.pop(body["id"]).set_result(body)
                elif told is not None:
                    told(message[0], body)
        except ConnectionClosed:
            pass
        for answer in self._asked.values():
            answer.set_exception(ConnectionError())
            answer.exception()  # perhaps nobody waits for it any more


@dataclass
class Lesson:
    """What all pages share, and what they found."""

    url: str
    code: str
    key: str
    speed: float
    ends_s: float
    killed_s: list[float] = field(default_factory=list)
    edits: Counter[str] = field(default_factory=Counter)
    """Acknowledged edits of each student."""
    tries: Counter[str] = field(default_factory=Counter)
    tried_s: dict[tuple[str, int], float] = field(default_factory=dict)
    """When each trial of a student was answered."""
    seen_s: dict[tuple[str, int], float] = field(default_factory=dict)
    """When the teacher's page first had it."""
    lost_edits: int = 0

    @property
    def is_on(self) -> bool:
        """Whether the lesson still goes on."""
        return time.monotonic() < self.ends_s

    async def page(self, path: str, work: Any, told: Any = None) -> None:
        """Call `work` with a connection until the lesson ends; connect again after a kill."""
        address = f"{self.url.replace('http', 'ws', 1)}{path}"
        while self.is_on:
            try:
                async with connect(address, max_size=None, compression=None) as socket:
                    page = Page(socket)
                    reading = asyncio.ensure_future(page.read(told))
                    try:
                        await work(page)
                    finally:
                        reading.cancel()
            except (OSError, ConnectionClosed, RuntimeError):
                await asyncio.sleep(_AGAIN_S)


class Student:
    """A scripted student.

    Args:
        name: the nickname.
        lesson: what all share.
    """

    def __init__(self, name: str, lesson: Lesson) -> None:
        self.name = name
        self._lesson = lesson
        self._rng = random.Random(name)
        self._token = ""
        self._table: dict[str, Any] = {}
        self._acknowledged: list[tuple[float, float]] = []
        """When each edit was acknowledged, and the angle that it made."""

    async def work(self, page: Page) -> None:
        """Enter the class, count the edits that a kill has lost, then edit and try."""
        lesson = self._lesson
        opens = {"token": self._token} if self._token else {"code": lesson.code}
        hello = await page.ask("hello", name=self.name, **opens)
        self._token = hello["token"]
        if self._table:
            self._compare(PageTable(hello["table"]).table)
        else:
            self._table = (await page.ask("sample"))["table"]
        shared = PageTable(hello["table"])
        await page.ask("table", **shared.write(self._table, _SEQUENCES))  # as a page that opens
        next_try_s = time.monotonic() + self._rng.uniform(0, _TRY_S) / lesson.speed
        while lesson.is_on:
            await asyncio.sleep(self._rng.uniform(0.5, 1.5) * _EDIT_S / lesson.speed)
            await self._edit(page, shared)
            if time.monotonic() >= next_try_s:
                next_try_s += _TRY_S / lesson.speed
                await page.ask("trial", table=self._table, sequences=_SEQUENCES, keys="2")
                lesson.tries[self.name] += 1
                lesson.tried_s[self.name, lesson.tries[self.name]] = time.monotonic()

    async def _edit(self, page: Page, shared: PageTable) -> None:
        # A new angle each time, so that the table says which edit it has.
        angle_deg = round(self._rng.uniform(-20, 20), 6)
        row = self._table["rows"][0]
        before = shared.table
        row["angles_deg"] = [angle_deg, *row["angles_deg"][1:]]
        await page.ask("table", **shared.write(self._table, _SEQUENCES))
        told = {"before": before, "table": self._table, "sequences": _SEQUENCES, "by": "hand"}
        await page.ask("edit", **told)
        self._acknowledged.append((time.monotonic(), angle_deg))
        self._lesson.edits[self.name] += 1

    def _compare(self, table: dict[str, Any] | None) -> None:
        """Count the lost edits that were acknowledged more than 2 s before the last kill."""
        angle_deg = table["rows"][0]["angles_deg"][0] if table else None
        killed_s = self._lesson.killed_s[-1] if self._lesson.killed_s else 0.0
        newest_deg = self._table["rows"][0]["angles_deg"][0]
        # The newest edit may have been kept although the kill came before its acknowledgement.
        for at_s, made_deg in () if angle_deg == newest_deg else reversed(self._acknowledged):
            if made_deg == angle_deg:
                break
            self._lesson.lost_edits += at_s < killed_s - _OLD_S
        self._acknowledged.clear()


async def _teach(lesson: Lesson) -> None:
    """Keep the teacher's page open, and note how soon it shows each trial."""

    def told(kind: int, body: dict[str, Any]) -> None:
        cards = [body] if kind == MessageKind.CARD else body.get("cards") or ()
        for card in cards:
            lesson.seen_s.setdefault((card["name"], card["tries"]), time.monotonic())

    async def work(page: Page) -> None:
        await page.ask("hello", key=lesson.key)
        while lesson.is_on:
            await asyncio.sleep(1.0)
            await page.ask("ping", t=0)

    await lesson.page("/class/ws", work, told)


class Clock:
    """Counts the processor time of a process and all its children, also of those that ended."""

    def __init__(self) -> None:
        self._used_s: dict[tuple[int, float], float] = {}

    def look(self, pid: int) -> None:
        """Take in the processor time that a process and its descendants have used so far."""
        try:
            parent = psutil.Process(pid)
            for process in (parent, *parent.children(recursive=True)):
                used = process.cpu_times()
                self._used_s[process.pid, process.create_time()] = used.user + used.system
        except psutil.NoSuchProcess:
            return

    @property
    def used_s(self) -> float:
        """Processor time of all these processes [s]."""
        return sum(self._used_s.values())


async def _hold(options: argparse.Namespace, folder: Path) -> tuple[Lesson, float]:
    """Hold a lesson; return it with what its pages found, and the gateway's processor time [s]."""
    rng, clock = random.Random(1), Clock()
    minutes_s = 60 * options.minutes / options.speed
    kills_s = sorted(rng.uniform(0.05, 0.95) * minutes_s for _ in range(options.kills))
    room = ClassRoom(folder, fresh=True)
    began_s = time.monotonic()
    lesson = Lesson(room.url, room.code, room.key, options.speed, began_s + minutes_s)
    students = [Student(f"student {number}", lesson) for number in range(options.students)]
    pages = [asyncio.ensure_future(lesson.page("/design/ws", one.work)) for one in students]
    pages.append(asyncio.ensure_future(_teach(lesson)))
    while lesson.is_on:
        await asyncio.sleep(0.5)
        clock.look(room.process.pid)
        if not kills_s or time.monotonic() < began_s + kills_s[0]:
            continue
        kills_s.pop(0)
        children = psutil.Process(room.process.pid).children(recursive=True)
        if rng.random() < 0.5:
            rng.choice(children).kill()  # the studio, or one of its processes
            continue
        lesson.killed_s.append(time.monotonic())
        room.process.kill()
        room.close()
        room = await asyncio.to_thread(ClassRoom, folder, room.listen, fresh=True)
    for page in pages:
        page.cancel()
    await asyncio.gather(*pages, return_exceptions=True)
    clock.look(room.process.pid)
    room.close()
    return lesson, clock.used_s


def _lost_evidence(folder: Path, lesson: Lesson) -> int:
    """Count the acknowledged edits and trials that are not in the class file."""
    file = ClassFile(folder / CLASS_FILE)
    kept = file.evidence()
    edits = Counter(one.student for one in kept if isinstance(one.evidence, Edited))
    tries = Counter(one.student for one in kept if isinstance(one.evidence, Tried))
    tables = [from_kept(one.content) for one in file.documents() if one.name == TABLE]
    file.close()
    assert all(tables)
    return (lesson.edits - edits).total() + (lesson.tries - tries).total()


def main() -> None:
    """Hold a lesson, print, and exit with 1 if the aims are missed."""
    options = arguments(__doc__, students=30, minutes=45.0, speed=1.0, kills=10)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        lesson, used_s = asyncio.run(_hold(options, folder))
        lost = _lost_evidence(folder, lesson)
    cores = used_s / (60 * options.minutes)
    lags_s = sorted(
        max(0.0, lesson.seen_s[trial] - answered_s)
        for trial, answered_s in lesson.tried_s.items()
        if trial in lesson.seen_s
    )
    late_s = lags_s[int(0.99 * (len(lags_s) - 1))] if lags_s else 0.0
    print(
        f"{options.students} students, {options.minutes:g} minutes at {options.speed:g} times the "
        f"speed: {lesson.edits.total()} edits, {lesson.tries.total()} trials"
    )
    print(f"processor time: {cores:.2f} of a core at the speed of a real lesson")
    print(
        f"the teacher sees a trial {late_s:.2f} s later (p99), {max(lags_s, default=0):.2f} at most"
    )
    print(
        f"{options.kills} kills, {len(lesson.killed_s)} of the gateway: {lost} pieces of evidence "
        f"lost, {lesson.lost_edits} edits older than {_OLD_S:g} s lost"
    )
    sys.exit(bool(lost or lesson.lost_edits or late_s > _SEEN_S or cores > _MOST_CORES))


if __name__ == "__main__":
    main()
