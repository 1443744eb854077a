"""Tests of forks and odds on /replay: notes, curve, highlights, and fork and match side by side."""

from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from bot_matches import bot_match
from chromium import OpenPage
from msgspec.structs import replace
from playwright.sync_api import Route, expect
from show import Show, violations
from venue import Venue

from lacoc_server.simulate.forks.chances import Odds
from lacoc_server.simulate.forks.fork import fork
from lacoc_server.simulate.forks.kept import write_odds
from lacoc_server.simulate.forks.line import ForkChange
from lacoc_server.simulate.forks.odds import MomentOdds
from lacoc_server.simulate.forks.origin import read_source
from lacoc_shared.record.files import odds_path

pytestmark = pytest.mark.slow

MATCH, FORK = "a-match", "fork-1-at-120-of-a-match"


@pytest.fixture(scope="module")
def library(built_pages: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Venue]:
    """Give a gateway with a match, its odds and a fork of it."""
    with ExitStack() as stack:
        venue = Venue(tmp_path_factory.mktemp("library"), stack)
        folder = venue.folder / "recordings"
        bots, settings = ("planner", "nearest"), {"match": {"duration_s": 2.0, "countdown_s": 0.2}}
        bot_match(folder, "othello", bots, settings, match_id=MATCH)
        file = folder / f"{MATCH}.mcap"
        fork(read_source(file), 120, ForkChange(restart=("left",)), match_id=FORK, folder=folder)
        moments = tuple(
            MomentOdds(beat=beat, clock_s=beat / 50, margins=(), chance=chance)
            for beat, chance in ((62, 0.5), (100, 0.9), (161, 0.25))
        )
        odds = Odds(
            match_id=MATCH,
            record_hash="",
            seats=("left", "right"),
            bots=("planner", "planner"),
            moments=moments,
        )
        write_odds(odds_path(file, MATCH), odds)
        write_odds(odds_path(folder / f"{FORK}.mcap", FORK), replace(odds, match_id="another"))
        venue.web("--recordings", str(folder))
        yield venue


def test_odds_are_a_curve_and_highlights_lead_there(library: Venue, open_page: OpenPage) -> None:
    """A curve shows the odds of the whole match; two numbers show the odds at the shown beat.

    A click on a highlight leads to its start.
    """
    page = open_page(viewport={"width": 1366, "height": 768})
    show = Show(page, library.url, f"/replay?file={MATCH}.mcap&t=2&q=low")
    show.sees(".transport .chances", "90 : 10 %")
    show.sees(".seek .odds-curve polyline")
    rows = show.find(".highlights button")
    rows.first.wait_for()
    assert [row.split("\n")[-1] for row in rows.all_inner_texts()] == [
        "nearest: 10 → 75 %",
        "planner: 50 → 90 %",
    ]
    rows.nth(1).click()
    show.sees(".transport .chances", "50 : 50 %")
    show.misses(".fork-note")
    assert violations(page) == []


@pytest.mark.long
def test_a_fork_says_so_and_stands_beside_its_match(library: Venue, open_page: OpenPage) -> None:
    """The list of recordings and the page of a fork say that it is a fork.

    The page can show the fork and its match side by side, both at one beat.
    """
    page = open_page(viewport={"width": 1366, "height": 768}, locale="ja-JP")
    show = Show(page, library.url, "/replay?q=low", drawn=False)
    show.sees(".recordings .fork", "もしも")
    assert show.find(".recordings .fork").count() == 1
    page = open_page(viewport={"width": 1366, "height": 768})
    show = Show(page, library.url, f"/replay?file={FORK}.mcap&t=3&q=low")
    show.sees(".fork-note", f"a fork of {MATCH} at 0:02.4, not an official record")
    # The odds beside the record are of another match, so they are computed from the score.
    by_score = "The chance to win by score and clock alone"
    assert show.find(".transport .chances").get_attribute("title") == by_score
    show.find(".fork-note button").click()
    show.sees(".scene.two .line:nth-child(2) .line-score", "The match")
    page.evaluate("window.__replay.seek(140)")
    show.until(
        lambda: [show.view("drawnBeat", index) for index in (0, 1)] == [140, 140],
        "fork and match are not drawn at the same beat",
    )
    assert violations(page) == []
    show.find(".fork-note button").click()
    show.misses(".scene.two")


@pytest.mark.long
def test_a_page_with_the_key_goes_on_from_where_it_is(library: Venue, open_page: OpenPage) -> None:
    """The page plays a fork from the beat that it shows, and shows it beside its match."""
    page = open_page(viewport={"width": 1366, "height": 768})
    show = Show(page, library.url, f"/replay?q=low#key={library.key}", drawn=False)
    show.sees(".recordings")
    # The address of a recording has no key: the tab keeps it.
    page.goto(f"{library.url}/replay?file={MATCH}.mcap&t=3&q=low")
    page.get_by_role("button", name="What if, from here").click()
    dialog = page.get_by_role("dialog")
    expect(dialog).to_contain_text("from 0:03.0")
    expect(dialog.locator(".why")).to_have_text("Change something first")
    expect(dialog.locator("option", has_text="the bot straight")).to_have_count(2)
    assert violations(page) == []
    dialog.locator("select[name=player-right]").select_option("straight")
    dialog.locator("input[name=restart-left]").check()
    dialog.get_by_role("button", name="Play on").click()
    show.sees(".fork-note", f"a fork of {MATCH} at 0:03.0")
    show.sees(".fork-note", "right: the bot straight")
    show.sees(".fork-note", "left: robot put back at its start")
    show.sees(".scene.two .line:nth-child(2) .line-score", "The match")
    with page.expect_download() as coming:
        page.get_by_text("Save the fork's record").click()
    assert coming.value.suggested_filename.startswith("fork-")
    page.go_back()  # to the match
    show.misses(".fork-note")

    page = open_page(viewport={"width": 1366, "height": 768})  # no key in this profile
    show = Show(page, library.url, f"/replay?file={MATCH}.mcap&t=3&q=low")
    show.sees(".position")
    show.misses("button[aria-label='What if, from here']")


@pytest.mark.long
def test_a_fork_that_nobody_waits_for_is_given_up(library: Venue, open_page: OpenPage) -> None:
    """A closed dialog gives its fork up; at its beginning a match can be changed from beat 1 on."""
    page = open_page(viewport={"width": 1366, "height": 768})
    show = Show(page, library.url, f"/replay?q=low#key={library.key}", drawn=False)
    show.sees(".recordings")
    played: list[Route] = []

    def play(route: Route) -> None:
        if route.request.method == "POST":
            played.append(route)  # it takes as long as this test
        else:
            route.fallback()

    page.route("**/forks", play)
    page.goto(f"{library.url}/replay?file={MATCH}.mcap&t=0&q=low")
    page.get_by_role("button", name="What if, from here").click()
    dialog = page.get_by_role("dialog")
    dialog.locator("input[name=restart-left]").check()
    with page.expect_request(lambda request: request.method == "POST"):
        dialog.get_by_role("button", name="Play on").click()
    assert played[0].request.post_data_json["beat"] == 1
    with page.expect_event("requestfailed"):
        dialog.get_by_role("button", name="Cancel").click()
    expect(dialog).to_have_count(0)
