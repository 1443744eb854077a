"""Tests of /overlay, the page for broadcasts, at a real court through a real gateway."""

import base64
import re
from pathlib import Path
from typing import Any

import pytest
from chromium import OpenPage
from playwright.sync_api import Page, expect
from show import STALE, Show, decide, playing, violations
from venue import Venue

from lacoc_shared.seat import Phase

pytestmark = pytest.mark.slow

DOC = Path(__file__).parents[2] / "docs" / "overlay.md"
SOURCE = {"width": 1920, "height": 1080}
SMALL = {"width": 960, "height": 540}
LOW = "/overlay?q=low&cam=arena"

PIXELS = """async (png) => {
  const image = await createImageBitmap(await (await fetch("data:image/png;base64," + png)).blob());
  const canvas = new OffscreenCanvas(image.width, image.height);
  const context = canvas.getContext("2d");
  context.drawImage(image, 0, 0);
  const { data } = context.getImageData(0, 0, image.width, image.height);
  const at = ([x, y]) => data[4 * (Math.floor(y * image.height) * image.width
    + Math.floor(x * image.width)) + 3];
  let opaque = 0;
  for (let index = 3; index < data.length; index += 4) opaque += data[index] > 250;
  return { corner: at([0.01, 0.4]), middle: at([0.5, 0.6]), opaque: opaque / (data.length / 4) };
}"""


def alphas(page: Page, blank: Page) -> dict[str, float]:
    """Measure the opacity of a page; the page `blank` decodes the picture.

    Returns:
        The opacity (0-255) at the left edge ("corner") and in the "middle", and the share of
        "opaque" pixels.
    """
    png = base64.b64encode(page.screenshot(omit_background=True)).decode()
    found: dict[str, float] = blank.evaluate(PIXELS, png)
    return found


@pytest.mark.long
def test_flags_of_the_address(venue: Venue, open_page: OpenPage) -> None:
    """The overlay obeys the flags in its address, and shows no scroll bars and no pointer."""
    venue.court()
    venue.web()
    playing(venue)
    blank = open_page()
    show = Show(open_page(viewport=SMALL), venue.url, "/overlay?q=low&lang=ja&colours=contrast")
    show.sees(".score-bug .phase", "試合中")
    mark = show.find(".score-bug [data-seat='1'] .seat-mark")
    expect(mark).to_have_css("background-color", "rgb(255, 230, 0)")
    assert (show.view("camera"), show.view("quality")) == ("auto", "low")
    assert alphas(show.page, blank) == {"corner": 255, "middle": 255, "opaque": 1}
    assert show.page.evaluate("getComputedStyle(document.body).cursor") == "none"
    width, height = show.page.evaluate(
        "(() => { const d = document.documentElement; return [d.scrollWidth, d.scrollHeight]; })()"
    )
    assert (width, height) == (SMALL["width"], SMALL["height"])
    assert show.page.evaluate("getComputedStyle(document.documentElement).overflow") == "hidden"

    bare = Show(
        open_page(viewport=SMALL), venue.url, "/overlay?cam=top&hud=0&transparent=1&q=low&lang=en"
    )
    assert bare.view("camera") == "top"
    bare.until(lambda: alphas(bare.page, blank)["middle"] == 255, "nothing is drawn")
    seen = alphas(bare.page, blank)
    assert seen["corner"] == 0
    assert 0.1 < seen["opaque"] < 0.9
    assert bare.find(".score-bug").count() == 0
    assert bare.find("main").inner_text() == ""

    odd = Show(open_page(viewport=SMALL), venue.url, "/overlay?cam=nowhere&q=best&delay=no&hud=yes")
    assert odd.view("camera") == "auto"
    odd.sees(".score-bug")


@pytest.mark.long
def test_the_workshops_two_windows(venue: Venue, open_page: OpenPage) -> None:
    """With split=1 each robot has a window, and there is one score board (workshop Fig. 5-11)."""
    venue.court()
    venue.web()
    playing(venue)
    show = Show(open_page(viewport=SMALL), venue.url, "/overlay?q=low&split=1")
    show.until(lambda: show.view("drawnFrames", 1), "the second window is empty")
    expect(show.find(".window")).to_have_count(2)
    expect(show.find(".score-bug")).to_have_count(1)
    left, right = (box.bounding_box() for box in show.find(".window").all())
    assert left is not None
    assert right is not None
    assert left["x"] + left["width"] <= right["x"]
    assert left["width"] == pytest.approx(right["width"], abs=2)
    assert [show.view("camera", index) for index in (0, 1)] == ["chase", "chase"]
    eyes = [show.view("eye", index) for index in (0, 1)]
    # Othello's robots begin at x = -0.75 and 0.75, and are seen from behind (rules 5).
    assert eyes[0][0] < -1 < 1 < eyes[1][0]
    show.moves()


@pytest.mark.long
def test_delay_holds_everything_back(venue: Venue, open_page: OpenPage) -> None:
    """With `delay`, score, events and picture all come that many seconds later."""
    venue.court()
    venue.web()
    referee = playing(venue)
    prompt = Show(open_page(viewport=SMALL), venue.url, LOW)
    late = Show(open_page(viewport=SMALL), venue.url, f"{LOW}&delay=8")
    late.has_scores(18, 18)
    beat = decide(referee, "for the test", type="adjust", seat="left", points=5)["beat"]
    prompt.has_scores(23, 18)
    seen: list[dict[str, Any]] = []

    def came() -> bool:
        now = late.page.evaluate(
            """() => ({
              score: document.querySelector(".score-bug .points").textContent,
              third: document.querySelector(".third .gain")?.textContent ?? "",
              beat: window.__lacoc.view.drawnBeat,
            })"""
        )
        seen.append(now)
        return bool(now["score"] == "23" and now["third"] == "+5")

    late.until(came, "the score never came")
    # Score and event did not show the decision while the picture was still before that beat.
    # On a slow machine the picture may be late itself: 50 beats (one second) are allowed for that.
    before = [now for now in seen if now["beat"] < beat - 50]
    assert all((now["score"], now["third"]) == ("18", "") for now in before)
    assert any(now["beat"] < beat - 100 for now in before)
    assert seen[-1]["beat"] < beat + 150
    behind = prompt.view("drawnBeat") - late.view("drawnBeat")
    assert 320 < behind < 700


@pytest.mark.long
def test_it_heals_for_ever(venue: Venue, open_page: OpenPage, console: Any) -> None:
    """Without court or gateway the overlay says so at its lower edge, and recovers by itself."""
    console.expect_a_break()
    web = venue.web()
    show = Show(open_page(viewport=SOURCE), venue.url, LOW, drawn=False)
    show.sees(".waits", "Waiting for court main")
    waits = show.find(".waits").bounding_box()
    assert waits is not None
    assert waits["y"] > 0.9 * SOURCE["height"]
    court = venue.court()
    show.misses(".waits")
    show.sees(".opening")
    for _ in range(2):
        web.kill()
        show.sees(".waits", "connection is lost")
        show.sees(STALE)
        web = venue.web()
        show.misses(".waits")
        show.misses(STALE)
    court.kill()
    show.sees(".waits", "Waiting for court main")
    show.sees(STALE)
    venue.court()
    show.misses(".waits")
    show.misses(STALE)
    show.moves()


@pytest.mark.long
def test_a_whole_match(venue: Venue, open_page: OpenPage) -> None:
    """The overlay shows a whole match by itself, from the opening to the next match's opening."""
    venue.court("--seconds", "1")
    venue.web()
    show = Show(open_page(viewport=SOURCE), venue.url, LOW)
    show.sees(".opening", "Waiting for the left seat to join")
    referee = playing(venue)
    referee.phase(Phase.FINISHED)
    show.sees(".result .next", "The referee is confirming")
    box = show.find(".result").bounding_box()
    assert box is not None
    assert box["x"] > SOURCE["width"] / 2, "the winner stands beside the card"
    assert box["width"] > 700
    assert show.find("button").count() == 0
    decide(referee, type="official")
    show.sees(".result .kicker", "Official")
    decide(referee, type="next")
    show.misses(".result")
    expect(show.find(".opening .ready")).to_have_count(0)


@pytest.mark.long
def test_accessible(venue: Venue, open_page: OpenPage) -> None:
    """Axe-core finds no serious mistake in accessibility, with one picture and with two."""
    pytest.importorskip("axe_core_python")
    venue.court()
    venue.web()
    show = Show(open_page(viewport=SMALL), venue.url, "/overlay?q=low")
    show.sees(".opening")
    assert violations(show.page) == []
    playing(venue)
    show.misses(".opening")
    assert violations(show.page) == []
    split = Show(open_page(viewport=SMALL), venue.url, "/overlay?q=low&split=1")
    split.sees(".board")
    assert violations(split.page) == []


def test_a_part_that_cannot_be_loaded(venue: Venue, open_page: OpenPage, console: Any) -> None:
    """The overlay recovers if its script fails to load once, as after an update of the server."""
    console.expect("ERR_FAILED|Failed to fetch dynamically imported module|Unable to preload")
    venue.court()
    venue.web()
    page = open_page(viewport=SMALL)
    part = re.compile(r"/assets/overlay-[^/]*\.js$")
    page.route(part, lambda route: route.abort(), times=1)
    show = Show(page, venue.url, LOW, drawn=False)
    show.sees(".opening")
    assert any("overlay" in text for text in console.errors)


def test_the_document_has_every_flag() -> None:
    """docs/overlay.md names exactly the flags that the page reads."""
    web = Path(__file__).parents[2] / "client" / "web" / "src"
    sources = "".join(
        (web / name).read_text("utf-8")
        for name in (
            "pages/overlay.tsx",
            "pages/watch/flags.ts",
            "ui/sound.tsx",
            "core/colours.ts",
            "core/court.ts",
            "i18n/index.ts",
        )
    )
    read = set(re.findall(r'\b(?:setting|flag|amount)\("(\w+)"', sources))
    told = set(re.findall(r"^\| `(\w+)` \|", DOC.read_text("utf-8"), re.MULTILINE))
    assert told == read


@pytest.mark.long
def test_a_phone_can_read_it(venue: Venue, open_page: OpenPage) -> None:
    """In an upright window of a phone the letters are large enough, and nothing is cut off."""
    venue.court("--seconds", "2")
    venue.web()
    show = Show(open_page(viewport={"width": 390, "height": 844}), venue.url, LOW)
    show.sees(".opening")
    sizes = """selector => {
      const found = document.querySelector(selector);
      const { left, right, height } = found.getBoundingClientRect();
      return [left, right, height];
    }"""
    left, right, _ = show.page.evaluate(sizes, ".opening")
    assert 0 <= left < right <= 390
    playing(venue)
    show.sees(".score-bug .clock")
    for part, least_px in ((".score-bug .clock", 18), (".score-bug .name", 12)):
        left, right, height = show.page.evaluate(sizes, part)
        assert 0 <= left < right <= 390
        assert height >= least_px
    show.sees(".result h1")
    left, right, _ = show.page.evaluate(sizes, ".result")
    assert 0 <= left < right <= 390
