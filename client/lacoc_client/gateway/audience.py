"""The pages that watch one court."""

from lacoc_client.gateway.viewer import Frames, Viewer


class Audience:
    """Everybody who gets what a court says; used from the event loop only."""

    def __init__(self) -> None:
        self._viewers: dict[Viewer, None] = {}
        self._gone = Frames()
        """What the pages got that have gone."""

    def __len__(self) -> int:
        return len(self._viewers)

    def add(self, viewer: Viewer) -> None:
        """Let a page have what comes from now on."""
        self._viewers[viewer] = None

    def remove(self, viewer: Viewer) -> None:
        """Let a page go."""
        if viewer in self._viewers:
            del self._viewers[viewer]
            self._gone.sent += viewer.frames.sent
            self._gone.dropped += viewer.frames.dropped

    def others(self, viewer: Viewer) -> int:
        """How many other pages may do what this one may: act, or only watch."""
        return sum(one.can_act == viewer.can_act for one in self._viewers if one is not viewer)

    def frames(self) -> Frames:
        """What became of the frames of all pages; may be asked from any thread."""
        counts = [self._gone, *(viewer.frames for viewer in list(self._viewers))]
        return Frames(sum(one.sent for one in counts), sum(one.dropped for one in counts))

    def send(self, *messages: bytes) -> None:
        """Send what must arrive, in its order."""
        for viewer in self._viewers:
            for framed in messages:
                viewer.send(framed)

    def send_acting(self, framed: bytes) -> None:
        """Send to the pages that may act what must arrive."""
        for viewer in self._viewers:
            if viewer.can_act:
                viewer.send(framed)

    def send_if_fast(self, framed: bytes) -> None:
        """Send what another message will soon replace."""
        for viewer in self._viewers:
            viewer.send_if_fast(framed)

    def offer(self, framed: bytes, now_s: float) -> None:
        """Send a frame to those for whom it is time."""
        for viewer in self._viewers:
            viewer.offer(framed, now_s)
