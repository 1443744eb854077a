"""Tests of /contest?big, the projector's page, while a contest is played at a court."""

import os
import re
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import msgspec
import pytest
from chromium import OpenPage
from contest_sheets import sheets
from lacoc_process import contest_run
from PIL import Image
from playwright.sync_api import Page, ViewportSize, expect
from ports import free_port
from stand import served

from lacoc_client.web.gateway.published import write_pages
from lacoc_server.contest.acts.organiser import enter
from lacoc_server.contest.league.contest import Contest
from lacoc_server.contest.league.draws import Team
from lacoc_server.contest.league.facts import Announced
from lacoc_server.contest.league.sheet import encode, sheet

pytestmark = [pytest.mark.slow, pytest.mark.long]

PROJECTOR = {"width": 1920, "height": 1080}
SMALL = {"width": 1280, "height": 720}
TEAMS = ("Ants", "Bees", "九州工業大学ロボット研究会")
NAME = "Robot Cup 2027"
LONG_NAME = "The Second Autumn Cup of All Walking Robots of the North 2027"
LINE = "Lunch until one o'clock in room 2-104; the robots meet at the north door."
LEAST_SHARE = 0.028
"""A letter is at least this part of the picture's height: 15 m away it can be read on a screen that
is 2 m high."""


@contextmanager
def contest(folder: Path) -> Iterator[str]:
    """Run a contest of three bots at one court; give the address of its pages."""
    file = folder / "contest.toml"
    file.write_text(f"""
[contest]
name = "Spring Cup"
least_rest_s = 25.0
[court.main]
arena = "othello"
listen = ["127.0.0.1:{free_port()}"]
[stage.groups]
format = "round-robin"
arena = "othello"
settings.match.duration_s = 6.0
settings.match.countdown_s = 2.0
settings.match.start = "ready"
""")
    for team in TEAMS:
        enter(file, team, None, "planner", "")
    with contest_run(file, "--listen", f"127.0.0.1:{free_port()}") as run:
        yield run.opened["url"]


def expected(contest: Contest) -> dict[str, tuple[str, int]]:
    """Expect each open match at some court and time."""
    matches = [match for view in contest.stages for match in view.matches]
    return {
        match.pairing.id: (f"hall {number % 4}", 1_800_000_000_000 + 300_000 * number)
        for number, match in enumerate(matches)
    }


def pictured(teams: Sequence[Team], folder: Path) -> tuple[Team, ...]:
    """Give every other team a picture in a published folder."""
    given = []
    for number, team in enumerate(teams):
        files = f"files-{number}"
        file = folder / "entries" / files / "picture.webp"
        file.parent.mkdir(parents=True, exist_ok=True)
        Image.new("RGB", (192, 192), "teal").save(file)
        given.append(msgspec.structs.replace(team, files=files, picture=number % 2 == 0))
    return tuple(given)


def long_teams(sheet: bytes) -> bytes:
    """Give all teams of a sheet names of the most letters."""
    return re.sub(rb'"t(\d{3})"', rb'"Owls of the North Sea\1"', sheet)


def fits(page: Page) -> None:
    """Check that a slide fits, and that everybody can read it."""
    found = page.evaluate(
        """(least) => {
          const slide = document.querySelector(".slide");
          const sizes = [...slide.querySelectorAll("*")]
            .filter((one) => [...one.childNodes].some((n) => n.nodeType === 3 && n.data.trim()))
            .filter((one) => one.getClientRects().length && !one.closest(".hidden-text"))
            .map((one) => {
              const svg = one.closest("svg");
              const scale = svg ? svg.getScreenCTM().a : 1;
              return [scale * parseFloat(getComputedStyle(one).fontSize), one.textContent];
            });
          const main = slide.parentElement;
          return {
            wide: [document.documentElement.scrollWidth, main.scrollWidth]
              .map((px) => px - innerWidth),
            over: [slide.scrollHeight - slide.clientHeight, slide.scrollWidth - slide.clientWidth],
            small: sizes.filter(([size]) => size < least * innerHeight),
          };
        }""",
        LEAST_SHARE,
    )
    assert found == {"wide": [0, 0], "over": [0, 0], "small": []}
    row = page.locator(".slide tbody tr").first
    if row.count():
        cell = row.locator("td").last.bounding_box()
        assert cell is not None
        assert cell["x"] + cell["width"] <= page.evaluate("innerWidth")
    pictures = page.locator(".podium li:not([data-rank='1']) .team-picture").all()
    sizes = {(box["width"], box["height"]) for one in pictures if (box := one.bounding_box())}
    assert len(sizes) < 2
    banner = page.locator(".banner")
    if banner.count():
        slide, line = page.locator(".slide").bounding_box(), banner.bounding_box()
        assert slide is not None
        assert line is not None
        assert slide["y"] + slide["height"] <= line["y"] + 1


def show_all(page: Page) -> list[str]:
    """Go through all slides, and check each; return what they are."""
    shown: list[str] = []
    seen: list[str] = []
    while True:
        slide = page.locator(".slide")
        expect(slide).to_be_visible()
        shown.append(str(slide.get_attribute("data-slide")))
        fits(page)
        assert page.locator("button:visible, a:visible").count() == 0
        seen.append(slide.inner_html())
        page.keyboard.press("ArrowRight")
        if slide.inner_html() in seen:
            return shown


@pytest.mark.parametrize(
    ("size", "locale", "line", "name"),
    [
        (PROJECTOR, "en-GB", "", NAME),
        (PROJECTOR, "en-GB", "", LONG_NAME),
        (SMALL, "ja-JP", "", NAME),
        (SMALL, "en-GB", LINE, NAME),
    ],
)
def test_every_slide_can_be_read(
    tmp_path: Path,
    built_pages: Path,
    open_page: OpenPage,
    servers: ExitStack,
    size: ViewportSize,
    locale: str,
    line: str,
    name: str,
) -> None:
    """All slides fit both projectors in large letters, also with a line to all below them.

    Every other team gave a picture: on the podium it is as large as the letter of one without. One
    has left, and another team takes its place. The contest and its teams may have long names.
    """
    told = Announced(id="f0", number=0, at_ms=0, text=line) if line else None
    kinds: set[str] = set()
    write_pages(tmp_path)
    url = servers.enter_context(served(tmp_path))
    page = open_page(viewport=size, locale=locale)
    page.clock.install()
    for number, (_, event) in enumerate(sheets()):
        *teams, last = pictured(event.contest.teams, tmp_path)
        left = msgspec.structs.replace(last, withdrawn=True, substitute=teams[0].name)
        shown = msgspec.structs.replace(event.contest, announced=told, teams=(*teams, left))
        made = encode(sheet(name, shown, expected(event.contest)))
        new = tmp_path / "new.json"
        new.write_bytes(long_teams(made) if name == LONG_NAME else made)
        # The server of plain files tells versions apart by their second.
        os.utime(new, (number, number))
        new.replace(tmp_path / "contest.json")  # at once: the page may be reading it
        page.goto(f"{url}?big")
        kinds |= {*show_all(page)}
    assert kinds == {"entered", "now", "tables", "bracket", "ratings", "podium"}


@pytest.mark.long(minutes=1)
def test_the_match_fills_the_projector_and_its_champion_stands_at_the_end(
    tmp_path: Path, built_pages: Path, open_page: OpenPage, console: Any
) -> None:
    """The picture is there while a match is played; between matches tables, then the podium."""
    console.expect_a_break()
    with contest(tmp_path) as url:
        big = open_page(viewport=PROJECTOR)
        small = open_page(viewport=SMALL, locale="ja-JP")
        for page in (big, small):
            page.goto(f"{url}/contest?big&q=low")
            expect(
                page.locator(".overlay[data-shown=true] .score-bug .points").first
            ).to_be_visible()
            assert page.locator("button:visible, a:visible").count() == 0
        for _ in range(3):
            expect(big.locator(".overlay[data-shown=true] .result")).to_be_visible()
            expect(big.locator(".slide")).to_be_visible()
            fits(big)
            if big.locator(".slide[data-slide=podium]").count():
                break
            expect(big.locator(".expected").last).to_contain_text("ourt main")
            expect(big.locator(".overlay[data-shown=true]")).to_be_visible()
        for page in (big, small):
            # The same bot thrice: each game is a draw, and all are equal in everything.
            first = page.locator(".slide[data-slide=podium] [data-rank='1'] b")
            expect(first).to_have_text(TEAMS)
            fits(page)
            assert page.locator("button:visible, a:visible").count() == 0
