"""Tests of /watch, the spectators' page, at a real court through a real gateway."""

import math
import re
from typing import Any

import numpy as np
import pytest
from chromium import OpenPage
from playwright.sync_api import expect
from ports import free_port
from show import STALE, Show, covered, decide, playing, violations
from stand import pixels_of
from venue import TOKENS, Venue

from lacoc_server.contest.live.court_link import CourtLink
from lacoc_shared.contest.file import load
from lacoc_shared.contest.tokens import new_token_hash
from lacoc_shared.messages import Done
from lacoc_shared.messages.office import AssignedSeat, Whereabouts
from lacoc_shared.network.session import open_client
from lacoc_shared.seat import Phase, SeatFlag
from lacoc_shared.words import say

pytestmark = pytest.mark.slow

LAPTOP = {"width": 1366, "height": 768}
PHONE = {"width": 390, "height": 844}
LONG = "W" * 24
LOW = "/watch?q=low&cam=arena"


def on_clock(text: str) -> int:
    """Return the seconds on a clock such as "2:59"."""
    minutes, seconds = text.split(":")
    return 60 * int(minutes) + int(seconds)


@pytest.mark.long
def test_a_late_spectator_has_everything_at_once(venue: Venue, open_page: OpenPage) -> None:
    """A late spectator sees the court's score, clock, board and log, and captions of new events."""
    venue.court()
    venue.web()
    referee = playing(venue)
    decide(referee, "touched by hand", type="set", marker="c5r5", state="left")
    show = Show(open_page(viewport=LAPTOP), venue.url, LOW)
    show.has_scores(19, 17)
    show.sees(".score-bug .team[data-seat='0']", "Ants")
    show.sees(".score-bug .phase", "Playing")
    show.sees(".hint", "Ants: ahead by 2")
    expect(show.find(".panel .log li")).to_have_count(len(referee.events))
    assert show.view("marker(35)") == 1
    assert show.find(".board g[aria-label='disc F6: left']").count() == 1
    expect(show.find(".panel .log li").first).to_contain_text(
        "disc F6 goes to Ants: Ants 19 : 17 Bees. Reason: touched by hand"
    )
    expect(show.find(".view-label")).to_have_text([*"ABCDEF", *"123456"])

    def has_the_time() -> bool:
        frame = referee.frame
        assert frame is not None
        left_s = (9000 - frame.clock_ticks) / 50
        shown_s = on_clock(show.find(".score-bug .clock").inner_text())
        return left_s - 3 <= shown_s <= left_s + 1

    show.until(has_the_time, "the clock is another one")

    reply = decide(referee, "flag out of place", type="adjust", seat="right", points=4)
    show.has_scores(19, 21)
    show.sees(".third.neutral .what", "Referee Kim: +4 points for Bees")
    show.sees(".third.neutral .gain", "+4")
    show.sees(".hint", "Bees: ahead by 2")
    expect(show.find(".panel .log li").first).to_contain_text("+4 points for Bees")
    show.until(lambda: show.view("drawnBeat") > reply["beat"] + 230, "time stands still")
    show.misses(".third[data-kind]")
    show.page.close()


def test_a_match_from_the_lobby_to_the_next(venue: Venue, open_page: OpenPage) -> None:
    """In each phase the page shows the state of the match and what comes next."""
    venue.court("--seconds", "2")
    venue.web()
    show = Show(open_page(viewport=LAPTOP), venue.url, LOW)
    show.sees(".opening .next", "Waiting for the left seat to join")
    show.sees(".opening .side[data-seat='0']", "nobody yet")
    left = venue.contestant("left", "Ants")
    show.sees(".opening .side[data-seat='0'] .ready", "ready")
    show.sees(".opening .next", "Waiting for the right seat to join")
    assert show.find(".head .hint").is_hidden()
    venue.contestant("right", "Bees")
    show.sees(".opening .next", "the referee starts the match")
    referee = venue.referee()
    referee.phase(Phase.READY)
    decide(referee, type="start")
    show.sees(".countdown")  # 3, 2, 1, GO!
    show.misses(".opening")
    show.sees(".result .kicker", "By the rules")
    show.sees(".result h1", "A draw")
    show.sees(".result", "time is up · 0:02.0 played")
    show.sees(".panel .log li[data-kind=phase]", "The match is finished: time is up.")
    show.sees(".result .next", "The referee is confirming")
    decide(referee, "the better walk", type="declare", winner="right")
    decide(referee, type="official")
    show.sees(".result .kicker", "Official")
    show.sees(".result h1", "Bees wins")
    show.sees(".result", "Decided by the referee")
    show.sees(".result .side.won", "Bees")
    show.sees(".result .next", "The referee opens the next match")
    silences = show.find(".panel .log li[data-kind=silent]")
    before = silences.count()  # on a busy machine a seat may fall silent in play
    left.close()
    referee.wait(lambda: referee.frame.seats[0].flags & SeatFlag.SILENT)
    assert silences.count() == before, "the match is over: it is no news"
    assert show.find(".third[data-kind=silent]").count() == 0
    show.page.get_by_role("button", name="Look at the field").click()
    show.misses(".result")
    assert "18 : 18" in show.page.title()
    decide(referee, type="next")
    show.sees(".brand", "match 2")
    show.sees(".opening .side[data-seat='1']", "Bees")
    assert "Official" not in show.find(".panel").inner_text()
    left = venue.contestant("left", "Ants")
    show.sees(".opening .side[data-seat='0'] .ready", "ready")
    left.close()
    show.sees(".third[data-kind=silent]", "The connection to Ants is lost")
    assert covered(show.page, ".foot", ".third") == []


@pytest.mark.long
def test_a_team_is_shown_in_its_own_look(venue: Venue, open_page: OpenPage) -> None:
    """A team's own colour and pattern show beside its score and on the board (rules 4)."""
    venue.started("serve", "--json", "--contest", str(venue.contest), name="court")
    plan = load(venue.contest)
    hashes = {seat: (new_token_hash(token),) for seat, token in TOKENS.items()}
    seats = (
        AssignedSeat(id="left", token_hashes=hashes["left"]),
        AssignedSeat(id="right", token_hashes=hashes["right"], colour="#cc3366", pattern="dots"),
    )
    address = plan.courts["main"].address()
    told = {
        hashes[seat][0]: Whereabouts(
            team="",
            state="court",
            said=say("team.open-seat", court="main", seat=seat),
            court="main",
            address=address,
            seat=seat,
            call="open.1",
            open=True,
        )
        for seat in TOKENS
    }
    with open_client([address]) as session:
        link = CourtLink(session, "main", plan.secrets.office)
        assert link.assign("open.1", say("fixture.open"), seats).wait() == Done()
        assert link.tell(told).wait() == Done()
    venue.web()
    playing(venue)
    show = Show(open_page(viewport=LAPTOP), venue.url, LOW)
    mark = show.find(".score-bug .team[data-seat='1'] .seat-mark")
    expect(mark).to_have_attribute("data-pattern", "dots")
    expect(mark).to_have_css("background-color", "rgb(204, 51, 102)")
    expect(show.find(".board defs pattern")).to_have_count(2)
    expect(show.find(".board defs circle")).to_have_count(1)


@pytest.mark.long
def test_the_winner_is_whom_the_referee_says(venue: Venue, open_page: OpenPage) -> None:
    """A winner whom the referee declares in a halt is shown as the winner (rules 4.1)."""
    venue.court()
    venue.web()
    referee = playing(venue)
    decide(referee, "a slip", type="adjust", seat="left", points=3)
    show = Show(open_page(), venue.url, LOW)
    decide(referee, "lights out", type="halt")
    decide(referee, "a foul", type="declare", winner="right")
    show.sees(".result .kicker", "Decided by the referee")
    show.sees(".result h1", "Bees wins")
    decide(referee, "", type="official")
    show.sees(".result .kicker", "Official result")
    show.sees(".result h1", "Bees wins")
    show.sees(".result .side.won", "Bees")


@pytest.mark.long
def test_a_result_that_the_referee_changes(venue: Venue, open_page: OpenPage) -> None:
    """The shown result follows if the referee changes a score or takes the change back."""
    venue.court()
    venue.web()
    referee = playing(venue)
    show = Show(open_page(), venue.url, LOW)
    decide(referee, "test", type="clock", gives_s=-3600)
    show.sees(".result h1", "A draw")
    number = decide(referee, "count again", type="adjust", seat="left", points=3)["event"]
    show.sees(".result h1", "Ants wins")
    show.sees(".result .kicker", "By the rules")
    decide(referee, "a slip", type="take-back", event=number)
    show.sees(".result h1", "A draw")
    decide(referee, "count again", type="adjust", seat="right", points=1)
    decide(referee, "", type="official")
    show.sees(".result .kicker", "Official result")
    show.sees(".result h1", "Bees wins")


@pytest.mark.long
def test_a_void_match_has_no_winner(venue: Venue, open_page: OpenPage) -> None:
    """A match that the referee declares void is shown without a winner."""
    court = venue.court()
    venue.web()
    referee = playing(venue)
    show = Show(open_page(), venue.url, LOW)
    decide(referee, "fire alarm", type="halt")
    show.sees(".third.neutral", "fire alarm")
    show.sees(".score-bug .phase", "Halted")
    decide(referee, "fire alarm", type="abort")
    show.sees(".result h1", "The match is void")
    assert show.find(".result .won").count() == 0
    court.kill()  # after the end of a match nothing is missing without its court
    show.sees(".banner.calm", "The match is over. Its court does not answer now.")
    show.misses(STALE)


@pytest.mark.long
def test_the_last_moments_are_seen_again(venue: Venue, open_page: OpenPage) -> None:
    """A spectator goes back, stops, sees slow motion, and is live again; so does the score."""
    venue.court()
    venue.web()
    referee = playing(venue)
    show = Show(open_page(viewport=LAPTOP), venue.url, LOW)
    show.until(lambda: (show.view("drawnBeat") or 0) > 0, "no picture")
    first = show.view("drawnBeat")
    show.until(lambda: show.view("drawnBeat") > first + 150, "time stands still")
    decide(referee, "flag out of place", type="adjust", seat="right", points=4)
    show.has_scores(18, 22)
    show.page.keyboard.press("ArrowLeft")
    show.page.keyboard.press("k")  # a slow machine takes its time to look at it
    show.sees(".again.is-back b", "s ago")
    show.has_scores(18, 18)
    show.misses(".panel .log li:has-text('+4 points')")
    stopped = show.view("drawnBeat")
    show.page.select_option(".again select", "0.25")
    show.page.wait_for_timeout(500)
    assert show.view("drawnBeat") - stopped < 10
    show.page.keyboard.press("k")
    show.until(lambda: show.view("drawnBeat") > stopped + 10, "it does not go on")
    assert violations(show.page) == []
    show.page.click(".again button:text-is('Live')")
    show.has_scores(18, 22)
    show.misses(".again.is-back")


@pytest.mark.long
def test_court_and_gateway_may_die(venue: Venue, open_page: OpenPage, console: Any) -> None:
    """While court or gateway is down, the picture is marked as old and a banner says why."""
    console.expect_a_break()
    court, web = venue.court(), venue.web()
    decide(playing(venue), "two", type="adjust", seat="left", points=2)
    show = Show(open_page(viewport=LAPTOP), venue.url, LOW)
    show.has_scores(20, 18)
    web.kill()
    show.sees(".banner", "Trying again")
    show.sees(STALE)
    web = venue.web()
    show.misses(".banner")
    show.misses(STALE)
    show.moves()
    show.has_scores(20, 18)

    court.kill()
    show.sees(".banner", "Waiting for court main")
    show.sees(STALE)
    venue.court()
    show.misses(".banner")
    show.misses(STALE)
    show.sees(".score-bug .phase", "Halted")
    show.has_scores(20, 18)
    numbers = show.find(".panel .log li").count()
    late = venue.page()
    late.wait(lambda: late.frame is not None)
    expect(show.find(".panel .log li")).to_have_count(len(late.events))
    assert numbers > 0


@pytest.mark.long
def test_cameras_panel_and_keys(venue: Venue, open_page: OpenPage) -> None:
    """Keys choose the camera and open the panel and settings, but not while a dialog is open."""
    venue.court()
    venue.web()
    playing(venue)
    show = Show(open_page(viewport=LAPTOP), venue.url, "/watch?q=low")
    assert show.view("camera") == "auto"
    for key, camera in (("3", "top"), ("4", "left"), ("5", "right"), ("6", "map"), ("2", "arena")):
        show.page.keyboard.press(key)
        show.until(lambda camera=camera: show.view("camera") == camera, camera)
    pressed = show.find(".cameras [aria-pressed='true']")
    expect(pressed).to_have_count(1)
    expect(pressed).to_contain_text("Arena")
    show.page.get_by_role("button", name="Top").click()
    show.until(lambda: show.view("camera") == "top", "the button does nothing")

    panel = show.page.get_by_role("button", name="Field and events")
    expect(panel).to_have_attribute("aria-expanded", "true")
    show.page.keyboard.press("e")
    show.misses(".panel")
    panel.click()
    show.sees(".panel .board")
    for _ in range(2):
        show.page.keyboard.down("e")  # the second press is the repeat of a held key
    show.misses(".panel")
    show.page.keyboard.up("e")
    show.page.keyboard.press("e")
    show.sees(".panel .board")

    show.page.keyboard.press("s")
    language = show.page.get_by_label("Language")
    language.select_option("日本語")
    show.sees("dialog", "設定")
    show.page.keyboard.press("3")
    show.page.keyboard.press("Escape")
    show.misses("dialog")
    assert show.page.evaluate("document.documentElement.lang") == "ja"
    show.sees(".score-bug .phase", "試合中")
    show.page.reload()
    show.sees(".score-bug .phase", "試合中")

    reached = set()
    for _ in range(14):
        show.page.keyboard.press("Tab")
        reached.add(show.page.evaluate("document.activeElement.textContent.trim()"))
    assert {"1自動", "6平面図"} <= reached


@pytest.mark.long
def test_a_court_that_is_unknown(venue: Venue, open_page: OpenPage) -> None:
    """At an unknown court the page keeps showing the refusal while it asks again."""
    venue.court()
    venue.web()
    page = open_page()
    sockets: list[Any] = []
    page.on("websocket", lambda socket: sockets.append(socket))
    show = Show(page, venue.url, "/watch?court=nope&lang=en", drawn=False)
    show.sees(".banner", "nope")
    page.evaluate(
        """() => {
          window.said = [];
          new MutationObserver(() => window.said.push(document.body.innerText)).observe(
            document.body, { childList: true, characterData: true, subtree: true });
        }"""
    )
    show.until(lambda: len(sockets) > 2, "it does not ask again")
    said = page.evaluate("window.said")
    assert not [text for text in said if "Connecting" in text or "nope" not in text]


@pytest.mark.parametrize("width", [1000, 1280, 1366, 1440, 1920])
@pytest.mark.long
def test_nothing_lies_over_the_teams(venue: Venue, open_page: OpenPage, width: int) -> None:
    """At each width the brand, the choice of court, the score and the buttons do not overlap."""
    text = venue.contest.read_text()
    side = text.replace("court.main", "court.second-court")
    venue.contest.write_text(text + side.replace(str(venue.court_port), str(free_port())))
    venue.court("--court", "main")
    venue.web()
    venue.contestant("left", LONG)
    venue.contestant("right", "歩" * 24)
    for query in ("", "&delay=2&lang=ja"):
        page = open_page(viewport={"width": width, "height": 720})
        show = Show(page, venue.url, f"/watch?q=low&cam=map&court=main{query}")
        for _ in range(2):
            show.sees(".score-bug [data-seat='1']", "歩")
            boxes = [
                show.find(selector).bounding_box()
                for selector in (".brand", ".corner.left select", ".score-bug", ".corner.right")
            ]
            brand, choice, bug, buttons = [box for box in boxes if box is not None]
            assert brand["y"] + brand["height"] <= choice["y"] or apart(brand, choice)
            assert apart(brand, bug), (query, brand, bug)
            assert apart(choice, bug), (query, choice, bug)
            assert apart(bug, buttons), (query, bug, buttons)
            for seat in range(2):
                name = show.find(f".score-bug [data-seat='{seat}'] .name").bounding_box()
                assert name is not None
                assert name["width"] > 60
            page.keyboard.press("e")  # the second round is without the panel
        page.close()


def apart(left: Any, right: Any) -> bool:
    """Return whether the right edge of one box is left of the other box."""
    return bool(left["x"] + left["width"] <= right["x"])


@pytest.mark.long
def test_long_words_stay_inside(venue: Venue, open_page: OpenPage) -> None:
    """A long team name and a long reason of the referee stay inside their boxes."""
    venue.court()
    venue.web()
    venue.contestant("left", LONG)
    venue.contestant("right", "Bees")
    referee = venue.referee()
    referee.phase(Phase.READY)
    decide(referee, type="start")
    referee.phase(Phase.PLAYING)
    show = Show(open_page(viewport=LAPTOP), venue.url, LOW)
    decide(referee, "n" * 200, type="adjust", seat="left", points=2)
    show.sees(".third.neutral .what", "nnn")
    show.sees(".panel .log", "nnn")
    for selector in (".panel .log", ".third.neutral .what", ".third"):
        width, room = show.find(selector).first.evaluate("(at) => [at.scrollWidth, at.clientWidth]")
        assert width <= room, selector
    show.sees(".hint", LONG)
    show.page.set_viewport_size(PHONE)
    for selector in (".head .hint", ".score-bug .points"):
        box = show.find(selector).last.bounding_box()
        assert box is not None
        assert box["x"] + box["width"] <= PHONE["width"], selector
    show.sees(".view-tag b")
    expect(show.find(".view-tag span").first).to_be_hidden()  # a name would hide the robots
    show.page.set_viewport_size(LAPTOP)
    mark = show.find(".view-tag b").first.bounding_box()
    tag = show.find(".view-tag").first.bounding_box()
    name = show.find(".view-tag span").first
    assert mark is not None
    assert tag is not None
    assert mark["width"] == pytest.approx(20, abs=0.5)
    assert tag["width"] <= 220
    assert name.evaluate("(at) => at.scrollWidth > at.clientWidth")  # so an ellipsis is shown
    expect(name).to_have_css("text-overflow", "ellipsis")


@pytest.mark.long
def test_news_are_read_aloud_once(venue: Venue, open_page: OpenPage) -> None:
    """A screen reader announces a new event only once, although the log shows the event too."""
    venue.court()
    venue.web()
    referee = playing(venue)
    show = Show(open_page(viewport=LAPTOP), venue.url, LOW)
    show.sees(".panel .log")
    decide(referee, "a foul", type="adjust", seat="left", points=2)
    show.sees(".third.neutral .what", "+2 points for Ants")
    show.sees(".panel .log", "+2 points for Ants")
    assert show.find("[aria-live]:not([aria-live=off])", has_text="+2 points for Ants").count() == 1


@pytest.mark.long
def test_a_phone(venue: Venue, open_page: OpenPage) -> None:
    """On an upright phone the page's parts stand below one another and fit the width."""
    venue.court()
    venue.web()
    playing(venue)
    page = open_page(viewport=PHONE, has_touch=True, is_mobile=True)
    show = Show(page, venue.url, LOW)
    show.sees(".board")
    tops = [
        show.find(selector).first.bounding_box()["y"]  # type: ignore[index]
        for selector in (".head", ".cameras", ".board", ".panel .log")
    ]
    assert tops == sorted(tops)
    assert page.evaluate("document.documentElement.scrollWidth") <= PHONE["width"]
    for button in show.find(".cameras .button, .corner .button").all():
        box = button.bounding_box()
        assert box is not None
        assert min(box["width"], box["height"]) >= 40
        assert box["x"] + box["width"] <= PHONE["width"]
    assert violations(page) == []


@pytest.mark.long
def test_without_webgl(venue: Venue, open_page: OpenPage) -> None:
    """Without WebGL the page draws a flat map; on a phone the banner does not cover the score.

    The court is killed for this check, because a lost court has one of the longest banners.
    """
    court = venue.court()
    venue.web()
    playing(venue)
    page = open_page(viewport=LAPTOP)
    page.add_init_script(
        "const get = HTMLCanvasElement.prototype.getContext;"
        "HTMLCanvasElement.prototype.getContext = function (kind, ...more) {"
        " return kind.startsWith('webgl') ? null : get.call(this, kind, ...more); }"
    )
    show = Show(page, venue.url, "/watch")
    assert show.view("quality") == "map"
    show.has_scores(18, 18)
    show.moves()
    page.set_viewport_size(PHONE)
    court.kill()
    show.sees(".banner", "Waiting for court main: no answer for")
    show.until(lambda: bottom(show, ".banner") <= top(show, ".head"), "the banner covers the score")


def top(show: Show, selector: str) -> float:
    box = show.find(selector).first.bounding_box()
    assert box is not None
    return box["y"]


def bottom(show: Show, selector: str) -> float:
    box = show.find(selector).first.bounding_box()
    assert box is not None
    return box["y"] + box["height"]


@pytest.mark.long
def test_the_viewer_chooses_the_colours(venue: Venue, open_page: OpenPage) -> None:
    """The colours that a viewer chooses show at once, and still after a reload."""
    venue.court("--seconds", "1")
    venue.web()
    referee = playing(venue)
    blank = open_page()
    show = Show(open_page(viewport=LAPTOP), venue.url, "/watch?q=low&cam=top")
    assert referee.sheet is not None
    names = [marker.name for marker in referee.sheet.markers]
    corner = referee.sheet.markers[names.index("c5r0")]  # no robot stands there
    assert show.view(f"marker({names.index('c5r0')})") == 2
    arena, contrast = referee.sheet.seats[1].colour, "#ffe600"

    def drawn() -> float:
        """Return a disc's green value divided by its red value: 0.69 is orange, 0.90 is yellow.

        Not a number: the disc is not drawn yet.
        """
        left, top = map(round, show.view(f"screen({corner.x_m}, {corner.y_m}, 0.01)"))
        disc = pixels_of(show.page, blank)[top - 9 : top + 10, left - 9 : left + 10]
        red, green, blue = np.median(disc.reshape(-1, 3), axis=0)
        return float(green / red) if red > 2 * blue else math.nan

    def seen(colour: str) -> None:
        text = f"rgb({', '.join(str(int(colour[at : at + 2], 16)) for at in (1, 3, 5))})"
        for place in (".score-bug", ".result"):
            mark = show.find(f"{place} [data-seat='1'] .seat-mark").first
            expect(mark).to_have_css("background-color", text)
        robot = show.find(".board g[aria-label^='Bees'] circle")
        expect(robot).to_have_css("fill", text)

    referee.phase(Phase.FINISHED)
    show.sees(".result")
    seen(arena)
    show.find(".result").get_by_role("button").click()
    show.until(lambda: drawn() < 0.75, "the disc is not orange")
    show.page.keyboard.press("s")
    show.page.get_by_label("Colours").select_option("high contrast")
    show.page.keyboard.press("Escape")
    show.misses("dialog")
    show.until(lambda: drawn() > 0.85, "the disc is not yellow")
    show.page.reload()
    show.draws()
    show.sees(".result")
    seen(contrast)
    show.find(".result").get_by_role("button").click()
    show.until(lambda: drawn() > 0.85, "the disc is not yellow")
    assert show.find(".score-bug .seat-mark").nth(1).get_attribute("data-pattern") == "stripes"


@pytest.mark.long
def test_who_wants_less_motion_gets_it(venue: Venue, open_page: OpenPage) -> None:
    """For a viewer who wants less motion the automatic camera does not move."""
    venue.court()
    venue.web()
    playing(venue)
    eyes: dict[str, float] = {}
    for motion in ("no-preference", "reduce"):
        show = Show(open_page(viewport=LAPTOP, reduced_motion=motion), venue.url, "/watch?q=low")
        show.sees(".foot .cameras")
        show.moves()
        moved = []
        for _ in range(5):
            before = show.view("eye")
            beat = show.view("drawnBeat")
            show.until(lambda: show.view("drawnBeat") > beat + 50, "the picture stands still")  # noqa: B023
            moved.append(np.abs(np.subtract(show.view("eye"), before)).max())
        # What comes over the picture makes the field fit anew, once.
        eyes[motion] = float(np.median(moved))
        show.page.close()
    assert eyes["no-preference"] > 1e-4
    assert eyes["reduce"] == 0


@pytest.mark.long
def test_who_wants_less_motion_sees_nothing_turn(venue: Venue, open_page: OpenPage) -> None:
    """For a viewer who wants less motion a spinner turns only once."""
    venue.web()
    page = open_page(reduced_motion="reduce")
    page.goto(f"{venue.url}/play")
    page.locator("main").evaluate(
        "(main) => main.append(Object.assign(document.createElement('i'), {className: 'spinner'}))"
    )
    expect(page.locator(".spinner")).to_have_css("animation-iteration-count", "1")


@pytest.mark.long
def test_accessible(venue: Venue, open_page: OpenPage) -> None:
    """Axe-core finds no serious mistake in the phases, the settings and the start page."""
    pytest.importorskip("axe_core_python")
    venue.court("--seconds", "1")
    venue.web()
    show = Show(open_page(viewport=LAPTOP), venue.url, LOW)
    show.sees(".opening")
    assert violations(show.page) == []
    referee = playing(venue)
    referee.phase(Phase.FINISHED)
    show.sees(".result")
    expect(show.find(".result")).to_have_css("opacity", "1")
    assert violations(show.page) == []
    show.page.keyboard.press("s")
    show.sees("dialog")
    assert violations(show.page) == []
    show.page.get_by_label("Colours").select_option("high contrast")
    assert violations(show.page) == []
    home = Show(open_page(viewport=LAPTOP), venue.url, "/", drawn=False)
    home.sees("h1", "LACOC")
    assert violations(home.page) == []


@pytest.mark.long
def test_japanese_throughout(venue: Venue, open_page: OpenPage) -> None:
    """In a Japanese browser the page has no English words except names."""
    venue.court("--seconds", "1")
    venue.web()
    show = Show(open_page(viewport=LAPTOP, locale="ja-JP"), venue.url, LOW)
    show.sees(".opening")
    names = r"Ants|Bees|LACOC|Robot-Othello|Hexapod|Kim|GO|main|[LRESF]"

    def english() -> list[str]:
        text = show.find("main").inner_text()
        return re.findall(r"[A-Za-z]{2,}", re.sub(names, "", text))

    assert english() == []
    referee = playing(venue)
    referee.phase(Phase.FINISHED)
    show.sees(".result h1", "引き分け")
    assert english() == []
