"""One page that watches a court: how often it gets a frame, and whether it may act."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

LEAST_HZ, MOST_HZ = 1.0, 50.0
USUAL_HZ = 25.0
"""Frame rate of pages that only watch."""

_EARLY_S = 0.01  # half a beat: frames come with some jitter


@dataclass
class Frames:
    """How many frames pages were sent, and how many they missed because they were too slow."""

    sent: int = 0
    dropped: int = 0
    """Frames that a page was too slow to get; it got a newer frame instead."""


class Socket(Protocol):
    """The object to which the messages to a page are written."""

    drained: Callable[[], None] | None
    """Called when all bytes that had to wait have been sent."""
    heard_s: float
    """Time when the page last sent anything, on the loop's clock."""

    @property
    def keeps_up(self) -> bool:
        """True if the page takes messages as fast as they are written; False: it is too slow."""

    def write(self, framed: bytes) -> None:
        """Send a message, as a finished WebSocket frame."""

    def watch_closely(self) -> None:
        """Check several times a second whether the page still answers."""


class Viewer:
    """A page that watches a court, as the feed of the court sees it.

    While the page is too slow, one frame waits, and a newer frame replaces it; messages of
    `send_if_fast` are dropped. All other messages are written at once; a page that does not take
    them is closed.

    Args:
        socket: the page's WebSocket, or what stands in its place.
    """

    def __init__(self, socket: Socket) -> None:
        self._socket = socket
        self._slot: bytes | None = None
        self._interval_s = 1 / USUAL_HZ
        self._next_s = 0.0
        self.frames = Frames()
        self.is_page = True
        """Whether this is one page; False: it stands for all pages that fetch a picture in
        pieces."""
        self.is_own = False
        """Whether the page has shown the page key, and so is one of the person who started the
        gateway."""
        self.can_act = False
        """Whether the page may act: it has shown the page key, or a court has accepted its
        token."""
        socket.drained = self._send_slot

    def rate(self, hz: float) -> None:
        """Set the page's frame rate [Hz]; a rate below 1 or above 50 becomes 1 or 50."""
        # Comparisons with NaN are False, so it becomes the highest rate.
        self._interval_s = 1 / (MOST_HZ if not hz < MOST_HZ else max(LEAST_HZ, hz))
        self._next_s = 0.0

    def at_least(self, hz: float) -> None:
        """Raise the page's frame rate to `hz` if it is lower [Hz]."""
        self.rate(max(hz, 1 / self._interval_s))

    def offer(self, framed: bytes, now_s: float) -> None:
        """Send a frame if it is time for one; if the page is too slow, keep the frame for later."""
        next_s = self._next_s
        if now_s < next_s - _EARLY_S:
            return
        following_s = next_s + self._interval_s
        self._next_s = following_s if following_s > now_s else now_s + self._interval_s
        self.frames.dropped += self._slot is not None
        if self._socket.keeps_up:
            self._slot = None
            self._write(framed)
        else:
            self._slot = framed

    def send(self, framed: bytes) -> None:
        """Send a message that the page must not miss; a page that does not take it is closed."""
        self._socket.write(framed)

    def send_if_fast(self, framed: bytes) -> None:
        """Send a message unless the page is too slow; it then gets a later one of this kind."""
        if self._socket.keeps_up:
            self._socket.write(framed)

    def watch_closely(self) -> None:
        """Check several times a second whether the page still answers."""
        self._socket.watch_closely()

    def unheard_s(self) -> float:
        """Return for how long the page has sent nothing [s]; may be called from any thread."""
        return time.monotonic() - self._socket.heard_s

    def _send_slot(self) -> None:
        framed, self._slot = self._slot, None
        if framed is not None:
            self._write(framed)

    def _write(self, framed: bytes) -> None:
        self.frames.sent += 1
        self._socket.write(framed)
