"""What a court says, taken once and given to all pages that watch it."""

import asyncio
import contextlib
import time
from collections.abc import Callable

import msgspec

from lacoc_client.asking import fetch, no_answer
from lacoc_client.event_log import EventLog
from lacoc_client.gateway import wire
from lacoc_client.gateway.threads import Threads
from lacoc_client.gateway.viewer import Frames, Viewer
from lacoc_client.gateway.wire import Kind
from lacoc_shared import log
from lacoc_shared.access import Access
from lacoc_shared.codec import BadMessage, decode, encode, message_hash
from lacoc_shared.keyspace import Keys
from lacoc_shared.messages import PROTOCOL, Event
from lacoc_shared.mistakes import UserError
from lacoc_shared.session import Mailbox, Session, open_client

SILENT_AFTER_S = 1.0
"""A court that sends no frame for so long is not connected: it sends one every 20 ms."""

_EVENTS_DEPTH = 4096
_LOOK_S = 0.25
_SAY_S = 1.0
_RETRY_S = 1.0
_WHY_S = 3.0
_FETCH_AGAIN_S = 0.3
_MAX_BYTES = 1 << 20


class _Frame(msgspec.Struct, array_like=True):
    """What the gateway needs to know of a frame; the rest goes on unread."""

    match: int
    beat: int
    phase: int
    countdown_beats: int
    clock_ticks: int
    seats: msgspec.Raw
    markers: msgspec.Raw
    poses: msgspec.Raw
    scene: bytes


class _Sheet(msgspec.Struct):
    protocol: int
    scene: bytes
    match_id: str = ""


class _Health(msgspec.Struct):
    match: int
    beat: int
    events: int = 0
    sheet: bytes = b""


class CourtFeed:
    """A court as its pages see it; used from the event loop only.

    It may be made before there is a court, and outlives any number of its restarts.

    Args:
        access: the way to the court, for somebody who watches.
        threads: where it asks the court.
    """

    def __init__(self, access: Access, threads: Threads) -> None:
        self.access = access
        self.court = court = access.court
        self.session: Session | None = None
        """The connection; None until there was one."""
        self._keys = Keys(court)
        self._threads = threads
        self._viewers: dict[Viewer, None] = {}
        self._gone = Frames()
        """What the pages got that have gone."""
        self.match_id = ""
        """The match that is on, as its record is named."""
        self._say = log.get(court=court)
        self._log: EventLog[bytes] = EventLog()
        self._frame: bytes | None = None
        self._sheet: bytes | None = None
        self._scene: bytes | None = None
        self._health: bytes | None = None
        self._frame_scene = self._sheet_scene = self._scene_hash = b""
        self._frame_s = time.monotonic()
        self._connected = False
        """Whether it sends frames, of the version that this gateway speaks: only then pages do."""
        self._why = ""
        self._wrong_version = ""
        self._told = _Health(0, 0)
        """What the court said last of all that it sent."""
        self._sheet_hash = b""
        self._doubt = False
        """Something made no sense: is this still a court of this version? Its sheet says."""
        self._restoring: asyncio.Task[None] | None = None
        self._explaining: asyncio.Task[None] | None = None
        self._explained_s = 0.0
        self._task: asyncio.Task[None] | None = None

    def start(self) -> None:
        """Begin to listen to the court, once."""
        if self._task is None:
            self._task = asyncio.get_running_loop().create_task(self._run())

    async def stop(self) -> None:
        """Close the connection."""
        started = (self._task, self._restoring, self._explaining)
        tasks = [task for task in started if task]
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        if self.session is not None:
            self.session.close()

    @property
    def viewers(self) -> int:
        """How many pages watch."""
        return len(self._viewers)

    def others(self, viewer: Viewer) -> int:
        """How many other pages watch that may do what this one may: act, or only watch."""
        return sum(one.can_act == viewer.can_act for one in self._viewers if one is not viewer)

    @property
    def connected(self) -> bool:
        """Whether the court sends frames."""
        return self._connected

    def frames(self) -> Frames:
        """What became of the frames of all pages; may be asked from any thread."""
        all_frames = [self._gone, *(viewer.frames for viewer in list(self._viewers))]
        return Frames(
            sum(frames.sent for frames in all_frames), sum(frames.dropped for frames in all_frames)
        )

    def log(self, text: str, kind: str, **particulars: object) -> None:
        """Log something of this court."""
        self._say.info(text, kind=kind, match_id=self.match_id, **particulars)

    def add(self, viewer: Viewer) -> None:
        """Let a page watch; it gets all there is at once."""
        viewer.send(self._link())
        self._send_all(viewer)
        self._viewers[viewer] = None

    def remove(self, viewer: Viewer) -> None:
        """Let a page go."""
        if viewer in self._viewers:
            del self._viewers[viewer]
            self._gone.sent += viewer.frames.sent
            self._gone.dropped += viewer.frames.dropped

    def _send_all(self, viewer: Viewer) -> None:
        for framed in (self._sheet, self._scene, *self._log, self._health):
            if framed is not None:
                viewer.send(framed)
        if self._frame is not None and self._connected:  # never an old picture as a new one
            viewer.send(self._frame)

    def _send(self, framed: bytes) -> None:
        for viewer in self._viewers:
            viewer.send(framed)

    async def _run(self) -> None:
        while self.session is None:
            try:
                self.session = await self._threads.run(
                    lambda: open_client([self.access.connect], credentials=self.access.credentials)
                )
                await self._subscribe(self.session)
            except UserError as error:
                self._why = str(error)
                self._send(self._link())
                await asyncio.sleep(_RETRY_S)
        self._why, self._frame_s = "", time.monotonic()
        said_s = 0.0
        while True:
            now_s = time.monotonic()
            silent = now_s - self._frame_s >= SILENT_AFTER_S
            was, self._connected = self._connected, self._connected and not silent
            if was and silent:
                self.log(f"Court {self.court} is silent.", "link", connected=False)
            if not self._connected and (was or now_s - said_s >= _SAY_S):
                said_s = now_s
                self._send(self._link())
                if silent:
                    self._explain(now_s)
            await asyncio.sleep(_LOOK_S)

    def _come_back(self) -> None:
        """A frame after a silence: the court may be another one, so everything is sent again."""
        self._connected, self._why = True, ""
        self.log(f"Court {self.court} sends frames.", "link", connected=True)
        self._send(self._link())
        for viewer in self._viewers:
            self._send_all(viewer)

    def _link(self) -> bytes:
        silent_s = max(0.0, time.monotonic() - self._frame_s)
        text = ""
        if not self._connected:
            text = self._wrong_version or self._why
        return wire.map_message(
            Kind.LINK,
            {
                "court": self.court,
                "connected": self._connected,
                "silent_s": round(silent_s, 1),
                "text": text,
                "log": self._log.number,
            },
        )

    def _explain(self, now_s: float) -> None:
        """Find words for the silence; asking for them takes a while."""
        idle = self._explaining is None or self._explaining.done()
        if self._wrong_version or not idle or now_s - self._explained_s < _WHY_S:
            return
        self._explained_s = now_s

        assert self.session is not None
        self._explaining = asyncio.get_running_loop().create_task(self._find_words(self.session))

    async def _find_words(self, session: Session) -> None:
        text = await self._threads.run(lambda: no_answer(session, self.court))
        self._why = "" if self._connected else text

    async def _subscribe(self, session: Session) -> None:
        """Listen; pages that see a frame know its sheet and all that happened before."""
        loop = asyncio.get_running_loop()

        def hear(key: str, depth: int, take: Callable[[bytes], None]) -> None:
            boxes: list[Mailbox] = []

            def empty() -> None:
                while boxes and (mail := boxes[0].take()) is not None:
                    take(mail.payload)

            def notify() -> None:  # on Zenoh's thread
                with contextlib.suppress(RuntimeError):  # the loop has ended
                    loop.call_soon_threadsafe(empty)

            boxes.append(session.mailbox(key, depth, notify))
            empty()  # what came before there was a box to look into

        hear(self._keys.sheet, 1, self._hear_sheet)
        hear(self._keys.event, _EVENTS_DEPTH, self._take_event)
        with contextlib.suppress(UserError, BadMessage):  # it will come
            await self._fetch_sheet()
            self._take_log(await self._ask(self._keys.event))
        hear(self._keys.health, 1, self._take_health)
        hear(self._keys.frame, 1, self._take_frame)

    def _take_frame(self, payload: bytes) -> None:
        try:
            self._frame_scene = decode(payload, _Frame, _MAX_BYTES).scene
        except BadMessage:
            self._stray()
            return
        now_s = self._frame_s = time.monotonic()
        framed = self._frame = wire.message(Kind.FRAME, payload)
        if not (self._connected or self._wrong_version):
            self._come_back()
        if self._connected:
            for viewer in self._viewers:
                viewer.offer(framed, now_s)
        if self._lacks_scene or self._lacks_sheet:
            self._catch_up()

    def _take_event(self, payload: bytes) -> None:
        try:
            event = decode(payload, Event, _MAX_BYTES)
        except BadMessage:
            self._stray()
            return
        log = self._log.number
        framed = wire.message(Kind.EVENT, payload)
        if not self._log.add(event, framed):
            return
        if self._log.number == log:
            self._send(framed)
        else:
            self._send_log()

    def _send_log(self) -> None:
        self._send(self._link())  # its new number says that what was before is no more
        for kept in self._log:
            self._send(kept)

    @property
    def _lacks_events(self) -> bool:
        return self._log.differs(self._told.match, self._told.beat, self._told.events)

    @property
    def _lacks_scene(self) -> bool:
        return self._frame_scene != self._scene_hash

    @property
    def _lacks_sheet(self) -> bool:
        other = self._told.sheet not in (b"", self._sheet_hash)
        return self._doubt or other or self._frame_scene != self._sheet_scene

    def _catch_up(self) -> None:
        """Get what is new, was sent while this was away, or was dropped on a slow link."""
        if self._restoring is None or self._restoring.done():
            self._restoring = asyncio.get_running_loop().create_task(self._restore())

    async def _restore(self) -> None:
        while self._lacks_events or self._lacks_scene or self._lacks_sheet:
            with contextlib.suppress(UserError, BadMessage):  # it went away just now
                if self._lacks_events:
                    self._take_log(await self._ask(self._keys.event))
                if self._lacks_scene:
                    self._take_scene(await self._ask(self._keys.scene))
                if self._lacks_sheet:
                    await self._fetch_sheet()
            await asyncio.sleep(_FETCH_AGAIN_S)
            if not self._connected:
                return  # the next frame or health asks again

    def _take_scene(self, payload: bytes) -> None:
        found = message_hash(payload)
        if found == self._frame_scene and found != self._scene_hash:
            self._scene_hash = found
            self._scene = wire.message(Kind.SCENE, found + payload)
            self._send(self._scene)

    def _take_log(self, payload: bytes) -> None:
        events = decode(payload, tuple[Event, ...], _MAX_BYTES)
        framed = [(event, wire.message(Kind.EVENT, encode(event))) for event in events]
        log = self._log.number
        self._log.restore(framed)
        if self._log.number != log:
            self._send_log()

    async def _fetch_sheet(self) -> None:
        payload = await self._ask(self._keys.sheet)
        try:
            self._take_sheet(payload)
        except BadMessage:
            self._other_version("another version")

    def _hear_sheet(self, payload: bytes) -> None:
        try:
            self._take_sheet(payload)
        except BadMessage:
            self._stray()

    def _take_sheet(self, payload: bytes) -> None:
        sheet = decode(payload, _Sheet, _MAX_BYTES)
        self._doubt = False
        self._sheet_scene, self.match_id = sheet.scene, sheet.match_id
        self._sheet_hash = message_hash(payload)
        if sheet.protocol != PROTOCOL:
            self._other_version(f"version {sheet.protocol}")
            return
        self._wrong_version = ""
        framed = wire.message(Kind.SHEET, payload)
        if framed != self._sheet:
            self._sheet = framed
            self._send(framed)

    def _take_health(self, payload: bytes) -> None:
        try:
            self._told = decode(payload, _Health, _MAX_BYTES)
        except BadMessage:
            self._stray()
            return
        if self._lacks_events or self._lacks_sheet:
            self._catch_up()
        if self._wrong_version:
            return
        self._health = framed = wire.message(Kind.HEALTH, payload)
        for viewer in self._viewers:
            viewer.send_if_fast(framed)

    def _stray(self) -> None:
        """Something made no sense: the sheet says whether the court has another version."""
        if not self._wrong_version:
            self._doubt = True
            self._catch_up()

    def _other_version(self, speaks: str) -> None:
        """Show nothing of the court until it has another sheet."""
        wrong = (
            f"Court {self.court!r} speaks {speaks} of the protocol, this gateway version "
            f"{PROTOCOL}: install the version of lacoc that the court has."
        )
        if wrong != self._wrong_version:
            self._wrong_version, self._connected = wrong, False
            self.log(wrong, "link", connected=False)
            self._send(self._link())

    async def _ask(self, key: str) -> bytes:
        session = self.session
        assert session is not None
        return await self._threads.run(lambda: fetch(session, self._keys, key))
