"""A contest at a public address: behind a proxy, below a path, with a certificate of its own."""

import json
import re
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import av
import proxies
import pytest
import trustme
import zxingcpp
from chromium import OpenPage
from contestant import Contestant
from lacoc_process import contest_run, run_lacoc
from playwright.sync_api import Page, expect
from ports import free_port
from show import Show

from lacoc_server.contest.acts.organiser import enter
from lacoc_shared.seat import Phase

pytestmark = pytest.mark.slow

TEAMS = ("Ants", "六脚の会")
NAME = "lacoc.test"
PROXIES = {"caddy": proxies.caddy, "nginx": proxies.nginx}


class Place(NamedTuple):
    """A contest that runs at a public address."""

    pages: str
    office: str
    links: dict[str, str]
    inner: str
    """Where the gateway listens, "HOST:PORT"."""


@contextmanager
def online(folder: Path, how: str) -> Iterator[Place]:
    """Run a contest of two teams and one court.

    Args:
        folder: an empty folder.
        how: "caddy", "nginx" (the pages are below a path), or "own": a certificate of its own.
    """
    port, inner = free_port(), f"127.0.0.1:{free_port()}"
    authority = trustme.CA()
    pair = proxies.issue(folder, authority, NAME)
    pages = f"https://{NAME}:{port}" + ("/lacoc" if how == "nginx" else "")
    more = 'proxies = ["127.0.0.1"]'
    if how == "own":
        inner = f"127.0.0.1:{port}"
        authority.cert_pem.write_to_path(folder / "authority.pem")
        files = ("certificate", "fullchain"), ("private_key", "privkey"), ("authority", "authority")
        more = "\n".join(f'{entry} = "{name}.pem"' for entry, name in files)
    file = folder / "contest.toml"
    file.write_text(f"""
[contest]
name = "Spring Cup"
pages = "{pages}/"
{more}
[court.north]
arena = "othello"
listen = ["127.0.0.1:{free_port()}"]
[stage.final]
format = "round-robin"
arena = "othello"
settings.match.duration_s = 2.0
settings.match.countdown_s = 0.5
""")
    for team in TEAMS:
        enter(file, team, None, "", "")
    place = folder / "proxy"
    place.mkdir()
    with ExitStack() as stack:
        if how != "own":
            stack.enter_context(PROXIES[how](place, pair, NAME, port, inner))
        opened = stack.enter_context(contest_run(file, "--listen", inner)).opened
        links = json.loads(run_lacoc("contest", "invite", "--contest", str(file), "--json").stdout)
        assert opened["url"] == pages
        yield Place(pages, opened["office"], links, inner)


@pytest.mark.long(minutes=0.4)
@pytest.mark.parametrize("how", ["nginx", "caddy", "own"])
def test_a_contest_at_a_public_address(
    how: str, tmp_path: Path, built_pages: Path, open_page: OpenPage, console: Any
) -> None:
    """Two contestants, a referee and watchers play a match; all links have the public address.

    No page's console has an error, and no page or paper names another address.
    """
    with online(tmp_path, how) as place:
        assert {one.partition("#")[0] for one in place.links.values()} == {f"{place.pages}/play"}

        def opened(path: str = "/", **options: Any) -> Page:
            page = open_page(**options)
            page.goto(f"{place.pages}{path}")
            return page

        office = opened(place.office.removeprefix(place.pages))
        office.get_by_label("Print …").select_option("links")
        papers = office.locator(".papers")
        expect(papers).to_contain_text(f"{place.pages}/referee?court=north#")
        office.emulate_media(media="print")
        codes = codes_of(office)
        office.emulate_media(media="screen")
        assert {place.links[team] for team in TEAMS} <= codes
        assert all(code.startswith(place.pages) for code in codes)
        to_referee = re.search(rf"{place.pages}(/referee\S+)", papers.inner_text())
        assert to_referee is not None
        players = []
        for team in TEAMS:
            player = Contestant(open_page, place.pages)
            player.page.goto(place.links[team])
            players.append(player)
        shows = [
            Show(opened(), place.pages, path) for path in ("/watch?q=low", "/overlay?court=north")
        ]
        sheet = opened("/contest")
        expect(sheet.locator("main")).to_contain_text(TEAMS[1])
        for player in players:
            player.stands("seated")
            player.find("button.ready").click()
        referee = opened(to_referee[1], viewport={"width": 1366, "height": 768})
        referee.locator("input[name=by]").fill("Kim")
        referee.locator(".enter button[type=submit]").click()
        expect(referee.locator(".acting.mine")).to_be_visible()
        step(referee)
        shows[0].moves()
        for player in players:
            player.phase(Phase.PLAYING)
        expect(referee.locator("main.referee")).to_have_attribute(
            "data-phase", str(int(Phase.FINISHED))
        )
        step(referee)
        referee.get_by_role("dialog").locator("[type=submit]").click()
        for player in players:
            player.sees(".result h1")
        expect(sheet.locator("main")).to_contain_text("1 of 1 matches played")
        replay = opened("/replay")
        expect(replay.locator("h2")).to_contain_text("Recordings on the server")
        home = opened("/")
        pages = [home, office, sheet, referee, replay, *(one.page for one in (*players, *shows))]
        for page in pages:
            assert other_addresses(page, place.pages) == set(), page.url
        home.locator("nav a").first.click()
        expect(home).to_have_url(re.compile(re.escape(f"{place.pages}/watch")))
        for page in pages:  # before the contest ends
            page.context.close()


def codes_of(page: Page) -> set[str]:
    """Read all QR codes of a page, as a phone's camera does."""
    png = page.screenshot(full_page=True)
    (picture,) = av.CodecContext.create("png", "r").decode(av.Packet(png))
    found = zxingcpp.read_barcodes(picture.to_ndarray(format="gray"))
    return {one.text for one in found}


def step(referee: Page) -> None:
    """Click the big button when it accepts a press."""
    expect(referee.locator(".big .act")).to_be_visible()
    expect(referee.locator(".big.fresh")).to_have_count(0)
    referee.locator(".big .act").click()


def other_addresses(page: Page, ours: str) -> set[str]:
    """Return the addresses in a page's links and text that do not begin with the public one."""
    links = page.evaluate("[...document.querySelectorAll('a[href]')].map((one) => one.href)")
    texts = f"{page.content()} {' '.join(links)}"
    found = re.findall(r"\b(?:https?|wss?)://[^\s\"'<>]+", texts)
    return {one for one in found if not one.startswith((ours, "http://www.w3.org/"))}
