"""Opens the page /film in its own Chromium, lets it show a beat, and takes its picture."""

import base64
import os
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path

from playwright.sync_api import (
    Browser,
    BrowserContext,
    Error,
    Page,
    Playwright,
    TimeoutError,
    sync_playwright,
)

from lacoc_client.film.chromium import FLAGS, find
from lacoc_client.film.look import Look
from lacoc_client.film.plan import Picture
from lacoc_client.film.shots import PNG, Shots
from lacoc_client.play.stopping import unreached
from lacoc_shared.command.scratch import Scratch
from lacoc_shared.mistakes import UserError, printable
from lacoc_shared.words import say

_STARTING = threading.Lock()
_TEMPORARY = ("TMPDIR", "TEMP", "TMP")
"""Environment variables that name the folder for temporary files; each system has one of them."""
_WAIT_S = 120.0
"""Longest wait for the page [s]: a slow machine loads it and compiles its shaders for many
seconds."""
_LOOK_S = 0.02
PACED = ("--enable-begin-frame-control", "--run-all-compositor-stages-before-draw")
"""Options with which `chromium-headless-shell` draws a page only when it is told to."""
# A string that the page evaluates by itself would need a weaker content security policy: the
# protocol of the browser's developer tools does it from outside.
_OPEN = """() => {
  const open = async () => {
    while (!window.__film) await new Promise((resolve) => setTimeout(resolve, 20));
    const ends = await window.__film.open();
    window.__opened = [...ends, window.__film.quality()];
  };
  open().catch((error) => { window.__opened = String(error); });
}"""
_OPENED = "window.__opened"
_SOUND = "({ steps, fps, rate }) => window.__film.sound(steps, fps, rate)"
_SHOW = "(steps) => window.__film.show(steps)"
_SHOW_AND_HAND_OVER = """async (steps) => {
  await window.__film.show(steps);
  await new Promise(requestAnimationFrame);
}"""


class CameraPage:
    """The page of a record, open in a browser; only the thread that opened it may use it.

    Args:
        page: an empty page.
        address: address of the page of a record.
        paced: whether the browser makes a frame only at `HeadlessExperimental.beginFrame`.
    """

    def __init__(self, page: Page, address: str, paced: bool) -> None:
        self._page = page
        self.shots = Shots(page, paced)
        """Takes pictures of the page."""
        page.goto(address, wait_until="commit")
        first, last, quality = self._opened()
        self.quality: str = quality
        """How the page draws: "low" or "high", or "map" without WebGL."""
        self.first, self.last = int(first), int(last)
        """First and last beat that a replay of the record shows."""

    def picture(self, steps: Sequence[Picture]) -> bytes:
        """Let the page go through some pictures of the film, and return the last one as PNG.

        Args:
            steps: all pictures since the last call, in order: the page goes through each, so that
                moving parts and the automatic camera are where they must be in the last.
        """
        told = [{"beat": step.beat, "cut": step.cut} for step in steps]
        self._page.evaluate(_SHOW if self.shots.paced else _SHOW_AND_HAND_OVER, told)
        return self.shots.take(PNG)

    def sound(self, pictures: Sequence[Picture], fps: int, rate_hz: int) -> bytes:
        """Return the sound of all pictures of a film.

        Returns:
            Samples of the left and the right side in turn, each with 16 bits, little endian.
        """
        told = [{"beat": one.beat, "cut": one.cut} for one in pictures]
        wanted = {"steps": told, "fps": fps, "rate": rate_hz}
        return base64.b64decode(self._page.evaluate(_SOUND, wanted))

    def _opened(self) -> tuple[int, int, str]:
        """Wait until the opened page can show the record.

        Return first beat, last beat, and how the page draws.
        """
        self._page.evaluate(_OPEN)
        end_s = time.monotonic() + _WAIT_S
        while time.monotonic() < end_s:
            if found := self._page.evaluate(_OPENED):
                if isinstance(found, str):
                    raise Error(found)
                first, last, quality = found
                return first, last, quality
            if self.shots.paced:
                self.shots.frame()
            time.sleep(_LOOK_S)
        raise TimeoutError(f"the page did not open in {_WAIT_S:.0f} s")


@contextmanager
def camera_page(address: str, look: Look) -> Iterator[CameraPage]:
    """Open the page of a record in a new browser, until the `with` block ends.

    Args:
        address: the page's address.
        look: how the page looks; the window has its size.

    Raises:
        UserError: if there is no browser, it does not start, or the page can't show the record.
    """
    try:
        with window(look) as (page, paced):
            yield CameraPage(page, address, paced)
    except Error as error:
        raise UserError(say("film.page-failed", error=told(error))) from None


@contextmanager
def window(look: Look) -> Iterator[tuple[Page, bool]]:
    """Open an empty page in a new browser, until the `with` block ends.

    Args:
        look: the window has its size.

    Yields:
        The page, and whether its frames are made only when they are asked for.

    Raises:
        UserError: if there is no browser, or it does not start.
        Error: if it fails while the block runs.
    """
    with Scratch("browser") as folder, _started(folder) as playwright:
        program = find(playwright.chromium.executable_path)
        browser = _launched(playwright, program)
        try:
            context = browser.new_context(
                viewport={"width": look.width, "height": look.height},
                device_scale_factor=1,
                reduced_motion="no-preference",  # else the automatic camera would stand still
            )
            context.set_default_timeout(1000 * _WAIT_S)
            yield empty_page(browser, context, look)
        finally:
            browser.close()


def empty_page(browser: Browser, context: BrowserContext, look: Look) -> tuple[Page, bool]:
    """Open an empty page; return it, and whether its frames are made only when they are asked for.

    Only the old headless mode of Chromium makes frames on request; it is a separate program now.
    """
    tools = browser.new_browser_cdp_session()
    (own,) = tools.send("Target.getBrowserContexts")["browserContextIds"]
    wanted = {"width": look.width, "height": look.height, "enableBeginFrameControl": True}
    try:
        with context.expect_page() as opened:
            made = {"url": "about:blank", "browserContextId": own, **wanted}
            tools.send("Target.createTarget", made)
        context.new_cdp_session(opened.value).send("HeadlessExperimental.enable")
    except Error:
        return context.new_page(), False
    return opened.value, True


@contextmanager
def _started(folder: Path) -> Iterator[Playwright]:
    """Start Playwright, with a given folder for its temporary files.

    If this process is killed, Playwright leaves the browser's profile in that folder.
    """
    with ExitStack() as stack:
        with _STARTING:  # the environment is that of all threads
            before = {name: os.environ.get(name) for name in _TEMPORARY}
            os.environ.update(dict.fromkeys(_TEMPORARY, str(folder)))
            try:
                with unreached():
                    playwright = stack.enter_context(sync_playwright())
            finally:
                for name, value in before.items():
                    if value is None:
                        del os.environ[name]
                    else:
                        os.environ[name] = value
        yield playwright


def _launched(playwright: Playwright, program: str) -> Browser:
    try:
        return playwright.chromium.launch(
            executable_path=program,
            # A part of the page that is painted again alone can differ in a last bit.
            args=[*FLAGS, *PACED, "--disable-partial-raster"],
            handle_sigint=False,  # the command ends the browser itself
            handle_sigterm=False,
            handle_sighup=False,
        )
    except Error as error:
        raise UserError(say("film.browser-failed", program=program, error=told(error))) from None


def told(error: Error) -> str:
    """Return the first line of a browser's error."""
    return printable(error.message.partition("\n")[0], 200)
