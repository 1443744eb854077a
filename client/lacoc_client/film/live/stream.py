"""Draws the broadcast's page at a steady pace, and hands pictures and sounds to the sender."""

import base64
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from urllib.parse import urlencode

from playwright.sync_api import Error, Page

from lacoc_client.film.camera_page import told, window
from lacoc_client.film.live.pace import PicturePace
from lacoc_client.film.live.sender import LivePicture, Sender
from lacoc_client.film.live.sending import SOUND_HZ
from lacoc_client.film.live.target import Target
from lacoc_client.film.live.waiting import PageWaiting
from lacoc_client.film.live.watchdog import Watchdog, watched
from lacoc_client.film.look import Look
from lacoc_client.film.shots import JPEG, Shots
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import Phrase, say

_HELD_S = 0.4
"""A picture is sent this much later than it is due [s]; by then all sounds of its time are known.
"""
_SOUNDS_S = 0.1
"""Time between two requests to the page for new sounds [s]."""
_TOLD_S = 10.0
"""Time between two reports [s]."""
_AGAIN_S = 2.0
_LOOKED_S = 1.0
"""Time between two looks at what the page waits for [s]."""
_HANGS_S = 60.0
"""A browser that gives no picture for this long is ended [s]."""
_OPENS_S = 120.0
"""For so long after it was opened, a page may give no picture [s]: a slow machine compiles shaders
for many seconds."""
_SLEPT_MOST_S = 0.05
_SOUNDS = "(rate) => window.__sounds?.(rate) ?? []"
_WAITS = "document.querySelector('.overlay > .waits')?.textContent ?? ''"


@dataclass(frozen=True)
class Streamed:
    """What a live stream shows."""

    pages: str
    """Address of the event's pages."""
    court: str = ""
    """Name of the court that is shown; "": what the director chooses."""

    def address(self, look: Look) -> str:
        """Return the address of the broadcast's page, in the language of `look`."""
        watched = {"court": self.court} if self.court else {"director": "1"}
        query = {"q": "low", "lang": look.language, "taken": "1", **watched}
        return f"{self.pages.rstrip('/')}/overlay?{urlencode(query)}"


@dataclass(frozen=True)
class Report:
    """How well a live stream went since the last report."""

    hz: float
    """How many pictures were sent a second."""
    left_out: float
    """Share of the pictures that were left out, 0 to 1."""


class _Streaming:
    """Draws the pictures of one live stream, and sends them with its sounds."""

    def __init__(
        self, source: Streamed, target: Target, look: Look, fps: int, tell: Callable[[Phrase], None]
    ) -> None:
        self._address = source.address(look)
        self._look, self._target, self._tell = look, target, tell
        self._began_s = time.monotonic()
        self._pace = PicturePace(fps, self._began_s)
        self.sender = Sender(target, (look.width, look.height), fps, tell)
        self._held: deque[LivePicture] = deque()
        self._sounds_s = 0.0
        self._looked_s, self._waiting = 0.0, PageWaiting()
        self._told_s = time.monotonic()
        self._told = (0, 0)

    def run(self, stopping: Callable[[], bool], report: Callable[[Report], None]) -> None:
        """Draw and send the stream until it is told to stop.

        Raises:
            UserError: if there is no browser, the target is a file that can't be written, or
                FFmpeg lacks the protocol of the address.
        """
        has_begun = False
        while not stopping():
            dog: Watchdog | None = None
            try:
                with window(self._look) as (page, paced):
                    has_begun = True
                    browser = page.context.browser
                    assert browser is not None
                    with watched(browser, stopping, _OPENS_S) as dog:
                        self._show(page, Shots(page, paced), stopping, report, dog)
            except Error as error:
                if not stopping():
                    why = dog.why if dog is not None and dog.why else told(error)
                    self._tell(say("stream.browser-gone", why=why))
                    time.sleep(_AGAIN_S)
            except UserError as error:
                if not has_begun or self.sender.failed is not None:
                    raise
                self._tell(error.phrase)  # another browser does not start, perhaps for a time only
                time.sleep(_AGAIN_S)

    def _show(
        self,
        page: Page,
        shots: Shots,
        stopping: Callable[[], bool],
        report: Callable[[Report], None],
        dog: Watchdog,
    ) -> None:
        """Draw the page and send its pictures until the stream is told to stop.

        Raises:
            Error: if the browser has ended.
            UserError: if the stream can't be sent.
        """
        self._open(page, stopping, dog)
        dog.look()
        opened_s = time.monotonic()
        while not stopping():
            if self._picture(page, shots):
                is_open = time.monotonic() - opened_s > _OPENS_S
                dog.see(_HANGS_S if is_open else _OPENS_S)
            self._report(report)

    def _open(self, page: Page, stopping: Callable[[], bool], dog: Watchdog) -> None:
        """Open the broadcast's page; try again until it opens.

        Raises:
            Error: if the browser has ended.
        """
        is_away = False
        while not stopping():
            try:
                reply = page.goto(self._address, wait_until="commit")
                why = "" if reply is None or reply.ok else f"HTTP {reply.status}"
            except Error as error:
                if page.is_closed():
                    raise
                why = told(error)
            if not why:
                if is_away:
                    self._tell(say("stream.page-back", address=self._address))
                return
            dog.see(_OPENS_S)
            if not is_away:
                self._tell(say("stream.no-page", address=self._address, why=why))
            is_away = True
            time.sleep(_AGAIN_S)

    def _picture(self, page: Page, shots: Shots) -> bool:
        """Take the stream's next picture, if it is due soon; return whether it was taken.

        Also send the earlier pictures that have waited `_HELD_S` for their sounds.
        """
        wait_s = self._pace.wait_s(time.monotonic())
        if wait_s > _SLEPT_MOST_S:
            time.sleep(_SLEPT_MOST_S)
            return False
        time.sleep(wait_s)
        number = self._pace.take(time.monotonic())
        self._held.append(LivePicture(number, shots.take(JPEG)))
        now_s = time.monotonic()
        if now_s - self._sounds_s > _SOUNDS_S:
            self._sounds_s = now_s
            # The page says when by the time of the day, which may be set; the pace's clock never
            # leaps.
            offset_s = time.monotonic() - time.time() - self._began_s
            for at_ms, samples in page.evaluate(_SOUNDS, SOUND_HZ):
                self.sender.hear(at_ms / 1000 + offset_s, base64.b64decode(samples))
        if now_s - self._looked_s > _LOOKED_S:
            self._looked_s = now_s
            if news := self._waiting.see(page.evaluate(_WAITS), now_s):
                self._tell(news)
        while self._held and self._pace.time_s(self._held[0].number) < now_s - _HELD_S:
            self.sender.show(self._held.popleft())
        if self.sender.failed is not None:
            why = self.sender.failed
            raise UserError(say("command.cannot-write", path=self._target.shown, why=why))
        return True

    def _report(self, report: Callable[[Report], None]) -> None:
        now_s = time.monotonic()
        if now_s - self._told_s < _TOLD_S:
            return
        passed_s, self._told_s = now_s - self._told_s, now_s
        sent, left_out = self.sender.sent, self.sender.left_out + self._pace.left_out
        new, missed = sent - self._told[0], left_out - self._told[1]
        self._told = sent, left_out
        report(Report(new / passed_s, missed / max(1, new + missed)))


def stream(
    source: Streamed,
    target: Target,
    look: Look,
    fps: int,
    stopping: Callable[[], bool],
    tell: Callable[[Phrase], None],
    report: Callable[[Report], None],
) -> None:
    """Stream an event until `stopping` returns True.

    If the gateway, the court or the video server is gone, the stream waits until it is back.

    Args:
        source: what the stream shows.
        target: where it goes.
        look: its language and size.
        fps: pictures a second.
        stopping: called for each picture.
        tell: called from any thread with a sentence when the page or a server is lost, or is back.
        report: called every 10 s.

    Raises:
        UserError: if there is no browser, a file can't be written, or FFmpeg lacks the protocol of
            the address.
    """
    running = _Streaming(source, target, look, fps, tell)
    try:
        running.run(stopping, report)
    finally:
        running.sender.end()
