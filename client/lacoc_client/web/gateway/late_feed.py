"""Shows a court as it was some seconds ago: keeps each message so long before pages get it."""

import time
from collections import deque
from enum import Enum, auto

from lacoc_client.web.gateway.audience import Audience
from lacoc_client.web.gateway.backlog import Backlog
from lacoc_client.web.gateway.feed import CourtFeed
from lacoc_client.web.gateway.viewer import Viewer


class _SentBy(Enum):
    """The method of `Listener` by which a message arrived; the same method passes it on."""

    SENT = auto()
    IF_FAST = auto()
    OFFERED = auto()


class LateFeed:
    """Passes each message of a court's feed on to pages, a fixed time after it came.

    Args:
        feed: the feed of the court.
        behind_s: how much later messages are passed on [s].
    """

    def __init__(self, feed: CourtFeed, behind_s: float) -> None:
        self.court = feed.court
        self.audience = Audience()
        """The pages that see the court late."""
        self._behind_s = behind_s
        self._waiting: deque[tuple[float, _SentBy, bytes]] = deque()
        self._backlog = Backlog()
        feed.tap(self)

    def send(self, framed: bytes) -> None:
        """Keep a message that no page may miss; `play` passes it on after `behind_s`."""
        self._waiting.append((time.monotonic(), _SentBy.SENT, framed))

    def send_if_fast(self, framed: bytes) -> None:
        """Keep a message that slow pages may miss; `play` passes it on after `behind_s`."""
        self._waiting.append((time.monotonic(), _SentBy.IF_FAST, framed))

    def offer(self, framed: bytes, now_s: float) -> None:
        """Keep a frame of the match; `play` passes it on after `behind_s`."""
        self._waiting.append((now_s, _SentBy.OFFERED, framed))

    def add(self, viewer: Viewer) -> None:
        """Let a page watch; send it everything that was known about the court `behind_s` ago."""
        for framed in self._backlog.all():
            viewer.send(framed)
        self.audience.add(viewer)

    def play(self, now_s: float) -> None:
        """Pass on to the pages all messages that came at least `behind_s` ago.

        Args:
            now_s: the time of `time.monotonic` [s].
        """
        while self._waiting and self._waiting[0][0] <= now_s - self._behind_s:
            _, way, framed = self._waiting.popleft()
            self._backlog.take(framed)
            match way:
                case _SentBy.SENT:
                    self.audience.send(framed)
                case _SentBy.IF_FAST:
                    self.audience.send_if_fast(framed)
                case _SentBy.OFFERED:
                    self.audience.offer(framed, now_s)
