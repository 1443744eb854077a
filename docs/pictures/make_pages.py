"""Render docs/pictures/page-*.png: every page as it looks, in real matches at real courts.

Run it from the checkout, with the packages of its tests: python docs/pictures/make_pages.py It
takes some minutes without a graphics card. Arguments such as "replay" choose some pictures.
"""

import random
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

from playwright.sync_api import Browser, Page, sync_playwright

sys.path.insert(0, str(Path(__file__).parents[2]))
import tests  # noqa: F401 - makes their helpers importable
from chromium import FLAGS, build_pages, find_chromium
from class_room import ClassRoom
from contestant import Contestant
from lacoc_process import COMMAND, environment
from own_page import OwnPage
from show import Show
from venue import REFEREE, TOKENS, Venue

from lacoc_arenas import arena as arenas
from lacoc_client.web.gateway.wire import MessageKind
from lacoc_robots.library import sample_gait_files
from lacoc_server.simulate import player, simulate
from lacoc_shared.record.schema import Setup

LAPTOP = {"width": 1366, "height": 768}
SOURCE = {"width": 1920, "height": 1080}
PATIENCE_S = 300.0

Open = Callable[..., Page]


def main() -> None:
    """Take all pictures."""
    build_pages()
    with sync_playwright() as playwright, tempfile.TemporaryDirectory() as folder:
        browser = playwright.chromium.launch(executable_path=find_chromium(), args=list(FLAGS))
        for take in (practice, design, classroom, replay, contest, broadcast):
            if sys.argv[1:] and take.__name__ not in sys.argv:
                continue
            own = Path(folder) / take.__name__
            own.mkdir()
            with pages(browser) as open_page:
                take(own, open_page)
        browser.close()


@contextmanager
def pages(browser: Browser) -> Iterator[Open]:
    """Give a function that opens a page for a new person, drawn in the finest quality."""
    with ExitStack() as stack:

        def opened(**options: Any) -> Page:
            context = browser.new_context(locale="en-GB", **{"viewport": LAPTOP} | options)
            stack.callback(context.close)
            context.add_init_script("localStorage.setItem('lacoc.quality', '\"high\"')")
            return context.new_page()

        yield opened


def practice(folder: Path, open_page: Open) -> None:
    """Take the picture of /practice while the robot walks."""
    with OwnPage(folder, "practice") as own:
        url, key = own.url, own.key
        page = Contestant(open_page, url, viewport=LAPTOP)
        page.page.goto(f"{url}/practice#key={key}")
        page.stands("seated")
        for digit in ("1", "2", "3", "4", "1", "2"):
            page.press(digit)
            page.key_stands(int(digit))
            page.page.wait_for_timeout(600)
        picture(page.page, "practice")


def design(folder: Path, open_page: Open) -> None:
    """Take the picture of two trials that are compared."""
    postures = sample_gait_files("hexapod").postures
    assert postures is not None
    (folder / postures.name).write_bytes(postures.data)
    with OwnPage(folder, "design") as own:
        url, key = own.url, own.key
        page = Contestant(open_page, url, viewport=LAPTOP)
        page.page.goto(f"{url}/design#key={key}")
        page.sees("#gait-grid td")
        page.page.click("#tab-trials")
        page.press("Control+Enter")
        page.sees(".trial-result .tiles")
        page.page.click("#cell-1-4")
        page.page.keyboard.type("-20")
        page.press("Enter", "Control+Enter")
        page.sees(".trials > li:nth-child(2)")
        page.page.click(".bar .acts >> text=Compare")
        page.page.wait_for_timeout(2500)
        page.page.click("[aria-label=Pause]")
        picture(page.page, "design")


NAMES = (
    "Aoi Ben Chie Dan Eva Finn Gina Hal Ida Jo Kim Leo Mia Nao Ole Pia Quin Ren Sora Tom Uta Vera "
    "Wim Xena Yuki Zoe Emil Fumi Gert Hana"
)
SEQUENCES = [[0], [4, 3, 2, 1], [1, 2, 3, 4], [8, 7, 6, 5]]


def classroom(folder: Path, open_page: Open) -> None:
    """Take the picture of a teacher's page, with a class of thirty at work."""
    chance = random.Random(3)
    with ExitStack() as stack:
        room = ClassRoom(folder)
        stack.callback(room.close)
        for number, name in enumerate(NAMES.split()):
            student = room.student(name)
            stack.callback(student.close)
            student.until(lambda page=student: page.last(MessageKind.STUDIO).get("present"))
            table = student.sample()
            student.edits(table, sequences=SEQUENCES)
            for row in range(1, 1 + chance.randint(0, 3)):
                turned = [angle + chance.choice((0, 0, 5, -10, 15)) for angle in angles(table, row)]
                rows = [*table["rows"]]
                rows[row] = {**rows[row], "angles_deg": turned}
                table = {**table, "rows": rows}
                student.edits(table, sequences=SEQUENCES)
                student.ask("trial", table=table, sequences=SEQUENCES, keys="2")
            if number in (4, 9):
                student.ask("hand", up=True)
            if chance.random() < 0.6:
                student.ask("phase", number=chance.randint(1, 4))
        page = open_page(viewport={"width": 1280, "height": 720})
        page.goto(f"{room.url}/class#key={room.key}")
        look(page).sees(".students")
        page.wait_for_timeout(2500)  # cards glide to their places
        picture(page, "class", drawn=False)


def angles(table: dict[str, Any], row: int) -> list[float]:
    """Return the angles of a row [deg]."""
    return list(table["rows"][row]["angles_deg"])


def replay(folder: Path, open_page: Open) -> None:
    """Take the picture of a recording, in the middle of its match."""
    arena = arenas.load("othello", {"match": {"duration_s": 180}})
    setup = Setup(
        match_id="final", court="hall", match=7, arena="othello", settings=arena.settings, limits={}
    )
    bots = [
        player(arena, seat, bot, team=team)
        for seat, (bot, team) in enumerate((("planner", "Ants"), ("nearest", "Bees")))
    ]
    simulate(setup, bots, folder)
    with venue(folder) as (place, _):
        place.web("--recordings", str(folder))
        show = Show(open_page(), place.url, "/replay?file=final.mcap&t=106&cam=arena")
        show.sees(".replay-log")
        picture(show.page, "replay")


def contest(folder: Path, open_page: Open) -> None:
    """Take the pictures of a contestant's page and of the referee's page, in one match."""
    with venue(folder, "flag-strike") as (place, bot):
        court = place.court("--seconds", "180")
        place.web()
        play = Contestant(open_page, place.url, viewport=LAPTOP)
        play.page.goto(f"{place.url}/play#token={TOKENS['left']}")
        play.join(TOKENS["left"], "Ants")
        play.stands("seated")
        play.page.get_by_role("button", name="Ready").click()
        bot(court.opened["locators"][0], "right", "planner", "Bees")
        referee = open_page()
        referee.goto(f"{place.url}/referee")
        referee.locator("input[name=by]").fill("Kim")
        referee.locator("input[name=token]").fill(REFEREE)
        referee.locator(".enter button[type=submit]").click()
        Show.sees(look(referee), ".score-bug .phase", "Ready")
        referee.locator(".big").first.click()
        look(play.page).sees(".score-bug .phase", "Playing")
        play.press("2")
        play.key_stands(2)
        # Two fine pictures at once are too much for a machine without a graphics card.
        other = referee.context.new_page()
        other.bring_to_front()
        look(play.page).until(lambda: played_s(play.page) > 28, "the clock stands still")
        picture(play.page, "play")
        other.close()
        referee.bring_to_front()
        picture(referee, "referee", drawn=False)


def broadcast(folder: Path, open_page: Open) -> None:
    """Take the pictures of /overlay before a match, and of /watch and /overlay in the match."""
    with venue(folder, "othello") as (place, bot):
        court = place.court("--seconds", "180")
        place.web()
        for seat, name, team in (("left", "planner", "Ants"), ("right", "nearest", "Bees")):
            bot(court.opened["locators"][0], seat, name, team)
        first = open_page(viewport=SOURCE)
        show = Show(first, place.url, "/overlay?cam=arena&q=high")
        show.sees(".opening", "the referee starts")
        picture(first, "overlay-before")
        first.close()
        referee = place.referee()
        referee.ask("decide", decision={"type": "start"}, reason="")
        takes = (
            ("watch", "/watch?cam=arena", LAPTOP, 20),
            ("overlay", "/overlay?cam=auto&q=high", SOURCE, 35),
            ("overlay-split", "/overlay?split=1&q=high", SOURCE, 45),
        )
        for name, path, viewport, from_s in takes:
            from_ticks = 50 * from_s
            referee.wait(lambda t=from_ticks: referee.frame.clock_ticks > t, PATIENCE_S)
            page = open_page(viewport=viewport)
            Show(page, place.url, path)
            picture(page, name, moment=".third[data-seat] .gain")
            page.close()


@contextmanager
def venue(
    folder: Path, arena: str = "othello"
) -> Iterator[tuple[Venue, Callable[[str, str, str, str], None]]]:
    """Give a contest, and a function that starts a bot: (court's address, seat, bot, team)."""
    with ExitStack() as stack:
        place = Venue(folder, stack)
        place.contest.write_text(place.contest.read_text("utf-8").replace("othello", arena))

        def bot(address: str, seat: str, name: str, team: str) -> None:
            where = ("--connect", address, "--token", TOKENS[seat])
            process = subprocess.Popen(
                [*COMMAND, "bot", name, "--name", team, *where],
                stdout=subprocess.DEVNULL,
                env=environment(),
            )
            stack.callback(process.wait)
            stack.callback(process.terminate)

        yield place, bot


def look(page: Page) -> Show:
    """Return a `Show` for a page that is open already."""
    show = object.__new__(Show)
    show.page = page
    return show


def played_s(page: Page) -> float:
    """Return how many seconds the clock of a three-minute match has used."""
    minutes, seconds = page.locator(".score-bug .clock").inner_text().split(":")
    return 180 - 60 * int(minutes) - int(seconds)


def picture(page: Page, name: str, drawn: bool = True, moment: str = "main") -> None:
    """Take a picture.

    Args:
        page: the page.
        name: name of the picture.
        drawn: whether to wait until the scene is drawn in its finest quality.
        moment: selector of an element; the picture is taken when the page has it.
    """
    show = look(page)
    if drawn:
        show.until(lambda: show.view("quality") == "high", "nothing is drawn finely")
        count = show.view("drawnFrames")
        show.until(lambda: show.view("drawnFrames") > count + 1, "nothing is drawn")
    show.sees(moment)
    path = Path(__file__).with_name(f"page-{name}.png")
    page.screenshot(path=path)
    print(f"{time.strftime('%H:%M:%S')} {path.name}: {path.stat().st_size // 1024} KiB")


if __name__ == "__main__":
    main()
