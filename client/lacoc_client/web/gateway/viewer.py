"""One page: how often it gets a frame, and whether it may act."""

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
    """Counts of the frames that were due for pages."""

    sent: int = 0
    dropped: int = 0
    """Frames that a page was too slow for; it got a newer one."""


class Socket(Protocol):
    """Where the messages to a page are written."""

    drained: Callable[[], None] | None
    """Called when all bytes that had to wait have been sent."""
    heard_s: float
    """Time when the page last sent anything, on the loop's clock."""

    @property
    def keeps_up(self) -> bool:
        """True if everything written has been sent."""

    def write(self, framed: bytes) -> None:
        """Send a finished frame."""

    def watch_closely(self) -> None:
        """Look several times a second whether the page is there."""


class Viewer:
    """A page's place in a feed.

    Frames have one slot: while the page is too slow, a newer frame replaces the waiting one.
    Everything else is written at once; a page that does not take it is cut off.

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
        """Whether it takes the place of a page; else it is what stands for a crowd of them."""
        self.is_own = False
        """Whether it is a page of the person who started the gateway: it showed the page key."""
        self.can_act = False
        """Whether it may act: it is such a page, or a court has accepted its token."""
        socket.drained = self._send_slot

    def rate(self, hz: float) -> None:
        """Set the frame rate [Hz]; a rate below 1 or above 50 becomes 1 or 50."""
        # Comparisons with NaN are False, so it becomes the highest rate.
        self._interval_s = 1 / (MOST_HZ if not hz < MOST_HZ else max(LEAST_HZ, hz))
        self._next_s = 0.0

    def at_least(self, hz: float) -> None:
        """Raise the frame rate to at least `hz`."""
        self.rate(max(hz, 1 / self._interval_s))

    def offer(self, framed: bytes, now_s: float) -> None:
        """Send or store a frame, if one is due."""
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
        """Send a message that must arrive."""
        self._socket.write(framed)

    def send_if_fast(self, framed: bytes) -> None:
        """Send a message if the page keeps up; a slow page misses it and gets a later one."""
        if self._socket.keeps_up:
            self._socket.write(framed)

    def watch_closely(self) -> None:
        """Check several times a second that the page is there."""
        self._socket.watch_closely()

    def unheard_s(self) -> float:
        """Return how long the page has sent nothing [s]; may be called from any thread."""
        return time.monotonic() - self._socket.heard_s

    def _send_slot(self) -> None:
        framed, self._slot = self._slot, None
        if framed is not None:
            self._write(framed)

    def _write(self, framed: bytes) -> None:
        self.frames.sent += 1
        self._socket.write(framed)
