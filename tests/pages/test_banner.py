"""Tests of the banner that shows why a page waits."""

import re
import time
from typing import Any

import pytest
from chromium import OpenPage
from court_stub import CourtStub
from show import Show
from venue import Venue

pytestmark = pytest.mark.slow

WAITS = {
    "/watch": ".banner",
    "/play": ".banner",
    "/practice": ".banner",
    "/referee": ".banner",
    "/overlay": ".waits",
}
FULL = "1 page watches the match here already"


def opened(open_page: OpenPage, venue: Venue, path: str, **options: Any) -> Show:
    return Show(open_page(**options), venue.url, path, drawn=False)


@pytest.mark.parametrize(
    "path",
    [
        "/overlay",
        *(
            pytest.param(path, marks=pytest.mark.long)
            for path in ("/watch", "/play", "/practice", "/referee")
        ),
    ],
)
def test_every_page_says_why_it_waits(venue: Venue, open_page: OpenPage, path: str) -> None:
    """Every page says why it waits when its court is unknown or does not run."""
    venue.web()
    show = opened(open_page, venue, f"{path}?court=centre")
    show.sees(WAITS[path], 'There is no court "centre" here. The courts here: main.')
    show.page.close()
    show = opened(open_page, venue, f"{path}?court=centre", locale="ja-JP")
    show.sees(WAITS[path], "コート「centre」はありません（使えるコート：main）。")
    show.page.close()
    show = opened(open_page, venue, path)
    show.sees(WAITS[path], "Waiting for court main")
    show.sees(WAITS[path], f"No program answers at tcp/127.0.0.1:{venue.court_port}.")


@pytest.mark.long
@pytest.mark.parametrize(
    ("locale", "full"), [("en-GB", FULL), ("ja-JP", "すでに上限の 1 ページが観戦中です。")]
)
def test_a_full_hall_is_said_and_not_stormed(
    venue: Venue, open_page: OpenPage, console: Any, locale: str, full: str
) -> None:
    """A page that a full gateway sends away says so, and tries again by itself after 10 to 20 s.

    A page that only watches goes on in pieces instead (test_pieces).
    """
    console.expect_a_break()
    venue.web("--viewers", "1")
    first = venue.page()
    page = open_page(locale=locale)
    tried_s: list[float] = []
    page.on("websocket", lambda _: tried_s.append(time.monotonic()))
    show = Show(page, venue.url, "/referee", drawn=False)
    show.sees(".banner", full)
    first.close()
    show.page.wait_for_timeout(5000)
    show.sees(".banner", full)
    assert len(tried_s) == 1
    show.sees(".banner", "main")
    assert len(tried_s) == 2
    assert 9.5 < tried_s[1] - tried_s[0] < 25


def test_a_court_of_another_version_is_said(venue: Venue, open_page: OpenPage) -> None:
    """The gateway drops the frames of a court of another version; banner and log say why."""
    with CourtStub(f"127.0.0.1:{venue.court_port}") as court:
        web = venue.web()
        page = venue.page()
        show = opened(open_page, venue, "/watch")
        show.misses(".banner")
        court.in_a_beat(lambda: court.show(court.scene, protocol=99))
        show.sees(".banner", "Court main uses another version (99) of the protocol")
        frames = len(page.frames)
        show.page.wait_for_timeout(2000)
        assert len(page.frames) == frames
        court.in_a_beat(lambda: court.show(court.scene))
        show.misses(".banner")
        page.wait(lambda: len(page.frames) > frames)
        show.page.close()
    web.close()
    assert len(re.findall(r"another version \(99\)", web.said)) == 1
