"""The six phases on /design, by keyboard alone (workshop 4-2)."""

from pathlib import Path

import pytest
from chromium import OpenPage
from own_page import OwnPage
from playwright.sync_api import expect
from show import violations
from test_design import Designer, write_sample

pytestmark = pytest.mark.slow

SWUNG = ((1, 2), (1, 5), (2, 0), (2, 3), (3, 0), (3, 3), (4, 2), (4, 5))
"""Row and column of the Root angles of key 2 that are not 0 in the sample."""


class Student(Designer):
    """Somebody who has no mouse."""

    def focuses(self, selector: str) -> None:
        """Put the keyboard focus on a control of the page."""
        self.find(selector).first.focus()

    def goes_to(self, phase: int) -> None:
        self.focuses(f".phase-dots button:nth-child({phase})")
        self.press("Enter")
        expect(self.find(".learn h3")).to_contain_text(str(phase))

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
            self.page.wait_for_function(script, arg=before)

    def composes(self, text: str) -> None:
        """Type into the focused field with an input method, letter by letter, and press Enter."""
        link = self.page.context.new_cdp_session(self.page)
        for length in range(1, len(text) + 1):
            place = {"selectionStart": length, "selectionEnd": length}
            link.send("Input.imeSetComposition", {"text": text[:length], **place})
        link.send("Input.insertText", {"text": text})
        link.detach()
        self.press("Enter")

    def chooses(self, selector: str) -> None:
        """Press a button."""
        self.focuses(selector)
        self.press("Enter")

    def steers(self, key: int) -> None:
        """Try a key of level B, and wait for the trial's figures."""
        self.chooses(f".keys li:nth-child({key + 1}) button")
        trials = "window.__studio.trials.all.value.length"
        before = self.page.evaluate(trials)
        self.press("Control+Enter")
        self.until(f"{trials} > {before}")

    def is_done(self, phase: int) -> None:
        dot = self.find(f".phase-dots button:nth-child({phase})")
        expect(dot).to_have_attribute("data-state", "met")


@pytest.mark.long
def test_six_phases_are_done_by_keyboard(
    open_page: OpenPage, tmp_path: Path, built_pages: Path
) -> None:
    """A student completes all phases with the keyboard alone, and types with an input method."""
    write_sample(tmp_path)
    with OwnPage(tmp_path, "design") as command:
        url, key = command.url, command.key
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

        page.goes_to(3)
        page.chooses(".learn button:has-text('A1, A2')")
        page.is_done(3)

        page.goes_to(4)
        page.focuses(".cell-input")
        for row, col in SWUNG:  # shorter steps
            page.press("Control+Home", *["ArrowDown"] * row, *["ArrowRight"] * col)
            before = page.cell(row, col)
            page.composes("２０" if before == "45" else "ー２０")
            page.cell_is(row, col, before.replace("45", "20"))
        page.steers(2)
        page.is_done(4)

        page.goes_to(5)
        page.focuses(".learn form input")
        page.composes("静か")
        page.sees(".learn legend", "静か")
        page.chooses(".learn .foot-guess button:nth-of-type(2)")
        page.is_done(5)

        page.goes_to(6)
        page.chooses(".learn button:text-is('Check the table')")
        page.is_toasted("No mistakes")
        for key in (0, 1, 3):
            page.steers(key)
        page.is_done(6)
        page.page.close()
