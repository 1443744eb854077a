"""A team's page in a contest with an office: it finds the team's courts by itself."""

import contextlib
import json
import re
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import msgspec
import pytest
from contestant import Contestant, Sit
from court_stub import TOKENS, CourtStub
from lacoc_process import contest_run, run_lacoc
from playwright.sync_api import Error, expect
from ports import free_port
from show import violations
from venue import Venue
from waiting import LIMIT_S, until

from lacoc_server.contest.acts.organiser import enter
from lacoc_shared import seal
from lacoc_shared.inputs import JoinSeat
from lacoc_shared.messages.office import Whereabouts
from lacoc_shared.seat import Phase
from lacoc_shared.words import say

pytestmark = pytest.mark.slow

TEAMS = ("Ants", "Bees", "Crabs", "Dogs")
PERSON = "Bees"
"""Plays its first match at the second court, so that its page must go there."""


@contextlib.contextmanager
def contest(folder: Path) -> Iterator[dict[str, Any]]:
    """Run a contest of one team of people and three bots on two courts; give its addresses."""
    courts = "".join(
        f"""
[court.{name}]
arena = "othello"
listen = ["127.0.0.1:{free_port()}"]
"""
        for name in ("north", "south")
    )
    file, where = folder / "contest.toml", f"127.0.0.1:{free_port()}"
    file.write_text(f"""
[contest]
name = "Spring Cup"
pages = "http://{where}"
least_rest_s = 3.0
{courts}
[stage.league]
format = "swiss"
rounds = 2
arena = "othello"
settings.match.duration_s = 4.0
settings.match.countdown_s = 0.5
settings.match.start = "ready"
""")
    for team in TEAMS:
        enter(file, team, None, "" if team == PERSON else "straight", "")
    with contest_run(file, "--until-over", "--speed", "2", "--listen", where) as run:
        invite = ("contest", "invite", "--contest", str(file))
        lines = json.loads(run_lacoc(*invite, "--json").stdout)
        yield run.opened | {"link": lines[PERSON]}
        assert run.process.wait(LIMIT_S) == 0


PLAYING = int(Phase.PLAYING)
TITLES = """
new MutationObserver(() => {
  const title = document.querySelector(".entrance h1")?.textContent ?? "";
  sessionStorage.titles = `${sessionStorage.titles ?? ""}|${title}`;
}).observe(document, { childList: true, subtree: true, characterData: true });
"""
"""Notes what the page says while it is on its way."""


@pytest.mark.long
def test_a_page_follows_its_team(tmp_path: Path, built_pages: Path, sit: Sit, console: Any) -> None:
    """With the team's link a page shows what comes next, and plays wherever the team is called.

    A wrong token, typed before the link is opened, is refused and does no harm.
    """
    console.expect_a_break()  # the contest ends before the page is closed
    with contest(tmp_path) as there:
        link = there["link"]
        player = sit(there["url"])
        type_wrong_token(player, link)
        player.page.add_init_script(TITLES)
        player.page.goto(link)
        # The token is kept for the tab, also over a reload; it does not stay in the address.
        expect(player.page).to_have_url(re.compile("^[^#]*$"))
        # It goes to the court of its first match. Only then, or its move would cut the reload off.
        expect(player.page).to_have_url(re.compile("court=south"))
        assert "Opening court south" in player.page.evaluate("sessionStorage.titles")
        size = player.page.viewport_size
        assert size is not None
        player.page.set_viewport_size({"width": 390, "height": 844})
        player.sees(".fixture", "Swiss")
        player.page.set_viewport_size({"width": 1280, "height": 800})
        player.sees(".foot .court", "Court south")
        court = player.find(".foot .court")
        assert court.evaluate("one => one.scrollWidth <= one.clientWidth")
        player.page.set_viewport_size(size)
        player.page.reload()
        asks_before_it_takes_over(player, sit(there["url"]), link)
        opponents = [play_a_match(player) for _ in range(2)]
        assert len({*opponents}) == len(opponents)
        player.sees(".entrance[data-state=over]", "The contest is over: place")
        own = f".entrance .button.strong[href='contest#team={PERSON}']"
        player.sees(own, "Your matches and their replays")
        player.misses(".entrance a[href^=watch]")
        player.sees(".entrance a[href='rules/en']", "All rules")
        assert violations(player.page) == []


def asks_before_it_takes_over(driver: Contestant, other: Contestant, link: str) -> None:
    """Open the link in a second browser while the seat is driven; take the seat over, and back."""
    driver.stands("seated")
    other.page.goto(link)
    other.sees("[role=alert]", f"{PERSON} is driven in another window")
    driver.stands("seated")
    other.page.get_by_role("button", name="Take over").click()
    other.stands("seated")
    driver.stands("lost")
    other.page.context.close()
    driver.page.get_by_role("button", name="Join again").click()
    driver.stands("seated")


def type_wrong_token(player: Contestant, link: str) -> None:
    """Type a token that no team has, and see that it is refused."""
    player.page.goto(link.partition("#")[0])
    player.page.fill("#team-token", "a token that no team has")
    player.page.click("button[type=submit]")
    player.sees("#team-token-error", "Nobody here has this token.")


def play_a_match(player: Contestant) -> str:
    """Play the match to which the page goes by itself; return the opponent's name."""
    button, playing = player.find("button.ready"), player.find(f".phase[data-phase='{PLAYING}']")
    end_s = time.monotonic() + LIMIT_S
    while not playing.count():  # the first press may still be for the match before
        assert time.monotonic() < end_s, "play has not begun"
        if button.count():
            with contextlib.suppress(Error):  # the page goes to its next court at this moment
                button.click(timeout=1000)
        player.page.wait_for_timeout(50)
    teams = " ".join(player.find(".score-bug .team").all_inner_texts())
    player.sees(".result h1")
    return next(name for name in TEAMS if name != PERSON and name in teams)


@pytest.mark.long
def test_a_team_that_plays_no_more_reads_why_and_is_not_alarmed(
    venue: Venue, sit: Sit, console: Any
) -> None:
    """The card says what was decided; a court that is away then is no trouble of the team's."""
    console.expect_a_break()
    what = say("decided.no-show", match="Final", team="Bees")
    there = Whereabouts(
        team="Ants",
        state="out",
        said=say("team.out", place=None),
        news=say("team.news", what=what, reason="not seen since noon"),
    )
    with CourtStub(f"127.0.0.1:{venue.court_port}") as court:
        court.teams.tell({seal.hash_token(TOKENS["left"], bytes(16)): there})
        venue.web()
        player = sit(venue.url)
        player.open(token=TOKENS["left"])
        player.sees(".entrance .coming", "Final: Bees did not come. Reason: not seen since noon")
        player.misses(".banner")
    player.sees(".banner.calm", "Its court does not answer now.")


@pytest.mark.long
def test_a_seat_that_the_court_refuses_is_told_and_asked_for_again(venue: Venue, sit: Sit) -> None:
    """The card says why the team has no seat yet; the page goes on asking without a person."""
    there = Whereabouts(
        team="Nobody",
        state="court",
        said=say(
            "team.plays", court="main", seat="left", opponent="Bees", fixture=say("fixture.open")
        ),
        court="main",
        seat="left",
        call="c1",
    )
    with CourtStub(f"127.0.0.1:{venue.court_port}") as court:
        court.show(court.scene, call="c1")
        court.teams.tell({seal.hash_token(TOKENS["left"], bytes(16)): there})
        venue.web()
        player = sit(venue.url)
        player.open(token=TOKENS["left"])
        player.sees(".entrance[data-state=court] [role=alert]", "the match is being played")
        asked = joins(court)
        until(lambda: joins(court) > asked)
        player.sees(".entrance [role=alert]", "the match is being played")
        # The court lets the team in from here on.
        there = msgspec.structs.replace(there, team="Ants")
        court.teams.tell({seal.hash_token(TOKENS["left"], bytes(16)): there})
        player.stands("seated")


def joins(court: CourtStub) -> int:
    """Count how often a team has asked for a seat."""
    return sum(isinstance(one, JoinSeat) for one in court.inputs)
