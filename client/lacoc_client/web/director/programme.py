"""Shows the courts that the director chooses, on all pages that follow the director."""

import asyncio
import math
import time
from collections.abc import Callable, Sequence

from lacoc_client.web.director.courts import OVER, CourtNow
from lacoc_client.web.director.director import AHEAD_S, Director
from lacoc_client.web.director.moments import LiveMoment
from lacoc_client.web.director.results import Results, ShownResult
from lacoc_client.web.director.stakes import stake
from lacoc_client.web.gateway import wire
from lacoc_client.web.gateway.audience import Audience
from lacoc_client.web.gateway.feed import CourtFeed
from lacoc_client.web.gateway.late_feed import LateFeed
from lacoc_client.web.gateway.picture import FramePart, SheetPart
from lacoc_client.web.gateway.viewer import Viewer
from lacoc_client.web.gateway.wire import MessageKind
from lacoc_shared.seat import BEAT_S

_LOOKS = 5
"""Number of beats between two looks of the director."""


class Channel:
    """One picture of the programme: the court that it shows, and the pages that see it."""

    def __init__(self) -> None:
        self.court = ""
        self._late: LateFeed | None = None
        self._told = b""
        self._viewers: dict[Viewer, None] = {}

    def add(self, viewer: Viewer) -> None:
        """Let a page see this picture; send it all of the court that the picture has shown."""
        assert self._late is not None
        self._viewers[viewer] = None
        viewer.send(self._told)
        self._late.add(viewer)

    def has(self, viewer: Viewer) -> bool:
        """Return whether a page is one of those that see this picture."""
        return viewer in self._viewers

    def remove(self, viewer: Viewer) -> None:
        """Send this picture to a page no longer."""
        if viewer in self._viewers:
            assert self._late is not None
            del self._viewers[viewer]
            self._late.audience.remove(viewer)

    def show(self, late: LateFeed, told: bytes) -> None:
        """Show a court in this picture from now on.

        Args:
            late: the court's messages, passed on some seconds late.
            told: the programme message that names the court, and says why it is shown.
        """
        if told == self._told:
            return
        before, self._late, self._told, self.court = self._late, late, told, late.court
        for viewer in self._viewers:
            if before is not None and before is not late:
                before.audience.remove(viewer)
            viewer.send(told)
            if before is not late:
                late.add(viewer)


class Programme:
    """The two pictures that the director fills; used from the event loop only, except `audience`.

    It begins with the first page that follows the director, and goes on until the gateway ends.
    Everything is shown `AHEAD_S` later than it is played, unless there is only one court.

    Args:
        feeds: returns the started feeds of all courts; there is at least one.
    """

    def __init__(self, feeds: Callable[[], Sequence[CourtFeed]]) -> None:
        self._feeds = feeds
        self._late: dict[str, LateFeed] = {}
        self._first = Channel()
        self._second = Channel()
        self._behind_s = 0.0
        self._begins_s = 0.0
        self._director = Director(0.0)
        self._results = Results(0.0)
        self._running: asyncio.Task[None] | None = None

    def add(self, viewer: Viewer, aside: bool) -> None:
        """Let a page follow the director's first picture, or (`aside`) the second one."""
        if self._running is None:
            self._begin()
        (self._second if aside else self._first).add(viewer)

    def remove(self, viewer: Viewer) -> None:
        """Send the director's pictures to a page no longer."""
        self._first.remove(viewer)
        self._second.remove(viewer)

    def seen_by(self, viewer: Viewer) -> Audience | None:
        """Return the pages to which the director shows the same court as to this page.

        None: this page does not follow the director.
        """
        for channel in (self._first, self._second):
            if channel.has(viewer):
                return self.audience(channel.court)
        return None

    def audience(self, court: str) -> Audience | None:
        """Return the pages that see a court in a picture of the director; None: there is none yet.

        Any thread may call it.
        """
        late = self._late.get(court)
        return None if late is None else late.audience

    def others(self, can_act: bool, but: Viewer | None = None) -> int:
        """Count those who follow the director: pages that may play or referee, or all others.

        Args:
            can_act: whether to count those that may play or referee.
            but: a page that is not counted.
        """
        return sum(late.audience.others(can_act, but) for late in list(self._late.values()))

    def stop(self) -> None:
        """Stop the director: choose no more courts, and send the pages nothing more."""
        if self._running is not None:
            self._running.cancel()

    def _begin(self) -> None:
        feeds = self._feeds()
        self._behind_s = AHEAD_S if len(feeds) > 1 else 0.0
        self._begins_s = time.monotonic() + self._behind_s
        self._director, self._results = Director(self._behind_s), Results(self._behind_s)
        self._look(time.monotonic())
        self._running = asyncio.get_running_loop().create_task(self._run())

    async def _run(self) -> None:
        beats = 0
        while True:
            await asyncio.sleep(BEAT_S)
            now_s = time.monotonic()
            for late in self._late.values():
                late.play(now_s)
            beats += 1
            if beats % _LOOKS == 0:
                self._look(now_s)

    def _look(self, now_s: float) -> None:
        """Let the director look at all courts, and show the courts that it chooses."""
        courts: list[CourtNow] = []
        over: list[ShownResult] = []
        for feed in self._feeds():
            if feed.court not in self._late:
                self._late[feed.court] = LateFeed(feed, self._behind_s)
            stands, played = feed.picture.stands(), feed.picture.played()
            if not feed.connected or stands is None or played is None:
                continue
            courts.append(_now(feed.court, stands, played))
            if stands.phase in OVER:
                over.append(_result(feed.court, stands, played))
        going = [(one.name, one.match) for one in courts if one.phase not in OVER]
        self._results.see(now_s, over, going)
        shot = self._director.look(now_s, courts)
        first = self._first.court or self._feeds()[0].court if shot is None else shot.court
        self._tell(now_s, first, shot.why if shot else "first", self._director.aside)

    def _tell(self, now_s: float, court: str, why: str, aside: LiveMoment | None) -> None:
        """Show the chosen courts in both pictures, and tell the pages if the choice has changed."""
        behind = {
            "behind_s": self._behind_s,
            "begins_s": max(0, math.ceil(self._begins_s - now_s)),
        }
        results = self._results.shown(now_s)
        first = {"court": court, "why": why, "is_shown": True, **behind, "results": results}
        self._first.show(self._late[court], wire.map_message(MessageKind.PROGRAMME, first))
        # Without a second picture its channel stays at its last court.
        beside = aside.court if aside else self._second.court or court
        second = {
            "court": beside,
            "why": aside.why if aside else "",
            "is_shown": aside is not None,
            **behind,
            "results": (),
        }
        self._second.show(self._late[beside], wire.map_message(MessageKind.PROGRAMME, second))


def _now(name: str, stands: FramePart, played: SheetPart) -> CourtNow:
    left_s = played.duration_s - stands.clock_ticks * BEAT_S if played.duration_s else None
    return CourtNow(
        name=name,
        match=str(stands.match),
        phase=stands.phase,
        left_s=left_s,
        scores=stands.scores,
        stake=stake(played.fixture if played.call else None),
        has_begun=stands.clock_ticks > 0,
    )


def _result(court: str, stands: FramePart, played: SheetPart) -> ShownResult:
    return ShownResult(
        court=court,
        match=str(stands.match),
        title=played.title,
        fixture=played.fixture if played.call else None,
        teams=tuple(seat.team for seat in played.seats),
        scores=stands.scores,
        phase=stands.phase,
    )
