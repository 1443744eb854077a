"""Tests of a match in pieces, as a page shows it that finds no place on a WebSocket."""

from typing import Any

import pytest
from chromium import OpenPage
from playwright.sync_api import Page, Response
from show import STALE, Show, playing
from venue import Venue

pytestmark = pytest.mark.slow

WATCH = "/watch?q=low&cam=arena&panel=0"
ONE = ("--viewers", "1")
SEEN = """() => {
  const seen = (window.seenBeats = []);
  const look = () => {
    const beat = window.__lacoc?.views?.[0]?.drawnBeat;
    if (beat !== undefined && beat !== seen.at(-1)) seen.push(beat);
    requestAnimationFrame(look);
  };
  look();
}"""


class Ways:
    """Counts by which way messages come to a page."""

    def __init__(self, page: Page) -> None:
        self.pieces = self.messages = 0
        page.on("response", self._answered)
        page.on("websocket", lambda socket: socket.on("framereceived", self._received))

    def _answered(self, response: Response) -> None:
        self.pieces += "/live/" in response.url and "now.json" not in response.url and response.ok

    def _received(self, _: object) -> None:
        self.messages += 1


@pytest.mark.long
def test_nobody_is_sent_away(venue: Venue, open_page: OpenPage, console: Any) -> None:
    """A page without a place sees the match in pieces, and moves back and forth in its middle."""
    console.expect_a_break()
    console.expect("404")  # of a piece that is not whole yet
    console.expect("INTERNET_DISCONNECTED")
    court = venue.court()
    web = venue.web(*ONE)
    playing(venue)
    first = venue.page()
    first.wait(lambda: first.link.get("connected"))
    page = open_page()
    ways = Ways(page)
    show = Show(page, venue.url, WATCH)
    show.misses(".banner")
    show.moves()
    show.page.evaluate(SEEN)
    assert first.frame is not None
    assert show.view("drawnBeat") < first.frame.beat - 50

    first.close()
    many = ways.messages + 50
    show.until(lambda: ways.messages > many, "the page never got the place")
    show.moves()
    show.misses(STALE)

    web.kill()
    page.context.set_offline(True)  # else it may take the only place again
    venue.web(*ONE)
    venue.page()
    page.context.set_offline(False)
    more = ways.pieces + 3
    show.until(lambda: ways.pieces > more, "the page took a place that another one has")
    show.misses(".banner")
    show.moves()
    seen = show.page.evaluate("window.seenBeats")
    assert len(seen) > 20
    assert seen == sorted(seen)

    court.kill()
    show.sees(".banner", "no answer for")  # of its court, and not that the page has no place
    show.until(lambda: "no answer for 8 s" in show.page.inner_text(".banner"), "no seconds pass")
