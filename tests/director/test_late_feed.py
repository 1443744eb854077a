"""Tests of courts that pages see later than they play, and of a picture that shows several."""

import time
from typing import Any

from lacoc_client.web.director.programme import Channel
from lacoc_client.web.gateway import wire
from lacoc_client.web.gateway.feed import CourtFeed
from lacoc_client.web.gateway.late_feed import LateFeed
from lacoc_client.web.gateway.threads import Threads
from lacoc_client.web.gateway.viewer import Viewer
from lacoc_client.web.gateway.wire import MessageKind
from lacoc_shared.contest.access import Access

BEHIND_S = 10.0


class Written:
    """A page's socket that keeps what is written to it."""

    keeps_up = True
    heard_s = 0.0

    def __init__(self) -> None:
        self.messages: list[tuple[MessageKind, bytes]] = []
        self.drained: Any = None

    def write(self, framed: bytes) -> None:
        self.messages.append(wire.opened(framed))

    @property
    def kinds(self) -> list[MessageKind]:
        """The kinds of the messages, in order."""
        return [kind for kind, _ in self.messages]


def link(log: int, *, connected: bool = True) -> bytes:
    """Make a message about the link to a court; `log` is the number of the court's log."""
    return wire.map_message(MessageKind.LINK, {"court": "east", "connected": connected, "log": log})


def test_messages_open_as_they_were_made() -> None:
    """Kind and payload of a message can be read back from it, however long it is."""
    for size in (0, 1, 124, 125, 65_534, 65_535, 70_000):
        payload = bytes(size)
        assert wire.opened(wire.message(MessageKind.SCENE, payload)) == (MessageKind.SCENE, payload)


def test_a_page_sees_a_court_as_it_was() -> None:
    """Pages get a court's messages in order after a delay; a new page gets the delayed state."""
    threads = Threads(1)
    feed = CourtFeed(Access(court="east", connect="tcp/127.0.0.1:1"), threads)
    late = LateFeed(feed, BEHIND_S)
    begun_s = time.monotonic()
    event, other = (wire.message(MessageKind.EVENT, bytes([one])) for one in (1, 2))
    frames = [wire.message(MessageKind.FRAME, bytes([one])) for one in (1, 2)]
    sheet = wire.message(MessageKind.SHEET, b"s")
    feed.audience.send(link(1), sheet, event)
    feed.audience.offer(frames[0], time.monotonic())

    early = Written()
    late.play(begun_s + BEHIND_S - 0.1)
    late.add(Viewer(early))  # type: ignore[arg-type]
    assert early.kinds == []

    late.play(time.monotonic() + BEHIND_S)
    # The first link is what the feed said when it was tapped.
    assert early.kinds == [
        MessageKind.LINK,
        MessageKind.LINK,
        MessageKind.SHEET,
        MessageKind.EVENT,
        MessageKind.FRAME,
    ]
    comer = Written()
    late.add(Viewer(comer))  # type: ignore[arg-type]
    assert comer.kinds == [
        MessageKind.LINK,
        MessageKind.SHEET,
        MessageKind.EVENT,
        MessageKind.FRAME,
    ]
    assert comer.messages[2] == wire.opened(event)

    # Another log: the old events are no longer valid. A court that is away has no frame.
    feed.audience.send(link(2), other)
    feed.audience.offer(frames[1], time.monotonic())
    feed.audience.send(link(2, connected=False))
    late.play(time.monotonic() + BEHIND_S)
    last = Written()
    late.add(Viewer(last))  # type: ignore[arg-type]
    assert last.kinds == [MessageKind.LINK, MessageKind.SHEET, MessageKind.EVENT]
    assert last.messages[2] == wire.opened(other)
    threads.close()


def test_a_picture_goes_from_court_to_court() -> None:
    """Its pages get the court that it shows, from then on only that one, and each change once."""
    threads = Threads(1)
    feeds = [
        CourtFeed(Access(court=c, connect="tcp/127.0.0.1:1"), threads) for c in ("east", "west")
    ]
    east, west = (LateFeed(feed, 0.0) for feed in feeds)
    told = [
        wire.map_message(MessageKind.PROGRAMME, {"why": why}) for why in ("first", "swing", "lead")
    ]
    sheets = [wire.message(MessageKind.SHEET, court) for court in (b"east", b"west")]

    def send(*framed: bytes) -> None:
        for feed, one in zip(feeds, framed, strict=True):
            feed.audience.send(one)
        for late in (east, west):
            late.play(time.monotonic())

    send(*sheets)
    channel, page = Channel(), Written()
    viewer = Viewer(page)  # type: ignore[arg-type]
    channel.show(east, told[0])
    channel.add(viewer)
    channel.show(east, told[0])
    opened = [wire.opened(one) for one in (*told, *sheets)]
    assert [one for one in page.messages if one[0] is not MessageKind.LINK] == [
        opened[0],
        opened[3],
    ]

    page.messages.clear()
    channel.show(west, told[1])
    assert [one for one in page.messages if one[0] is not MessageKind.LINK] == [
        opened[1],
        opened[4],
    ]
    page.messages.clear()
    send(*reversed(sheets))
    assert page.messages == [opened[3]]  # it came from west

    page.messages.clear()
    channel.show(west, told[2])
    assert page.messages == [opened[2]]
    channel.remove(viewer)
    channel.show(east, told[0])
    send(*sheets)
    assert page.messages == [opened[2]]
    threads.close()
