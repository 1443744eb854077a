"""A page that follows the director: it goes from court to court without a reload."""

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import pytest
from chromium import OpenPage
from contest_tokens import keep_tokens
from lacoc_process import ALONE, Running, environment
from page_client import PageClient
from playwright.sync_api import expect
from ports import free_port
from show import Show, decide, violations
from waiting import until

from lacoc_shared.seat import Phase

pytestmark = [pytest.mark.slow, pytest.mark.long]

TOKENS = {"left": "l" * 26, "right": "r" * 26}
REFEREE = "w" * 26
COURTS = ("east", "west")
PHONE = {"width": 390, "height": 844}


CLOSE = "settings.match = { duration_s = 30.0, countdown_s = 1.0 }"
"""A match of 30 s without points is close to its end, so the director stays."""


def write_contest(folder: Path, **settings: str) -> Path:
    """Write a contest file of two courts: `east` plays Robot-Othello, `west` Flag-Strike."""
    parts = []
    for court, arena in zip(COURTS, ("othello", "flag-strike"), strict=True):
        parts += [f"[court.{court}]", f'arena = "{arena}"', settings.get(court, "")]
        parts += [f'listen = ["tcp/127.0.0.1:{free_port()}"]']
    file = folder / "contest.toml"
    file.write_text("\n".join(parts) + "\n")
    keep_tokens(file, TOKENS, REFEREE, COURTS)
    return file


@contextmanager
def running(
    folder: Path, **settings: str
) -> Iterator[tuple[dict[str, Running], Running, ExitStack]]:
    """Run both courts and a gateway; yield the courts, the gateway, and what closes more."""
    file = write_contest(folder, **settings)
    with ExitStack() as stack:

        def run(*words: str, name: str) -> Running:
            log = folder / f"{name}.log"
            running = Running(*words, "--json", log=log, env=environment(), cwd=folder)
            return stack.enter_context(running)

        courts = {one: run(ALONE, str(file), "--court", one, name=one) for one in COURTS}
        yield (
            courts,
            run("web", "--contest", str(file), "--listen", f"127.0.0.1:{free_port()}", name="web"),
            stack,
        )


def begin(url: str, key: str, court: str, stack: ExitStack) -> PageClient:
    """Begin a match at a court; return the referee's page."""
    for seat, name in (("left", "Ants"), ("right", "Bees")):
        contestant = PageClient(url, key, court=court)
        stack.callback(contestant.close)
        contestant.ask("join", seat=seat, token=TOKENS[seat], name=name)
        contestant.ask("ready", ready=True)
    referee = PageClient(url, key, court=court)
    stack.callback(referee.close)
    referee.ask("enter", token=REFEREE, by="Kim")
    referee.phase(Phase.READY)
    decide(referee, type="start")
    referee.phase(Phase.PLAYING)
    return referee


@pytest.mark.long(minutes=1)
def test_pages_follow_the_director(
    tmp_path: Path, built_pages: Path, open_page: OpenPage, console: Any
) -> None:
    """Two pages that follow the director show a court and the result of its match.

    When this court is killed, both pages go to another court without a reload.
    """
    console.expect_a_break()  # the gateway ends before the pages
    with running(tmp_path) as (courts, web, stack):
        url = web.opened["url"]
        paths = ("/watch?director=1&q=low&lang=en", "/overlay?director=1&q=low&lang=ja")
        watch, overlay = (
            Show(open_page(viewport=PHONE if one == 0 else None), url, path, drawn=False)
            for one, path in enumerate(paths)
        )
        watch.sees(".event", "The director begins in")
        expect(watch.find(".banner")).to_have_count(0)
        overlay.sees(".waits", "ディレクター")
        referee = begin(url, web.opened["key"], "east", stack)
        decide(referee, "for the test", type="abort")
        referee.phase(Phase.VOID)
        watch.sees(".result")
        decide(referee, type="next")
        for show in (watch, overlay):
            show.page.evaluate("window.stays = true")
            show.sees(".on-air[data-court=east]")
            show.sees(".latest", "Ants")
            assert violations(show.page) == []
        watch.sees(".latest", "void")

        courts["east"].kill()
        for show in (watch, overlay):
            gone = show.find(".on-air[data-court=west][data-why=gone]")
            expect(gone).to_be_visible()
            assert show.page.evaluate("window.stays")
            expect(show.find(".log, .thirds", has_text="Ants")).to_have_count(0)


SHOWN = """() => {
  const aside = document.querySelector(".aside:not([hidden])");
  const canvas = aside?.querySelector("canvas");
  if (!canvas || !/[1-9]\\d* : 0/.test(aside.textContent)) return null;
  const box = canvas.getBoundingClientRect();
  const court = (where) => where.querySelector(".on-air").dataset.court;
  return { beside: court(aside), first: court(document), width: box.width, right: box.right };
}"""
"""What a page shows while the second picture has points of the left team."""


def test_a_swing_elsewhere_is_in_the_second_picture(
    tmp_path: Path, built_pages: Path, open_page: OpenPage, console: Any
) -> None:
    """During the close end of one court, a second picture shows the swings at another one."""
    console.expect_a_break()  # the gateway ends before the pages
    with running(tmp_path, east=CLOSE) as (_, web, stack):
        url, key = web.opened["url"], web.opened["key"]
        paths = ("/watch?director=1&q=low&lang=ja", "/overlay?director=1&q=low&lang=en")
        pages = [
            Show(open_page(viewport=PHONE if one == 0 else None), url, path, drawn=False).page
            for one, path in enumerate(paths)
        ]
        decide(begin(url, key, "east", stack), "for the test", type="halt")
        west = begin(url, key, "west", stack)
        found: list[Any] = []

        def swing() -> bool:
            """Let the score at the other court swing; return whether both pages show it."""
            decide(west, "for the test", type="adjust", seat="left", points=20)
            pages[0].wait_for_timeout(1000)
            found[:] = [page.evaluate(SHOWN) for page in pages]
            return all(found)

        until(swing)
        for page, shown in zip(pages, found, strict=True):
            assert (shown["first"], shown["beside"]) == ("east", "west")
            width = page.viewport_size["width"]
            assert width / 10 < shown["width"] < width / 2
            assert shown["right"] <= width
            assert violations(page) == []
