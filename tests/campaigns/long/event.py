"""Plays an event of eight teams as people do: from an empty folder to standings that are verified.

    python -m tests.campaigns.long.event

The organiser uses only what docs/contest-day.md says: two commands, then the page /office in a
browser. Each command and click is counted until the first game begins. The teams enter by page.
Then six of them play in browsers of their own, and two with `lacoc play` at a terminal; their keys
are drawn by chance. The groups have no referee. In the finals the referees of two courts start
each game and make its result official, on their pages. When the bracket is over, a process that
knows nothing of the event verifies what was published.

Only times are shorter than in the file that `lacoc contest init` writes (`_SHORT`).
"""

import random
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import Any

from arguments import arguments
from chromium import SLOW_SCREEN, chromium
from lacoc_process import contest_run
from playwright.sync_api import Browser, Locator, Page, TimeoutError
from ports import free_port
from processes import LACOC, hush, started

from lacoc_robots.library import sample_gait_files
from lacoc_server.contest.acts import organiser
from lacoc_shared.seat import Phase

TEAMS = ("Ants", "六脚の会", "Crabs & Co", "Dogs", "Eels", "Foxes", "Gnus", "Hens")
_AT_A_TERMINAL = TEAMS[-2:]
_JAPANESE, _PHONE = TEAMS[1], TEAMS[2]
_KEYS = "22222213"
"""Keys to draw from: most walk forward, so that robots come to the discs of the others."""
_WAIT_S = 120.0
_WHOLE_S = 1800.0
_LOOK_S = 0.2
_READY = 'settings.match.start = "ready"'
_SHORT = "settings.match = { duration_s = %s, countdown_s = 1.0%s }"


def main() -> int:
    """Play the event; print what was counted, and return 0 if everything held."""
    options = arguments(
        __doc__,
        seconds=(20.0, "of play, each game"),
        pictures=(Path, "folder for pictures of the pages"),
    )
    with tempfile.TemporaryDirectory() as name, chromium() as browser, ExitStack() as stack:
        event = Event(Path(name), browser, stack, options.pictures)
        found = event.held(options.seconds)
    print(found)
    return int(found["verify"] != 0 or found["steps"] > 10 or not found["over"])


class Event:
    """An event, and everybody who takes part.

    Args:
        folder: an empty folder.
        browser: runs all pages.
        stack: ends what was started.
        pictures: folder for pictures of the pages; None: none are made.
    """

    def __init__(
        self, folder: Path, browser: Browser, stack: ExitStack, pictures: Path | None
    ) -> None:
        self._folder = folder
        self._file = folder / "contest.toml"
        self._browser = browser
        self._stack = stack
        self._pictures = pictures
        self._steps: list[str] = []
        """What the organiser did until the first game began."""
        self._errors: list[str] = []

    def held(self, seconds: float) -> dict[str, Any]:
        """Hold the event; return what was counted."""
        begun_s = time.monotonic()
        self._step("lacoc contest init --courts 2")
        _lacoc(self._folder, "contest", "init", "--courts", "2")
        self._step("edit contest.toml")
        self._shorten(seconds)
        self._step("lacoc contest run --entries")
        run = self._stack.enter_context(contest_run(self._file, "--entries"))
        opened = run.opened
        run.hush()
        self._step("open the link of /office")
        office = self._page({"width": 1366, "height": 768})
        office.goto(opened["office"])
        referees = self._referees(office)
        entered = [self._entered(opened, team) for team in TEAMS]
        self._click(office.get_by_role("button", name=f"Approve all {len(TEAMS)}"))
        self._click(office.get_by_role("button", name="Close entries and draw"))
        self._picture(office, "office-close")
        self._click(office.get_by_role("button", name=f"Close and draw with {len(TEAMS)} teams"))
        steps = len(self._steps)
        drawn_s = time.monotonic()
        people = {"office": (office, _idles())}
        people |= {f"referee-{one}": (page, _judges(page)) for one, page in enumerate(referees)}
        for number, (page, team) in enumerate(zip(entered, TEAMS, strict=True)):
            if self._goes_to_play(page, team):
                people[f"play-{number}"] = (page, _plays(page, random.Random(team)))
        people["contest"] = (self._screen(opened["url"]), _idles())
        self._play(people)
        ended_s = time.monotonic()
        return {
            "steps": steps,
            "done": self._steps,
            "to the draw [s]": round(drawn_s - begun_s),
            "played [s]": round(ended_s - drawn_s),
            "errors in consoles": self._errors,
            **self._proof(),
        }

    def _shorten(self, seconds: float) -> None:
        """Make the games short, let referees judge the finals, and use free ports."""
        groups, last = _SHORT % (seconds, ', start = "ready"'), _SHORT % (seconds, "")
        text = self._file.read_text("utf-8")
        text = text.replace(_READY, groups, 1).replace(_READY, last, 1)
        text = text.replace("least_rest_s = 60", "least_rest_s = 5")
        for port in ("7447", "7448"):
            text = text.replace(f"0.0.0.0:{port}", f"127.0.0.1:{free_port()}")
        self._file.write_text(text, "utf-8")

    # The organiser

    def _step(self, what: str) -> None:
        self._steps.append(what)

    def _click(self, button: Locator) -> None:
        self._step(f"click {button.inner_text()!r}")
        button.click()

    # The others

    def _page(self, viewport: dict[str, int], **options: Any) -> Page:
        options.setdefault("locale", "en-GB")
        context = self._browser.new_context(viewport=viewport, **options)
        self._stack.callback(context.close)
        context.add_init_script(SLOW_SCREEN)
        context.set_default_timeout(1000 * _WAIT_S)
        page = context.new_page()
        page.on("pageerror", lambda error: self._errors.append(str(error)))
        return page

    def _entered(self, opened: dict[str, Any], team: str) -> Page:
        """Let a team enter from a browser of its own; return its page."""
        size = {"width": 390, "height": 844} if team == _PHONE else {"width": 1000, "height": 700}
        page = self._page(size, locale="ja-JP" if team == _JAPANESE else "en-GB")
        page.goto(f"{opened['url']}/enter")
        page.locator("input.code").fill(opened["code"])
        page.locator(".field input").nth(1).fill(team)
        files = [
            {"name": one.name, "mimeType": "text/plain", "buffer": one.data}
            for one in sample_gait_files("hexapod")
            if one is not None
        ]
        page.locator("input[type=file]").set_input_files(files)  # type: ignore[arg-type]
        page.locator("button[type=submit]").click()
        page.locator(".qr img").wait_for()
        if team in (_PHONE, _JAPANESE):
            self._picture(page, f"enter-{TEAMS.index(team)}")
        return page

    def _goes_to_play(self, page: Page, team: str) -> bool:
        """Let a team go to its matches; return whether it plays in its browser."""
        if team not in _AT_A_TERMINAL:
            page.locator(".qr a").click()
            return True
        link = page.evaluate("document.querySelector('.qr a').href")
        page.close()
        terminal = started(LACOC, "play", link, "--terminal", "--ready")
        process = self._stack.enter_context(terminal)
        hush(process)
        assert process.stdin is not None
        keys = random.Random(team).choices(_KEYS, k=4000)
        process.stdin.write("".join(f"0.5 {key}\n" for key in keys))
        process.stdin.flush()
        return False

    def _referees(self, office: Page) -> list[Page]:
        """Print the links on /office, and let the referee of each court open theirs."""
        self._step("choose the links under Print")
        office.get_by_label("Print …").select_option("links")
        cards = office.locator(".card-of-paper .address", has_text="/referee?")
        cards.first.wait_for()
        self._picture(office, "office-links")
        links = cards.all_inner_texts()
        self._click(office.get_by_role("button", name="Print"))
        self._click(office.get_by_role("button", name="Back"))
        pages = []
        for link in links:
            page = self._page({"width": 1366, "height": 768})
            page.goto(link)
            page.locator("input[name=by]").fill("Kim")
            page.locator(".enter button[type=submit]").click()
            page.locator(".acting.mine").wait_for()
            pages.append(page)
        return pages

    def _screen(self, url: str) -> Page:
        """Open the page for everybody on a large screen."""
        page = self._page({"width": 1920, "height": 1080})
        page.goto(f"{url}/contest")
        return page

    def _play(self, people: dict[str, tuple[Page, Iterator[None]]]) -> None:
        """Let everybody act in turns, until the contest is over."""
        begun_s = time.monotonic()
        pictures = [20.0, 100.0, 200.0, 300.0]
        while not _is_over(self._file):
            at_s = time.monotonic() - begun_s
            assert at_s < _WHOLE_S, "the contest does not end"
            if pictures and at_s > pictures[0]:
                for name, (page, _) in people.items():
                    self._picture(page, f"{name}-{pictures[0]:.0f}")
                del pictures[0]
            for _, one in people.values():
                next(one)
            people["office"][0].wait_for_timeout(1000 * _LOOK_S)
        people["office"][0].wait_for_timeout(10_000)  # all pages show the end
        for name, (page, _) in people.items():
            self._picture(page, f"{name}-over")

    def _picture(self, page: Page, name: str) -> None:
        if self._pictures is not None:
            self._pictures.mkdir(parents=True, exist_ok=True)
            page.screenshot(path=self._pictures / f"{name}.png")

    def _proof(self) -> dict[str, Any]:
        """Publish the contest, and verify it in a new process."""
        folder = self._folder / "cup"
        _lacoc(self._folder, "contest", "publish", str(folder))
        words = (sys.executable, "-m", LACOC, "contest", "verify", str(folder))
        verified = subprocess.run(words, cwd="/", capture_output=True, text=True, check=False)
        print(verified.stdout)
        return {
            "over": _is_over(self._file),
            "games": len(list((folder / "records").glob("*.mcap"))),
            "verify": verified.returncode,
        }


def _is_over(file: Path) -> bool:
    """Return whether all stages are played to their end."""
    sheet = organiser.sheet(file)
    return bool(sheet.stages) and not sheet.planned and all(view.over for view in sheet.stages)


def _lacoc(folder: Path, *words: str) -> str:
    """Run a command; return what it prints."""
    command = (sys.executable, "-m", LACOC, *words)
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"{words}: {done.stderr}")
    return done.stdout


def _idles() -> Iterator[None]:
    """Look on."""
    while True:
        yield


def _plays(page: Page, chance: random.Random) -> Iterator[None]:
    """Say ready before each game, and press keys while it is played."""
    ready = page.locator("button.ready:enabled")
    playing = page.locator(f'.score-bug .phase[data-phase="{int(Phase.PLAYING)}"]')
    while True:
        if not _pressed(ready) and playing.count():
            page.keyboard.press(chance.choice(_KEYS))
        yield


def _judges(page: Page) -> Iterator[None]:
    """Start each game, and make its result official."""
    able = ":not([aria-disabled=true])"
    step = page.locator(f".big:not(.fresh) :is(.start, .official){able}")
    confirm = page.get_by_role("dialog").locator("[type=submit]")
    while True:
        _pressed(confirm) or _pressed(step)
        yield


def _pressed(button: Locator) -> bool:
    """Click a button if it is there, and return whether it was; it may go at any moment."""
    if not button.count():
        return False
    with suppress(TimeoutError):
        button.click(timeout=1000)
    return True


if __name__ == "__main__":
    sys.exit(main())
