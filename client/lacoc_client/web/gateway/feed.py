"""Receives each message of a court once, and passes it on to all pages that watch the court."""

import asyncio
import contextlib
import time
from collections.abc import Callable

from lacoc_client.play.asking import fetch, no_answer
from lacoc_client.web.gateway import wire
from lacoc_client.web.gateway.audience import Audience, Listener
from lacoc_client.web.gateway.picture import CourtPicture
from lacoc_client.web.gateway.threads import Threads
from lacoc_client.web.gateway.viewer import Viewer
from lacoc_client.web.gateway.wire import MessageKind
from lacoc_shared.codec import BadMessage
from lacoc_shared.command import log
from lacoc_shared.contest.access import Access
from lacoc_shared.keyspace import KeySpace
from lacoc_shared.messages import PROTOCOL
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.session import Mailbox, Session, open_client
from lacoc_shared.seat import SILENT_AFTER_S
from lacoc_shared.words import Phrase, render, say

_EVENTS_DEPTH = 4096
_LOOK_S = 0.25
_SAY_S = 1.0
_RETRY_S = 1.0
_WHY_S = 3.0
_FETCH_AGAIN_S = 0.3
_TRIP_S = 1.0
"""Least time between two measurements of how long a court takes to answer [s]."""
_JOINED_S = 3.0
"""Longest wait of `joined` for a court that is not connected yet [s]."""


class CourtFeed:
    """Receives the messages of one court for all pages; used from the event loop only.

    It may be started before the court, and goes on after each restart of the court.

    Args:
        access: how to reach the court, as a spectator.
        threads: threads that ask the court.
    """

    def __init__(self, access: Access, threads: Threads) -> None:
        self.access = access
        self.court = court = access.court
        self.session: Session | None = None
        """The connection to the court; None until the first one is open."""
        self._keys = KeySpace(court)
        self._threads = threads
        self.audience = Audience()
        """The pages that watch."""
        self.picture = CourtPicture()
        """The newest state of the court, as the bytes for pages."""
        self._say = log.get(court=court)
        self._frame_s = time.monotonic()
        self._connected = False
        """Whether the court sends frames in this gateway's version of the protocol; only then pages
        get them."""
        self._why: Phrase | None = None
        """Why the court sends no frames; None: it does, or the reason is not known."""
        self._logs_asked = 0
        """Number of requests for the list of events that have no answer yet."""
        self._held_events: list[bytes] = []
        """The events that came while a list of events was requested."""
        self._restoring: asyncio.Task[None] | None = None
        self._explaining: asyncio.Task[None] | None = None
        self._explained_s = 0.0
        self._trip_ms: float | None = None
        self._trip_asked_s = -_TRIP_S
        self._measuring: asyncio.Task[None] | None = None
        self._task: asyncio.Task[None] | None = None

    def start(self) -> None:
        """Start listening to the court; a second call does nothing."""
        if self._task is None:
            self._task = asyncio.get_running_loop().create_task(self._run())

    async def stop(self) -> None:
        """Stop listening to the court, and close the connection to it."""
        started = (self._task, self._restoring, self._explaining, self._measuring)
        tasks = [task for task in started if task]
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        if self.session is not None:
            self.session.close()

    @property
    def connected(self) -> bool:
        """Whether the court sends frames that pages can show."""
        return self._connected

    async def joined(self) -> Session:
        """Return the connection to the court; wait up to some seconds until the court is heard.

        Raises:
            UserError: if the court still sends no frames then.
        """
        end_s = time.monotonic() + _JOINED_S
        while not self._connected and time.monotonic() < end_s:
            await asyncio.sleep(_LOOK_S)
        if self.session is None or not self._connected:
            raise UserError(self._why or say("gateway.court-not-there", court=self.court))
        return self.session

    def trip_ms(self) -> float | None:
        """Return how long the court's newest answer took [ms], and measure again if it is time.

        None: nothing was measured yet, or the court does not answer.
        """
        now_s = time.monotonic()
        idle = self._measuring is None or self._measuring.done()
        if self.session is not None and idle and now_s - self._trip_asked_s >= _TRIP_S:
            self._trip_asked_s = now_s
            self._measuring = asyncio.get_running_loop().create_task(self._measure())
        return self._trip_ms

    async def _measure(self) -> None:
        began_s = time.monotonic()
        try:
            await self._ask(self._keys.sheet)
        except UserError:
            self._trip_ms = None
        else:
            self._trip_ms = 1000 * (time.monotonic() - began_s)

    def log(self, text: str, kind: str, **particulars: object) -> None:
        """Write a line about this court into the gateway's log."""
        self._say.info(text, kind=kind, match_id=self.picture.view.match_id, **particulars)

    def add(self, viewer: Viewer) -> None:
        """Let a page watch the court, and send it everything that is known of the court's match."""
        for framed in (self._link(), *self._all()):
            viewer.send(framed)
        self.audience.add(viewer)

    def tap(self, listener: Listener) -> None:
        """Let a listener receive what pages receive, first all that is known of the court."""
        for framed in (self._link(), *self._all()):
            listener.send(framed)
        self.audience.tap(listener)

    def _all(self) -> tuple[bytes, ...]:
        frame = self.picture.frame
        if frame is None or not self._connected:  # an old frame must not look like a new one
            return self.picture.all_but_frame()
        return (*self.picture.all_but_frame(), frame)

    async def _run(self) -> None:
        while self.session is None:
            try:
                self.session = await self._threads.run(
                    lambda: open_client(self.access.addresses, authority=self.access.authority)
                )
                await self._subscribe(self.session)
            except UserError as error:
                self._why = error.phrase
                self.audience.send(self._link())
                await asyncio.sleep(_RETRY_S)
        self._why, self._frame_s = None, time.monotonic()
        said_s = 0.0
        while True:
            now_s = time.monotonic()
            silent = now_s - self._frame_s >= SILENT_AFTER_S
            was, self._connected = self._connected, self._connected and not silent
            if was and silent:
                self.log(f"Court {self.court} is silent.", "link", connected=False)
            if not self._connected and (was or now_s - said_s >= _SAY_S):
                said_s = now_s
                self.audience.send(self._link())
                if silent:
                    self._explain(now_s)
            await asyncio.sleep(_LOOK_S)

    def _come_back(self) -> None:
        """Show the court again after it was silent, and send pages everything about it.

        It may have a new match.
        """
        self._connected, self._why = True, None
        self.log(f"Court {self.court} sends frames.", "link", connected=True)
        self.audience.send(self._link(), *self._all())

    def _link(self) -> bytes:
        silent_s = max(0.0, time.monotonic() - self._frame_s)
        why = None if self._connected else self._wrong_version or self._why
        return wire.map_message(
            MessageKind.LINK,
            {
                "court": self.court,
                "connected": self._connected,
                "silent_s": round(silent_s, 1),
                "why": why,
                "log": self._log_number,
            },
        )

    def _explain(self, now_s: float) -> None:
        """Start to find out why the court is silent; pages are told the reason later."""
        idle = self._explaining is None or self._explaining.done()
        if self._wrong_version or not idle or now_s - self._explained_s < _WHY_S:
            return
        self._explained_s = now_s
        assert self.session is not None
        self._explaining = asyncio.get_running_loop().create_task(self._find_words(self.session))

    async def _find_words(self, session: Session) -> None:
        why = await self._threads.run(lambda: no_answer(session, self.court))
        self._why = None if self._connected else why

    async def _subscribe(self, session: Session) -> None:
        """Subscribe to sheet and events, fetch both, then subscribe to health and frames."""
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
            empty()  # messages that came before the mailbox was in the list

        hear(self._keys.sheet, 1, self._hear_sheet)
        hear(self._keys.event, _EVENTS_DEPTH, self._take_event)
        with contextlib.suppress(UserError, BadMessage):  # they come later
            await self._fetch_sheet()
            await self._fetch_log()
        hear(self._keys.health, 1, self._take_health)
        hear(self._keys.frame, 1, self._take_frame)

    def _take_frame(self, payload: bytes) -> None:
        try:
            framed = self.picture.take_frame(payload)
        except BadMessage:
            self._stray()
            return
        now_s = self._frame_s = time.monotonic()
        if not self._connected and self._other_version is None:
            self._come_back()
        if self._connected:
            self.audience.offer(framed, now_s)
        if self.picture.view.lacks_scene or self.picture.view.lacks_sheet:
            self._catch_up()

    def _take_event(self, payload: bytes) -> None:
        if self._logs_asked:
            self._held_events.append(payload)
            return
        number = self._log_number
        try:
            framed = self.picture.take_event(payload)
        except BadMessage:
            self._stray()
            return
        if self._log_number != number:
            self._send_log()
        elif framed is not None:
            self.audience.send(framed)

    def _take_log(self, payload: bytes) -> None:
        number = self._log_number
        self.picture.view.take_log(payload)
        if self._log_number != number:
            self._send_log()

    def _send_log(self) -> None:
        # The new log number in the link message tells pages to drop the old events.
        self.audience.send(self._link(), *self.picture.log)

    def _take_scene(self, payload: bytes) -> None:
        framed = self.picture.take_scene(payload)
        if framed is not None:
            self.audience.send(framed)

    def _hear_sheet(self, payload: bytes) -> None:
        try:
            self._take_sheet(payload)
        except BadMessage:
            self._stray()

    def _take_sheet(self, payload: bytes) -> None:
        before = self._other_version
        framed = self.picture.take_sheet(payload)
        if framed is not None:
            self.audience.send(framed)
        self._look_at_version(before)

    def _take_health(self, payload: bytes) -> None:
        try:
            framed = self.picture.take_health(payload)
        except BadMessage:
            self._stray()
            return
        if self.picture.view.lacks_events or self.picture.view.lacks_sheet:
            self._catch_up()
        if framed is not None:
            self.audience.send_if_fast(framed)

    def _stray(self) -> None:
        """Fetch the sheet after a message could not be decoded: it names the court's version."""
        if self._other_version is None:
            self.picture.view.doubt()
            self._catch_up()

    def _look_at_version(self, before: int | None) -> None:
        """Hide the court if its newest sheet shows another version of the protocol than ours.

        Args:
            before: the other version that was known before this sheet; None: none was known. If it
                has not changed, the court is hidden already.
        """
        if self._other_version not in (None, before):
            self._connected = False
            self.log(render(self._wrong_version or ""), "link", connected=False)
            self.audience.send(self._link())

    @property
    def _other_version(self) -> int | None:
        return self.picture.view.other_version

    @property
    def _log_number(self) -> int:
        """A number that changes whenever earlier events of the match may have changed."""
        return self.picture.view.log.number

    @property
    def _wrong_version(self) -> Phrase | None:
        """Why the court can't be shown: it has another version of the protocol.

        None: it has ours.
        """
        if self._other_version is None:
            return None
        version = self._other_version or None
        return say("gateway.other-version", court=self.court, version=version, gateway=PROTOCOL)

    def _catch_up(self) -> None:
        """Start to fetch those events, sheet and scene of the match that have not arrived."""
        if self._restoring is None or self._restoring.done():
            self._restoring = asyncio.get_running_loop().create_task(self._restore())

    async def _restore(self) -> None:
        view = self.picture.view
        while view.lacks_events or view.lacks_scene or view.lacks_sheet:
            with contextlib.suppress(UserError, BadMessage):  # the court went away
                if view.lacks_events:
                    await self._fetch_log()
                if view.lacks_scene:
                    self._take_scene(await self._ask(self._keys.scene))
                if view.lacks_sheet:
                    await self._fetch_sheet()
            await asyncio.sleep(_FETCH_AGAIN_S)
            if not self._connected:
                return  # the next frame or health asks again

    async def _fetch_log(self) -> None:
        """Fetch all events of the match, and then add those that came while the court answered."""
        self._logs_asked += 1
        try:
            self._take_log(await self._ask(self._keys.event))
        finally:
            self._logs_asked -= 1
            held, self._held_events = self._held_events, []
            for payload in held:  # held again while another answer is under way
                self._take_event(payload)

    async def _fetch_sheet(self) -> None:
        payload, before = await self._ask(self._keys.sheet), self._other_version
        try:
            self._take_sheet(payload)
        except BadMessage:
            self.picture.view.refuse_sheet()
            self._look_at_version(before)

    async def _ask(self, key: str) -> bytes:
        session = self.session
        assert session is not None
        return await self._threads.run(lambda: fetch(session, self._keys, key))
