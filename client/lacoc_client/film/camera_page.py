"""The page /film in a Chromium of its own: it is told a beat, and gives the picture of it."""

import base64
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from playwright.sync_api import Browser, Error, Page, Playwright, sync_playwright

from lacoc_client.film.chromium import FLAGS, find
from lacoc_client.film.look import Look
from lacoc_client.film.plan import Picture
from lacoc_shared.mistakes import UserError, printable
from lacoc_shared.words import say

_WAIT_MS = 120_000
"""A slow machine loads the page and compiles its shaders for many seconds."""
# A string that the page evaluates by itself would need a weaker content security policy: the
# protocol of the browser's developer tools does it from outside.
_OPEN = """async () => {
  while (!window.__film) await new Promise((resolve) => setTimeout(resolve, 20));
  const ends = await window.__film.open();
  return [...ends, window.__film.quality()];
}"""
_SHOW = "(steps) => window.__film.show(steps)"


class CameraPage:
    """An open page; only the thread that opened it may use it.

    Args:
        page: the page of a record, which has loaded.
    """

    def __init__(self, page: Page) -> None:
        self._page = page
        self._tools = page.context.new_cdp_session(page)
        first, last, quality = page.evaluate(_OPEN)
        self.quality: str = quality
        """How the page draws: "low" or "high", or "map" without WebGL."""
        self.first, self.last = int(first), int(last)
        """Where a replay of the record begins and ends, as beats."""

    def picture(self, steps: Sequence[Picture]) -> bytes:
        """Go through some pictures, and return the last one as PNG.

        Args:
            steps: all pictures since the last call, in order: the page goes through each, so that
                moving parts and the automatic camera are where they must be in the last.
        """
        told = [{"beat": step.beat, "cut": step.cut} for step in steps]
        self._page.evaluate(_SHOW, told)
        # The screenshot of Playwright waits for fonts and hides a caret, each time.
        shot = self._tools.send(
            "Page.captureScreenshot", {"format": "png", "optimizeForSpeed": True}
        )
        return base64.b64decode(shot["data"])


@contextmanager
def camera_page(address: str, look: Look) -> Iterator[CameraPage]:
    """Open the page of a record in a new browser; the browser ends with the block.

    Args:
        address: the page's address.
        look: how the page looks; the window has its size.

    Raises:
        UserError: if there is no browser, it does not start, or the page can't show the record.
    """
    with sync_playwright() as playwright:
        program = find(playwright.chromium.executable_path)
        browser = _launched(playwright, program)
        try:
            page = browser.new_page(
                viewport={"width": look.width, "height": look.height},
                device_scale_factor=1,
                reduced_motion="no-preference",  # else the automatic camera would stand still
            )
            page.set_default_timeout(_WAIT_MS)
            page.goto(address)
            yield CameraPage(page)
        except Error as error:
            raise UserError(say("film.page-failed", error=_told(error))) from None
        finally:
            browser.close()


def _launched(playwright: Playwright, program: str) -> Browser:
    try:
        return playwright.chromium.launch(
            executable_path=program,
            # A part of the page that is painted again alone can differ in a last bit.
            args=[*FLAGS, "--disable-partial-raster"],
            handle_sigint=False,  # the command ends the browser itself
            handle_sigterm=False,
            handle_sighup=False,
        )
    except Error as error:
        raise UserError(say("film.browser-failed", program=program, error=_told(error))) from None


def _told(error: Error) -> str:
    return printable(error.message.partition("\n")[0], 200)
