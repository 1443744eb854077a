"""The phases on /design, by keyboard alone (workshop 4-2)."""

from pathlib import Path

import pytest
from chromium import OpenPage
from own_page import OwnPage
from playwright.sync_api import expect
from show import violations
from test_design import Designer

pytestmark = pytest.mark.slow

SWUNG = ((1, 2), (1, 5), (2, 0), (2, 3), (3, 0), (3, 3), (4, 2), (4, 5))
"""Row and column of the Root angles of key 2 that are not 0 in the sample."""
LIFTED = (12, 14, 16)
"""Columns of the 2nd joints of every other leg."""


class Student(Designer):
    """Somebody who has no mouse."""

    def focuses(self, selector: str) -> None:
        """Put the keyboard focus on a control of the page."""
        self.find(selector).first.focus()

    def goes_to(self, phase: int) -> None:
        self.focuses(f".phase-dots button:nth-child({phase + 1})")
        self.press("Enter")
        expect(self.find(".learn h3")).to_contain_text(str(phase))

    def changes(self, text: str, *, guess: str = "") -> None:
        """Change the selected number; with `guess`, first guess where the foot goes."""
        if guess:
            self.focuses(f".foot-guess button:text-is('{guess}')")
            self.press("Enter")
            self.sees(".foot-guess p", "Now change")
        before = self.page.evaluate("window.__studio.learning.phases.value.phases[1].share")
        self.focuses(".cell-input")
        self.page.keyboard.type(text)
        self.press("Enter")
        self.press("ArrowUp")
        if guess:
            self.sees(".foot-guess .verdict.right, .foot-guess .verdict.wrong")
        else:
            script = "before => window.__studio.learning.phases.value.phases[1].share > before"
            self.page.wait_for_function(script, arg=before)

    def goes_over(self, row: int, col: int) -> None:
        """Select a cell with the arrow keys."""
        self.focuses(".cell-input")
        self.press("Control+Home", *["ArrowDown"] * row, *["ArrowRight"] * col)

    def fills(self, row: int, col: int, text: str) -> None:
        """Type a number into a cell, and wait until the gateway has it."""
        self.goes_over(row, col)
        self.page.keyboard.type(text)
        self.press("Enter")
        self.cell_is(row, col, text)
        self.until("window.__studio.learning.isTold.value")

    def answers(self, text: str) -> None:
        """Choose an answer to the question of the phase, and wait until it was judged."""
        self.focuses(f".phase-question button:has-text('{text}')")
        self.press("Enter")
        self.sees(".phase-verdict.right, .phase-verdict.wrong")

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
        dot = self.find(f".phase-dots button:nth-child({phase + 1})")
        expect(dot).to_have_attribute("data-state", "met")


@pytest.mark.long
def test_six_phases_are_done_by_keyboard(
    open_page: OpenPage, tmp_path: Path, built_pages: Path
) -> None:
    """A student completes phases 1 to 6 with the keyboard alone, and types with an input method.

    The page begins with a new table. After phase 4 the sample is the reward.
    """
    with OwnPage(tmp_path, "design") as command:
        url, key = command.url, command.key
        page = Student(open_page, url, viewport={"width": 1280, "height": 800})
        page.begin(key)
        page.cell_is(1, 0, "45")
        page.goes_to(1)
        page.goes_over(1, 0)
        page.changes("15", guess="back")
        page.sees(".foot-guess .verdict.right", "right")
        page.goes_over(1, 6)
        page.changes("50", guess="up")
        page.goes_over(1, 12)
        page.changes("40", guess="inward")
        page.sees(".foot-guess .verdict.wrong", "up")
        page.changes("20")
        page.goes_over(1, 6)
        page.changes("30")
        page.goes_over(1, 0)
        page.changes("45")
        page.sees(".phase-question", "Leg L,F")
        assert not violations(page.page)
        page.answers("up")
        page.is_done(1)
        assert not violations(page.page)

        page.goes_to(2)
        for col in LIFTED:
            page.fills(1, col, "45")
        page.fills(1, 3, "0")
        page.fills(1, 6, "20")
        page.chooses(".learn button:has-text('(A1)')")
        page.answers("inside the nearest edge")
        page.is_done(2)
        page.goes_to(6)
        page.goes_to(2)
        expect(page.find(".phase-dots button:nth-child(6)")).to_have_attribute(
            "data-state", "skipped"
        )

        page.goes_to(3)
        for col in LIFTED:
            page.fills(2, col, "45")
        page.fills(2, 5, "0")
        page.chooses(".learn button:has-text('(A1, A2)')")
        page.answers('"R,C", "L,B" and "L,F"')
        page.is_done(3)

        expect(page.find(".chooser select")).to_have_value("A1, A2")
        page.goes_to(4)
        expect(page.find(".chooser select")).to_have_value("2")
        page.chooses(".tools-button")
        page.chooses(".tools button:has-text('Make the other half')")
        page.steers(2)
        page.answers("from row 4 to row 1")
        page.is_done(4)
        page.chooses(".reward button")
        page.cell_is(2, 3, "-45")

        page.goes_to(5)
        page.focuses(".learn form input")
        page.composes("静か")
        page.sees(".learn legend", "静か")
        for row, col in SWUNG:  # shorter steps
            before = page.cell(row, col)
            page.goes_over(row, col)
            page.composes("２０" if before == "45" else "ー２０")
            page.cell_is(row, col, before.replace("45", "20"))
        page.steers(2)
        page.chooses(".learn .foot-guess button:nth-of-type(2)")
        page.sees(".phase-question")
        page.chooses(".phase-question button:nth-of-type(1)")
        page.sees(".phase-verdict.right, .phase-verdict.wrong")
        if page.find(".phase-verdict.wrong").count():  # another question, after new work
            page.fills(1, 6, "31")
            page.steers(2)
            figures = "window.__studio.trials.all.value.at(-1).trial.reply.figures"
            page.answers(f"{page.page.evaluate(f'{figures}.cycle_s'):.2f} s")
        page.is_done(5)

        page.goes_to(6)
        for row, col in SWUNG:
            page.fills(row, col, page.cell(row, col).replace("20", "35"))
        page.chooses(".learn button:text-is('Check the table')")
        page.is_toasted("No mistakes")
        for key in (0, 1, 2, 3):
            page.steers(key)
        page.answers("key 3")
        page.is_done(6)
        page.page.close()
