"""The pages that watch one court."""

from typing import Protocol

from lacoc_client.web.gateway.viewer import Frames, Viewer


class Listener(Protocol):
    """Receives everything that a court sends, as a page does, but is not a page."""

    def send(self, framed: bytes) -> None:
        """Take a message that must arrive."""

    def send_if_fast(self, framed: bytes) -> None:
        """Take a message that may be left out."""

    def offer(self, framed: bytes, now_s: float) -> None:
        """Take a frame that arrived at the time `now_s` [s]."""


class Audience:
    """The pages that watch one court; used from the event loop only."""

    def __init__(self) -> None:
        self._viewers: dict[Viewer, None] = {}
        self._listeners: list[Listener] = []
        self._gone = Frames()
        """Frame counts of the pages that have gone, all together."""

    def __len__(self) -> int:
        return sum(one.is_page for one in self._viewers)

    def add(self, viewer: Viewer) -> None:
        """Add a page, which receives everything from now on."""
        self._viewers[viewer] = None

    def tap(self, listener: Listener) -> None:
        """Add a listener, which receives everything from now on and does not count as a page."""
        self._listeners.append(listener)

    def remove(self, viewer: Viewer) -> None:
        """Remove a page, and keep its frame counts."""
        if viewer in self._viewers:
            del self._viewers[viewer]
            self._gone.sent += viewer.frames.sent
            self._gone.dropped += viewer.frames.dropped

    def others(self, can_act: bool, but: Viewer | None = None) -> int:
        """Count the pages of one kind: those that may act, or those that only watch.

        Args:
            can_act: which of the two to count.
            but: a page that is not counted.
        """
        places = (one for one in self._viewers if one.is_page and one is not but)
        return sum(one.can_act == can_act for one in places)

    def frames(self) -> Frames:
        """Return the frame counts of all pages; may be called from any thread."""
        counts = [self._gone, *(viewer.frames for viewer in list(self._viewers))]
        return Frames(sum(one.sent for one in counts), sum(one.dropped for one in counts))

    def send(self, *messages: bytes) -> None:
        """Send messages that must arrive, in order."""
        for one in (*self._viewers, *self._listeners):
            for framed in messages:
                one.send(framed)

    def tell(self, framed: bytes) -> None:
        """Send the pages a message that is not about the match; a slow page does not get it."""
        for viewer in self._viewers:
            viewer.send_if_fast(framed)

    def send_own(self, framed: bytes) -> None:
        """Send a message that must arrive to all pages of the person who started the gateway."""
        for viewer in self._viewers:
            if viewer.is_own:
                viewer.send(framed)

    def send_if_fast(self, framed: bytes) -> None:
        """Send a message to the pages that keep up.

        A slow page gets a later message of this kind.
        """
        for one in (*self._viewers, *self._listeners):
            one.send_if_fast(framed)

    def offer(self, framed: bytes, now_s: float) -> None:
        """Send a frame to the pages for which one is due."""
        for one in (*self._viewers, *self._listeners):
            one.offer(framed, now_s)
