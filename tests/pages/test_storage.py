"""Tests of the pages in a browser that denies them its storage."""

from typing import Any

import pytest
from chromium import OpenPage
from contestant import Sit
from show import Show
from venue import REFEREE, TOKENS, Venue

pytestmark = pytest.mark.slow

DENIED = """for (const name of ["sessionStorage", "localStorage"])
  Object.defineProperty(window, name, {
    get() { throw new DOMException(`${name}: access is denied`, "SecurityError"); },
  });"""


@pytest.mark.long
def test_who_shows_needs_no_storage(venue: Venue, open_page: OpenPage) -> None:
    """Pages that show a match work when the storage is denied, as with blocked cookies."""
    venue.court()
    venue.web()
    for path in ("/watch", "/overlay"):
        page = open_page()
        page.add_init_script(DENIED)
        show = Show(page, venue.url, f"{path}?q=low&cam=map")
        show.sees(".score-bug")
        page.close()
    for path in ("/", "/replay"):
        page = open_page()
        page.add_init_script(DENIED)
        Show(page, venue.url, path, drawn=False).sees("h1")
        page.close()


@pytest.mark.long
def test_who_acts_needs_no_storage(venue: Venue, sit: Sit, console: Any) -> None:
    """Without storage an open page keeps its seat or desk when its connection breaks."""
    venue.court()
    web = venue.web()
    page = sit(venue.url)
    page.page.add_init_script(DENIED)
    page.open(token=TOKENS["left"])
    page.join(TOKENS["left"])
    page.stands("seated")

    desk = sit(venue.url)
    desk.page.add_init_script(DENIED)
    desk.open("/referee")
    desk.page.fill("input[name=by]", "Kim")
    desk.page.fill("input[name=token]", REFEREE)
    desk.page.click(".enter button[type=submit]")
    desk.sees(".acting.mine")

    console.expect_a_break()
    web.kill()
    page.sees(".banner", "Trying again")
    venue.web()
    page.misses(".banner")
    page.stands("seated")
    page.sees(".link-state.good")
    desk.misses(".banner")
    desk.sees(".acting.mine")
