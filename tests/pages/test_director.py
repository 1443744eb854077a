"""A page that follows the director: it goes from court to court without a reload."""

from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest
from chromium import OpenPage
from page_client import PageClient
from playwright.sync_api import expect
from ports import free_port
from show import Show, decide, violations
from venue import Process

from lacoc_shared.seat import Phase

pytestmark = [pytest.mark.slow, pytest.mark.long]

TOKENS = {"left": "l" * 26, "right": "r" * 26}
REFEREE = "w" * 26
COURTS = ("east", "west")
PHONE = {"width": 390, "height": 844}


def write_contest(folder: Path) -> Path:
    """Write a contest file of two courts."""
    seats = "".join(f'[court.{{0}}.seat.{s}]\ntoken = "{t}"\n' for s, t in TOKENS.items())
    court = (
        '[court.{0}]\narena = "othello"\nlisten = ["tcp/127.0.0.1:{1}"]\n'
        f'{seats}[court.{{0}}.referee]\ntoken = "{REFEREE}"\n'
    )
    file = folder / "contest.toml"
    file.write_text("".join(court.format(name, free_port()) for name in COURTS))
    return file


def play_and_abort(url: str, key: str, court: str, stack: ExitStack) -> PageClient:
    """Play a match at a court for a moment, and abort it; return the referee's page."""
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
    decide(referee, "for the test", type="abort")
    referee.phase(Phase.VOID)
    return referee


def test_pages_follow_the_director(
    tmp_path: Path, built_pages: Path, open_page: OpenPage, console: Any
) -> None:
    """Two pages that follow the director show a court and the result of its match.

    When this court is killed, both pages go to another court without a reload.
    """
    console.expect("WebSocket")  # the gateway ends before the pages
    file = write_contest(tmp_path)
    with ExitStack() as stack:

        def run(*words: str, name: str) -> Process:
            process = Process(tmp_path, *words, "--contest", str(file), "--json", name=name)
            stack.callback(process.close)
            return process

        courts = {one: run("serve", "--court", one, name=one) for one in COURTS}
        web = run("web", "--listen", f"127.0.0.1:{free_port()}", name="web")
        url = web.opened["url"]
        paths = ("/watch?director=1&q=low&lang=en", "/overlay?director=1&q=low&lang=ja")
        watch, overlay = (
            Show(open_page(viewport=PHONE if one == 0 else None), url, path, drawn=False)
            for one, path in enumerate(paths)
        )
        watch.sees(".event", "The director begins in")
        expect(watch.find(".banner")).to_have_count(0)
        overlay.sees(".waits", "ディレクター")
        referee = play_and_abort(url, web.opened["key"], "east", stack)
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
