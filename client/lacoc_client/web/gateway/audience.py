"""The pages that watch one court."""

from typing import Protocol

from lacoc_client.web.gateway.viewer import Frames, Viewer


class Listener(Protocol):
    """A part of the program that receives all that pages get about the match at one court."""

    def send(self, framed: bytes) -> None:
        """Take a message that no page may miss, such as an event."""

    def send_if_fast(self, framed: bytes) -> None:
        """Take a message that slow pages may miss, such as the court's health."""

    def offer(self, framed: bytes, now_s: float) -> None:
        """Take a frame that arrived at the time `now_s` [s]."""


class Audience:
    """The pages that watch one court; used from the event loop only, except `frames`."""

    def __init__(self) -> None:
        self._viewers: dict[Viewer, None] = {}
        self._listeners: list[Listener] = []
        self._gone = Frames()
        """Frame counts of the pages that have gone, all together."""

    def __len__(self) -> int:
        return sum(one.is_page for one in list(self._viewers))  # any thread may ask

    def add(self, viewer: Viewer) -> None:
        """Add a page; it receives what the court sends from now on, frames at the page's rate."""
        self._viewers[viewer] = None

    def tap(self, listener: Listener) -> None:
        """Add a listener: it receives what pages get from the court, but it counts as no page."""
        self._listeners.append(listener)

    def remove(self, viewer: Viewer) -> None:
        """Remove a page, but keep the counts of its frames for `frames`."""
        if viewer in self._viewers:
            del self._viewers[viewer]
            self._gone.sent += viewer.frames.sent
            self._gone.dropped += viewer.frames.dropped

    def others(self, can_act: bool, but: Viewer | None = None) -> int:
        """Count the pages of one kind: those that may play or referee, or those that only watch.

        Args:
            can_act: whether to count those that may play or referee.
            but: a page that is not counted.
        """
        places = (one for one in self._viewers if one.is_page and one is not but)
        return sum(one.can_act == can_act for one in places)

    def frames(self) -> Frames:
        """Return how many frames all pages together were sent and missed; any thread may call."""
        counts = [self._gone, *(viewer.frames for viewer in list(self._viewers))]
        return Frames(sum(one.sent for one in counts), sum(one.dropped for one in counts))

    def send(self, *messages: bytes) -> None:
        """Send all pages and listeners messages that none may miss, in this order."""
        for one in (*self._viewers, *self._listeners):
            for framed in messages:
                one.send(framed)

    def tell(self, framed: bytes) -> None:
        """Send the pages a message that is not about the match; a slow page does not get it."""
        for viewer in self._viewers:
            viewer.send_if_fast(framed)

    def send_own(self, framed: bytes) -> None:
        """Send a message to all pages of the person who started the gateway, even to slow ones."""
        for viewer in self._viewers:
            if viewer.is_own:
                viewer.send(framed)

    def send_if_fast(self, framed: bytes) -> None:
        """Send a message to all pages that are not too slow for it.

        A page that is too slow gets a later message of this kind.
        """
        for one in (*self._viewers, *self._listeners):
            one.send_if_fast(framed)

    def offer(self, framed: bytes, now_s: float) -> None:
        """Send a frame to each page for which it is time to get one, by the page's frame rate."""
        for one in (*self._viewers, *self._listeners):
            one.offer(framed, now_s)
