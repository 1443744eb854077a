"""Tests of /contest: at a gateway, and in a published folder on a server of plain files."""

import re
import shutil
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from chromium import OpenPage
from msgspec.structs import replace
from playwright.sync_api import expect
from show import violations
from stand import served
from venue import Venue

from lacoc_robots.library import robot_folder
from lacoc_server.contest.acts import organiser
from lacoc_server.contest.headless.pool import Pool
from lacoc_server.contest.league.contest import Day, compute
from lacoc_server.contest.league.facts import (
    Called,
    Entered,
    Played,
    Replaced,
    Withdrawn,
    decode,
)
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.league.sheet import ContestSheet, encode, sheet
from lacoc_server.contest.league.timetable.breaks import Break
from lacoc_shared.words import say

pytestmark = pytest.mark.slow

LAPTOP = {"width": 1366, "height": 768}
PHONE = {"width": 390, "height": 844}
PROJECTOR = {"width": 1920, "height": 1080}
TEAMS = ("Ants", "六脚の会", "Crabs & <b>Co</b>")
PATH = "/2026/spring cup"
TEXT = """
[contest]
name = "Tiny Cup"
recordings = "recordings"
[court.main]
arena = "othello"
[stage.league]
format = "round-robin"
arena = "othello"
settings = { match = { duration_s = 1.0, countdown_s = 1.0, start = "ready" } }
[stage.cup]
format = "single-knockout"
after = "league"
arena = "othello"
settings = { match = { duration_s = 1.0, countdown_s = 1.0, start = "ready" } }
"""


class Cup(NamedTuple):
    """A contest that was played and published."""

    sheet: ContestSheet
    folder: Path
    url: str
    """Address of the published folder at a web server."""


@pytest.fixture(scope="module")
def cup(built_pages: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Cup]:
    """Give a contest of three bots that a web server serves under a path."""
    place = tmp_path_factory.mktemp("contest")
    file = place / "contest.toml"
    file.write_text(TEXT, encoding="utf-8")
    for team in TEAMS:
        organiser.enter(file, team, robot_folder("hexapod"), "nearest", "")
    made, _ = organiser.play_headless(file, "nearest", Pool(1), lambda done, there: None)
    root = place / "www"
    folder = root / PATH.strip("/")
    folder.mkdir(parents=True)
    organiser.publish_to(file, folder)
    with served(root) as url:
        yield Cup(made, folder, f"{url}{PATH}/")


def test_a_published_folder_shows_the_contest_and_its_replays(
    cup: Cup, open_page: OpenPage
) -> None:
    """A published folder shows the contest at any path of a web server; results lead to replays."""
    page = open_page(viewport=LAPTOP)
    page.goto(cup.url)
    expect(page.locator("h1")).to_have_text("Tiny Cup")
    view = cup.sheet.stages[-1]
    expect(page.locator(".head .winner .team")).to_have_text(view.tables[0].rows[0].team)
    rows = page.locator("#stage-league .standings tbody tr")
    ranked = [row.team for row in cup.sheet.stages[0].tables[0].rows]
    expect(rows.locator(".team")).to_have_text(ranked)
    assert page.locator(".court a, a[href^=watch]").count() == 0  # there is no gateway here
    game = cup.sheet.stages[0].matches[0].games[0]
    link = page.locator(f'#stage-league .match a[href*="{game.record}"]')
    expect(link).to_have_text(f"{game.scores[0]}:{game.scores[1]}")
    link.click()
    page.wait_for_function("window.__replay !== undefined")
    teams = page.evaluate("window.__replay.recording.sheet.value.seats.map((seat) => seat.team)")
    assert tuple(teams) == game.teams
    page.get_by_role("link", name="The contest").click()
    expect(page.locator("h1")).to_have_text("Tiny Cup")


def test_decisions_stand_with_their_reasons(
    cup: Cup, open_page: OpenPage, servers: ExitStack, tmp_path: Path
) -> None:
    """The page says what was decided and why, the newest first, and who has left."""
    shutil.copytree(cup.folder, tmp_path, dirs_exist_ok=True)
    facts = decode((cup.folder / "facts.json").read_bytes())
    league = next(fact for fact in facts if isinstance(fact, Played))
    last = facts[-1].number
    game = {"pairing": league.pairing, "game": league.game, "teams": league.teams}
    more = [
        Replaced(id="d1", number=last + 1, scores=(3, 9), outcome="right", reason="x", **game),  # type: ignore[arg-type]
        Withdrawn(id="d2", number=last + 2, team=TEAMS[2], reason="robot <b>broken</b>"),
    ]
    made = sheet("Tiny Cup", compute([*facts, *more], FORMATS))
    (tmp_path / "contest.json").write_bytes(encode(made))
    url = servers.enter_context(served(tmp_path))
    page = open_page(viewport=LAPTOP)
    page.goto(url)
    left, right = league.teams
    state = page.locator(".head .state")
    expect(state).to_contain_text("2 teams")
    expect(state).to_contain_text(f" · withdrawn: {TEAMS[2]}")
    told = page.locator("#decisions li")
    expect(told).to_have_count(2)
    expect(told.first).to_contain_text(f"{TEAMS[2]} has withdrawn")
    expect(told.first).to_contain_text("Reason: robot <b>broken</b>")
    expect(told.last).to_contain_text(f"the result is {left} 3 : 9 {right}")
    told.last.get_by_role("link").click()
    expect(page.locator(f'[id="match-{league.pairing}"]')).to_be_in_viewport()


def test_a_pause_ends_on_the_page_at_its_moment(
    cup: Cup, open_page: OpenPage, servers: ExitStack, tmp_path: Path
) -> None:
    """Nobody has to load the page again: the pause goes by itself, and a decided place says why."""
    shutil.copytree(cup.folder, tmp_path, dirs_exist_ok=True)
    until_ms = 1_800_000_000_000
    made = replace(
        cup.sheet,
        day=Day(paused=False, until_ms=until_ms, reason="lunch"),
        pause=Break(until_ms=until_ms, fixture=say("fixture.final", stage=None)),
    )
    (tmp_path / "contest.json").write_bytes(encode(made))
    url = servers.enter_context(served(tmp_path))
    page = open_page(viewport=LAPTOP)
    page.clock.install(time=(until_ms - 5000) / 1000)
    page.goto(f"{url}?big")
    expect(page.locator(".banner")).to_contain_text("lunch")
    page.clock.run_for(6000)
    expect(page.locator(".banner")).to_have_count(0)


def test_a_bracket_shows_all_its_texts(cup: Cup, open_page: OpenPage) -> None:
    """No text of a bracket is cut, not even the note below the lowest box."""
    page = open_page(viewport=LAPTOP)
    page.goto(cup.url)
    expect(page.locator(".bracket .note").first).to_be_visible()
    cut = page.evaluate(
        """() => [...document.querySelectorAll(".bracket")].flatMap((svg) => {
          const all = svg.getBoundingClientRect();
          return [...svg.querySelectorAll("text")].filter((text) => {
            const own = text.getBoundingClientRect();
            return own.top < all.top || own.bottom > all.bottom || own.right > all.right;
          }).map((text) => text.textContent);
        })"""
    )
    assert cut == []


@pytest.mark.long
def test_a_team_shows_its_way(cup: Cup, open_page: OpenPage) -> None:
    """A click on a team shows its matches, places and rating, at an address of its own."""
    page = open_page(viewport=LAPTOP)
    page.goto(cup.url)
    page.locator("#stage-league .standings .team", has_text=TEAMS[2]).click()
    dialog = page.get_by_role("dialog", name=TEAMS[2])
    there = [match for view in cup.sheet.stages for match in view.matches]
    own = [match for match in there if TEAMS[2] in match.teams and "" not in match.teams]
    expect(dialog.locator(".match")).to_have_count(len(own))
    rating = next(one for one in cup.sheet.ratings if one.team == TEAMS[2])
    expect(dialog).to_contain_text(f"± {round(rating.interval_elo)}")
    assert "#team=" in page.url
    page.reload()
    expect(dialog).to_be_visible()
    page.keyboard.press("Escape")
    expect(dialog).to_have_count(0)
    expect(page).to_have_url(re.compile("^[^#]*$"))


def test_a_tie_break_is_explained_where_it_stands(cup: Cup, open_page: OpenPage) -> None:
    """A tap on the heading of a tie-break says in words what it is."""
    page = open_page(viewport=PHONE, has_touch=True)
    page.goto(cup.url)
    page.get_by_role("button", name="Dir.").tap()
    expect(page.locator("[popover]")).to_be_visible()
    expect(page.locator("[popover]")).to_contain_text("Direct comparison")


@pytest.mark.parametrize("locale", ["en-GB", pytest.param("ja-JP", marks=pytest.mark.long)])
def test_a_phone_and_axe(cup: Cup, open_page: OpenPage, locale: str) -> None:
    """Only tables and brackets scroll sideways on a phone; axe-core finds no serious mistake."""
    pytest.importorskip("axe_core_python")
    page = open_page(viewport=PHONE, has_touch=True, is_mobile=True, locale=locale)
    page.goto(cup.url)
    expect(page.locator(".bracket .name").first).to_be_visible()
    for element in ("document.documentElement", "document.querySelector('main')"):
        assert page.evaluate(f"{element}.scrollWidth") <= PHONE["width"]
    assert violations(page) == []
    page.locator(".standings .team").first.click()
    expect(page.get_by_role("dialog")).to_be_visible()
    assert violations(page) == []


def test_the_projector_turns_over_by_itself(cup: Cup, open_page: OpenPage) -> None:
    """All slides fit the projector; they follow each other, and stop when asked to."""
    page = open_page(viewport=PROJECTOR)
    page.clock.install()
    page.goto(f"{cup.url}?big")
    expect(page.locator(".slide")).to_have_attribute("data-slide", "podium")
    for slide in ("bracket", "ratings", "podium"):
        page.clock.run_for(12_500)
        expect(page.locator(".slide")).to_have_attribute("data-slide", slide)
        assert page.evaluate(
            "(e => e.scrollHeight <= e.clientHeight)(document.querySelector('.slide'))"
        )
    page.keyboard.press("Space")
    page.clock.run_for(60_000)
    expect(page.locator(".slide")).to_have_attribute("data-slide", "podium")


@pytest.mark.long
def test_paper_has_all_rounds(cup: Cup, open_page: OpenPage) -> None:
    """On paper every match of every round is there, and the page's buttons are not."""
    page = open_page(viewport=LAPTOP)
    page.goto(cup.url)
    expect(page.locator("h1")).to_have_text("Tiny Cup")
    page.evaluate("for (const one of document.querySelectorAll('details')) one.open = false")
    page.emulate_media(media="print")
    expect(page.locator(".tools")).not_to_be_visible()
    for match in page.locator(".schedule .match").all():
        box = match.bounding_box()
        assert box is not None
        assert box["height"] > 0


def test_a_gateway_follows_the_contest(
    cup: Cup, venue: Venue, open_page: OpenPage, console: Any
) -> None:
    """The page says that no contest is here yet; then it shows each new sheet without a reload."""
    venue.web()
    page = open_page(viewport=LAPTOP)
    console.expect(r"contest\.json")  # a browser logs each 404
    page.goto(f"{venue.url}/contest")
    expect(page.get_by_role("status")).to_contain_text("no contest here yet")
    facts = decode((cup.folder / "facts.json").read_bytes())
    entered = [fact for fact in facts if isinstance(fact, Entered)]
    path = venue.contest.with_suffix(".json")
    path.write_bytes(encode(sheet("Tiny Cup", compute(entered, FORMATS))))
    expect(page.locator(".badge")).to_have_text("Not drawn yet")
    played = next(fact for fact in facts if isinstance(fact, Played))
    known = facts[: facts.index(played)]
    game = {"pairing": played.pairing, "game": 1, "teams": played.teams}
    call = Called(id="call", number=played.number, court="hall 1", **game)  # type: ignore[arg-type]
    path.write_bytes(encode(sheet("Tiny Cup", compute([*known, call], FORMATS))))
    expect(page.locator(".badge")).to_have_text("Under way")
    watch = page.get_by_role("link", name="Watch court hall 1")
    expect(watch).to_have_attribute("href", "watch?court=hall%201")
    path.write_bytes(b"{")
    expect(page.get_by_role("alert")).to_contain_text("Trying again")
    path.write_bytes(encode(cup.sheet))
    expect(page.locator(".badge")).to_have_text("Over")
    expect(page.get_by_role("alert")).to_have_count(0)
