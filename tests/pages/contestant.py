"""A contestant's page in a browser: what a person does with the page and sees on it."""

import re
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from chromium import OpenPage
from playwright.sync_api import Locator, Page, expect
from waiting import LIMIT_S

from lacoc_shared.seat import Phase

PASSING = """
window.__toasts = [];
new MutationObserver((changes) => {
  for (const { addedNodes } of changes)
    for (const node of addedNodes)
      if (node instanceof Element)
        window.__toasts.push(
          ...(node.matches(".toast") ? [node] : node.querySelectorAll(".toast")),
        );
}).observe(document, { childList: true, subtree: true });
window.__shown = { next: [], phase: [] };
new MutationObserver(() => {
  const next = document.querySelector(".next");
  const phase = document.querySelector(".score-bug .phase");
  for (const [name, element, value] of [
    ["next", next, next?.textContent],
    ["phase", phase, phase?.dataset.phase],
  ])
    if (element?.checkVisibility() && window.__shown[name].at(-1) !== value)
      window.__shown[name].push(value);
}).observe(document, {
  attributes: true, characterData: true, childList: true, subtree: true,
});
"""
"""Keeps what a page shows for a moment: a busy test may look when it has gone again."""
_TOASTED = """(text) => {
  const at = window.__toasts.findIndex((toast) => toast.textContent.includes(text));
  return at >= 0 && Boolean(window.__toasts.splice(0, at + 1));
}"""
_SHOWN = """([name, value]) => {
  const all = window.__shown[name];
  // The first was waited for before: it counts while the page still shows it.
  const at = all.findIndex((one, at) => one.includes(value) && (at > 0 || all.length === 1));
  return at >= 0 && Boolean(all.splice(0, at));
}"""


class Contestant:
    """A contestant's page in a browser profile of its own.

    Args:
        open_page: function that opens a page.
        url: address of the gateway.
        options: settings of the profile, such as `locale`, `viewport` or `has_touch`.
    """

    def __init__(self, open_page: OpenPage, url: str, **options: Any) -> None:
        settings: dict[str, Any] = {"viewport": {"width": 1000, "height": 700}}
        self.url = url
        self.page: Page = open_page(**settings | options)
        self.page.add_init_script(PASSING)

    def open(
        self, path: str = "/play", key: str | None = None, query: str = "", token: str = ""
    ) -> None:
        """Go to a path of the gateway, with the page key of its owner or with a token."""
        fragment = f"#token={token}" if token else "" if key is None else f"#key={key}"
        self.page.goto(f"{self.url}{path}?q=low{query}{fragment}")

    def find(self, selector: str) -> Locator:
        return self.page.locator(selector)

    def sees(self, selector: str, text: str | None = None) -> None:
        """Wait until an element is visible and contains the text."""
        found = self.find(selector).first
        expect(found).to_be_visible()
        if text is not None:
            expect(found).to_contain_text(text)

    def sees_text(self, selector: str, text: str) -> None:
        """Wait until an element that nobody needs to see contains the text."""
        expect(self.find(selector).first).to_contain_text(text)

    def misses(self, selector: str) -> None:
        """Wait until no element matches the selector."""
        expect(self.find(selector)).to_have_count(0)

    def is_told(self, text: str) -> None:
        """Wait until the line about the next step has a text, or has had it since the last."""
        self._has_shown("next", text)

    def is_toasted(self, text: str) -> None:
        """Wait for a toast (a short note) with the text, later than those waited for before."""
        self.page.wait_for_function(_TOASTED, arg=text)

    def stands(self, how: str) -> None:
        """Wait until the page is in the state `how`: seated, outside, lost, left or watching."""
        self.sees(f"main[data-standing={how}]")

    def phase(self, phase: Phase) -> None:
        """Wait until the page shows a phase, or has shown it since the last one waited for."""
        self._has_shown("phase", str(int(phase)))

    def join(self, token: str, name: str = "Ants") -> None:
        """Type the token if the page asks for it; fill in the name and sit down."""
        self.sees("#team-token, #join-name")
        if self.find("#team-token").count():
            self.page.fill("#team-token", token)
            self.page.click("button[type=submit]")
        self.sees(".own-seat")
        self.page.fill("#join-name", name)
        self.page.click("button[type=submit]")

    def _has_shown(self, name: str, value: str) -> None:
        self.page.wait_for_function(_SHOWN, arg=[name, value])

    def press(self, *keys: str) -> None:
        for key in keys:
            self.page.keyboard.press(key)

    def has_field(self) -> None:
        """Wait until the field has the focus, so that Tab and Space belong to the game."""
        self.sees(".field3d:focus")

    def steer(self, digit: int) -> None:
        """Press a key until it takes effect: the first press may still be for the match before."""
        standing = self.find(f'.key[data-key="{digit}"][aria-pressed=true]')
        end_s = time.monotonic() + LIMIT_S
        while not standing.count():
            assert time.monotonic() < end_s, f"key {digit} has no effect"
            self.press(str(digit))
            self.page.wait_for_timeout(300)

    def key_stands(self, digit: int) -> None:
        """Wait until the pad on the page shows that this key is in effect."""
        self.sees(f'.key[data-key="{digit}"][aria-pressed=true]')

    def until(self, condition: str) -> None:
        """Wait until a JavaScript expression is true.

        Playwright's `wait_for_function` does not work here: the pages' policy forbids it.
        """
        end_s = time.monotonic() + LIMIT_S
        while not self.page.evaluate(condition):
            assert time.monotonic() < end_s, condition
            self.page.wait_for_timeout(40)

    def download(self, act: Callable[[], None], folder: Path) -> tuple[str, str]:
        """Do something that downloads a file, and return the file's name and text."""
        with self.page.expect_download() as coming:
            act()
        path = folder / "download"
        coming.value.save_as(path)
        return coming.value.suggested_filename, path.read_text(encoding="utf-8")

    def number(self, selector: str) -> float:
        """Return the first number in the text of an element."""
        text = self.find(selector).first.inner_text().replace("−", "-")
        found = re.search(r"-?\d+(\.\d+)?", text)
        assert found is not None, text
        return float(found[0])


Sit = Callable[..., Contestant]
"""A function that makes a contestant's page for a gateway: `sit(url, locale="ja-JP")`."""
