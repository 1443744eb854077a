"""The six phases on /design, by keyboard alone (workshop 4-2)."""

from pathlib import Path

import pytest
from chromium import OpenPage
from contestant import own_page
from playwright.sync_api import expect
from show import violations
from test_design import TIMEOUT_MS, Designer, write_sample

pytestmark = pytest.mark.slow


class Student(Designer):
    """Somebody who has no mouse."""

    def focuses(self, selector: str) -> None:
        """Put the keyboard focus on a control of the page."""
        self.find(selector).first.focus()

    def goes_to(self, phase: int) -> None:
        self.focuses(f".phase-dots button:nth-child({phase})")
        self.press("Enter")
        expect(self.find(".learn h3")).to_contain_text(str(phase), timeout=TIMEOUT_MS)

    def changes(self, text: str, *, guess: str = "") -> None:
        """Change the selected number; with `guess`, first guess where the foot goes."""
        if guess:
            self.focuses(f".foot-guess button:text-is('{guess}')")
            self.press("Enter")
            self.sees(".foot-guess p", "Now change")
        before = self.page.evaluate("window.__studio.learning.phases.value.phases[0].share")
        self.focuses(".cell-input")
        self.page.keyboard.type(text)
        self.press("Enter")
        self.press("ArrowUp")
        if guess:
            self.sees(".foot-guess .verdict.right, .foot-guess .verdict.wrong")
        else:
            script = "before => window.__studio.learning.phases.value.phases[0].share > before"
            self.page.wait_for_function(script, arg=before, timeout=TIMEOUT_MS)

    def is_done(self, phase: int) -> None:
        dot = self.find(f".phase-dots button:nth-child({phase})")
        expect(dot).to_have_attribute("data-state", "met", timeout=TIMEOUT_MS)


def test_two_phases_are_done_by_keyboard(
    open_page: OpenPage, tmp_path: Path, built_pages: Path
) -> None:
    """A student completes phases 1 and 2 with the keyboard alone, and may open any other phase."""
    write_sample(tmp_path)
    with own_page(tmp_path, "design") as (url, key):
        page = Student(open_page, url, viewport={"width": 1280, "height": 800})
        page.begin(key)
        page.goes_to(1)
        page.focuses(".cell-input")
        page.press("Control+Home")
        page.changes("-30", guess="back")
        page.sees(".foot-guess .verdict.right", "right")
        page.changes("30", guess="back")
        page.sees(".foot-guess .verdict.wrong", "forward")
        page.changes("-20", guess="back")
        for _ in range(6):
            page.press("ArrowRight")
        page.changes("50")
        page.changes("35")
        for _ in range(6):
            page.press("ArrowRight")
        page.changes("40")
        page.is_done(1)
        assert not violations(page.page)

        page.goes_to(2)
        page.focuses(".learn button:has-text('A1')")
        page.press("Enter")
        page.is_done(2)
        page.goes_to(6)
        page.goes_to(2)
        expect(page.find(".phase-dots button:nth-child(5)")).to_have_attribute(
            "data-state", "skipped"
        )
        page.page.close()
