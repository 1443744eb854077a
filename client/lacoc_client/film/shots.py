"""Takes pictures of an open page, one by one."""

import base64
from typing import Any

from playwright.sync_api import Error, Page

_FRAMES_MOST = 10
"""How many frames to ask for at most: a browser may give no picture for a frame that it has not
drawn yet."""
PNG: dict[str, Any] = {"format": "png", "optimizeForSpeed": True}
JPEG: dict[str, Any] = {"format": "jpeg", "quality": 95}


class Shots:
    """Takes pictures of one page; only the thread that opened the page may use it.

    `chromium-headless-shell` draws the page once for each picture, when it is told to. Other
    browsers also draw it whenever they show a frame, which takes a quarter more time.

    Args:
        page: the page.
        paced: whether the browser makes a frame only at `HeadlessExperimental.beginFrame`.
    """

    def __init__(self, page: Page, paced: bool) -> None:
        self.paced = paced
        """Whether the browser makes frames only on request."""
        self._tools = page.context.new_cdp_session(page)

    def take(self, how: dict[str, Any]) -> bytes:
        """Return a picture of the page as it is now.

        Args:
            how: `PNG` or `JPEG`.
        """
        return base64.b64decode(self._framed(how) if self.paced else self._screenshot(how))

    def frame(self, **wanted: Any) -> dict[str, Any]:
        """Let the browser draw the page once; return the reply of its DevTools."""
        found: dict[str, Any] = self._tools.send("HeadlessExperimental.beginFrame", wanted)
        return found

    def _framed(self, how: dict[str, Any]) -> str:
        for _ in range(_FRAMES_MOST):
            if found := self.frame(screenshot=how).get("screenshotData"):
                return str(found)
        raise Error(f"{_FRAMES_MOST} frames without a picture")

    def _screenshot(self, how: dict[str, Any]) -> str:
        # The screenshot of Playwright waits for fonts and hides a caret, each time.
        return str(self._tools.send("Page.captureScreenshot", how)["data"])
