"""Tests of the contest's pages with many teams, on a phone, a laptop and a projector."""

import itertools
import json
from contextlib import ExitStack
from pathlib import Path
from random import Random

import pytest
from chance_event import Event
from chromium import OpenPage
from lacoc_process import contest_run, run_lacoc
from playwright.sync_api import Page, expect
from ports import free_port
from show import violations
from stand import served

from lacoc_server.contest.acts import organiser
from lacoc_server.contest.league.sheet import encode, sheet
from lacoc_shared.command import plugins

pytestmark = [pytest.mark.slow, pytest.mark.long]

PHONE = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True}
LAPTOP = {"viewport": {"width": 1366, "height": 768}}
PROJECTOR = {"viewport": {"width": 1920, "height": 1080}}
MANY = 200


def names(count: int) -> list[str]:
    """Return names of teams; some are Japanese, and some are long."""
    kinds = ("Ants {}", "六脚の会 {}", "Walking Robots Osaka {}")
    return [kinds[number % len(kinds)].format(number) for number in range(1, count + 1)]


def is_narrow(page: Page) -> bool:
    """Return whether nothing but tables and brackets scrolls sideways."""
    width = page.viewport_size
    assert width is not None
    return all(
        page.evaluate(f"{element}.scrollWidth") <= width["width"]
        for element in ("document.documentElement", "document.querySelector('main')")
    )


@pytest.mark.parametrize(("teams", "courts"), [(8, 2), (30, 8), (MANY, 16)])
def test_contest(
    tmp_path: Path,
    built_pages: Path,
    open_page: OpenPage,
    servers: ExitStack,
    teams: int,
    courts: int,
) -> None:
    """/contest shows a Swiss stage and a bracket: readable on a phone, and all slides fit."""
    event = Event(teams, courts, Random(teams))
    event.begin("swiss", "swiss", event.names, rounds=3)
    for _ in event.play("swiss"):
        pass
    best = list(event.contest.stage("swiss").ranking[:32])
    event.begin("finals", "double-knockout", best)
    for _ in itertools.islice(event.play("finals"), teams // 10):
        pass
    text = encode(sheet("Spring Cup", event.contest)).decode()
    for own, shown in zip(event.names, names(teams), strict=True):
        text = text.replace(f'"{own}"', json.dumps(shown, ensure_ascii=False))
    for site in plugins.installed("lacoc.site").values():
        site.load()(tmp_path)
    (tmp_path / "contest.json").write_text(text, "utf-8")
    url = servers.enter_context(served(tmp_path))
    for screen, locale in ((PHONE, "ja-JP"), (LAPTOP, "en-GB")):
        page = open_page(**screen, locale=locale)
        page.goto(url)
        rows = page.locator("#stage-swiss .standings tbody tr")
        expect(rows).to_have_count(teams)
        assert is_narrow(page)
        assert violations(page) == []
    page = open_page(**PROJECTOR)
    page.clock.install()
    page.goto(f"{url}?big")
    slides = []
    for _ in range(12):
        slide = page.locator(".slide")
        slides.append(slide.get_attribute("data-slide"))
        assert slide.evaluate("(e) => e.scrollHeight <= e.clientHeight"), slides
        page.clock.run_for(12_500)
    assert {*slides} >= {"now", "bracket"}


def test_office(tmp_path: Path, built_pages: Path, open_page: OpenPage, servers: ExitStack) -> None:
    """/office shows two hundred entries, and the timetable of their first round.

    Entries are open without --entries, because the contest file has a time when they close.
    """
    file = tmp_path / "contest.toml"
    run_lacoc("contest", "init", str(file), "--courts", "4")
    text = file.read_text().replace("0.0.0.0:", "127.0.0.1:").replace("groups = 2", "groups = 40")
    for port in range(7447, 7451):
        text = text.replace(f"127.0.0.1:{port}", f"127.0.0.1:{free_port()}")
    file.write_text(text.replace("# entries_close = 2030-", "entries_close = 2999-"))
    for team in names(MANY):
        organiser.enter(file, team, None, "planner", "")
    run = servers.enter_context(contest_run(file))
    url = run.opened["office"]
    phone, laptop = open_page(**PHONE, locale="ja-JP"), open_page(**LAPTOP)
    for page in (phone, laptop):
        page.goto(url)
        expect(page.locator(".entries li")).to_have_count(MANY)
    laptop.get_by_role("button", name="Close entries and draw").click()
    laptop.get_by_role("button", name=f"Close and draw with {MANY} teams").click()
    for page in (laptop, phone):
        expect(page.locator(".slot").first).to_be_visible()
        assert is_narrow(page)
        assert violations(page) == []
