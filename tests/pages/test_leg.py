"""Tests of /leg, the lesson of one leg (workshop 3-1)."""

import re
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest
from chromium import OpenPage
from class_room import ClassRoom
from own_page import OwnPage
from playwright.sync_api import Locator, Page, expect
from processes import cut_power
from show import violations
from test_design import Designer, write_sample

pytestmark = pytest.mark.slow

STEPS = 8
PHONE = {"width": 390, "height": 844}


@pytest.fixture
def own(tmp_path: Path, built_pages: Path) -> Iterator[OwnPage]:
    """Give `lacoc design` in a folder with the sample gait."""
    write_sample(tmp_path)
    with OwnPage(tmp_path, "design") as command:
        yield command


class Learner:
    """A person who takes the lesson.

    Args:
        page: a new page.
        url: address of the gateway.
        options: the rest of the address.
    """

    def __init__(self, page: Page, url: str, options: str = "") -> None:
        self.page = page
        page.goto(f"{url}/leg{options}")

    def question(self, at: int = 0) -> Locator:
        return self.page.locator(".ask").nth(at)

    def guesses(self, text: str, at: int = 0) -> None:
        self.question(at).get_by_role("button", name=text, exact=True).press("Enter")

    def goes_on(self) -> None:
        self.page.get_by_role("button", name="Next").press("Enter")

    def sees(self, text: str) -> None:
        expect(self.page.locator(".leg")).to_contain_text(text)


def test_the_lesson_by_keyboard_ends_in_the_table(own: OwnPage, open_page: OpenPage) -> None:
    """Eight steps by keyboard: each asks before it shows; the numbers go into row 1 of /design."""
    designer = Designer(open_page, own.url, viewport={"width": 1280, "height": 800})
    page = designer.page
    designer.begin(own.key)
    learner = Learner(page, own.url)

    expect(page.locator("text.number")).to_have_text(["0"])
    learner.guesses("leg R,F, 1st")
    expect(learner.question()).to_contain_text("Right!")
    learner.guesses("leg L,C, 1st", 1)
    expect(learner.question(1)).to_contain_text("Not this time. Number 13 is leg R,C, 2nd.")
    expect(page.locator("text.number")).to_have_count(18)

    learner.goes_on()
    expect(page.locator(".formulas")).to_have_count(0)
    learner.guesses("35.0 mm")
    learner.sees("z = L₁ sin θ₁ = 70 · sin 30° = 35.0 mm")
    learner.goes_on()
    learner.guesses("r 104.7 mm, z −41.8 mm")
    expect(page.locator(".formulas p").nth(1)).to_contain_text("= −41.8 mm")
    learner.goes_on()
    learner.guesses("80.1 mm")
    learner.sees("The body goes 80.1 mm")

    learner.goes_on()
    learner.guesses("two")
    expect(page.locator(".pairs .button")).to_have_text(
        ["1st 1.2°, 2nd 37.8°", "1st −51.0°, 2nd 142.2°"]
    )
    foot = page.get_by_role("slider", name="Foot")
    foot.press("ArrowUp")
    learner.sees("r 129.0 mm, z −52.0 mm")
    for _ in range(2):
        foot.press("Shift+ArrowRight")
    expect(page.locator(".unreached")).to_have_text(re.compile(r"Too far, by \d"))

    learner.goes_on()
    learner.guesses("140.0 mm")
    learner.goes_on()
    learner.guesses("inside")
    learner.guesses("inside", 1)
    expect(learner.question(1)).to_contain_text("The robot falls over.")
    page.get_by_role("button", name="L,C", exact=True).press("Enter")
    learner.sees("Margin: ")

    learner.goes_on()
    numbers = page.locator(".posture td").all_inner_texts()
    page.get_by_role("link", name="Put them into the table").press("Enter")
    designer.sees("#gait-grid td")
    for level, angle in enumerate(numbers):
        designer.cell_is(1, 6 * level, angle)
    designer.is_toasted("Leg R,F of row 1")
    assert "leg=" not in page.url


@pytest.mark.long
def test_a_foot_is_dragged_by_touch_on_a_phone(own: OwnPage, open_page: OpenPage) -> None:
    """A finger drags the foot; every step fits a phone in Japanese and has no serious mistake."""
    page = open_page(viewport=PHONE, has_touch=True, is_mobile=True, locale="ja-JP")
    for step in range(1, STEPS + 1):
        Learner(page, own.url, f"?at={step}#{step}")
        while page.locator(".ask .button:not([aria-disabled])").count():
            page.locator(".ask .button:not([aria-disabled])").first.tap()
        expect(page.locator(".told h2")).to_contain_text(f"{step}.")
        assert page.evaluate("document.querySelector('.leg').scrollWidth") <= PHONE["width"]
        assert violations(page) == []
        expect(page.get_by_text("矢印キー")).to_have_count(0)
        if step == 5:
            handle = page.locator(".handle")
            box = handle.bounding_box()
            assert box is not None
            x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
            before = handle.get_attribute("aria-valuetext")
            link = page.context.new_cdp_session(page)
            for kind, at in (("touchStart", 0), ("touchMove", -10), ("touchMove", -20)):
                points = [{"x": x + at, "y": y}]
                link.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})
            link.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
            expect(handle).not_to_have_attribute("aria-valuetext", before or "")


@pytest.mark.long
def test_a_student_of_a_class_comes_back_to_where_she_was(
    open_page: OpenPage, tmp_path: Path, built_pages: Path, console: Any
) -> None:
    """In a class the lesson is phase 0: the teacher sees the step; a restart keeps the place."""
    console.expect_a_break()
    room = ClassRoom(tmp_path)
    with ExitStack() as closing:
        closing.callback(lambda: room.close())
        teacher = room.teacher()
        pupil = Designer(open_page, room.url, viewport={"width": 1280, "height": 800})
        page = pupil.page
        pupil.open("/design")
        pupil.sees(".join form")
        page.keyboard.type(room.code)
        pupil.press("Tab")
        page.keyboard.type("Mia")
        pupil.press("Enter")
        pupil.sees("#gait-grid td")
        pupil.cell_is(0, 0, "45")
        page.click(".phase-dots button:nth-child(1)")
        pupil.sees(".learn h3", "0.")
        page.click("text=Begin the lesson")
        expect(page.locator(".told h2")).to_contain_text("1.")
        back = page.get_by_role("link", name="Back to my table")
        expect(back).to_be_visible()
        learner = Learner(page, room.url)
        learner.guesses("leg R,F, 1st")
        learner.guesses("leg R,C, 2nd", 1)
        learner.goes_on()
        learner.guesses("35.0 mm")
        learner.goes_on()
        teacher.until(lambda: teacher.card("Mia").get("lesson_step") == 3)
        assert teacher.card("Mia")["in_lesson"]

        back.click()
        pupil.sees("#gait-grid td")
        page.click("#tab-phase")
        pupil.sees(".learn", "step 3")
        pupil.sees(".learn-missing", "6 steps")
        teacher.until(lambda: not teacher.card("Mia")["in_lesson"])
        teacher.close()
        cut_power(room.process)
        again = ClassRoom(tmp_path, room.listen)
        room.process = again.process
        closing.callback(again.close)
        page.click("text=Go on with the lesson")
        expect(page.locator(".told h2")).to_contain_text("3.")
        page.get_by_role("button", name="Back", exact=True).click()
        expect(learner.question()).to_contain_text("Right!")
        page.reload()
        expect(page.locator(".told h2")).to_contain_text("2.")
        expect(learner.question()).to_contain_text("Right!")
        page.get_by_role("button", name="Ask again").click()
        expect(learner.question()).to_contain_text("Guess first")
        desk = again.teacher()
        closing.callback(desk.close)
        assert desk.card("Mia")["states"][0] == "open"
        assert violations(page) == []


@pytest.mark.long
def test_the_worksheet_has_answers_only_for_the_teacher(own: OwnPage, open_page: OpenPage) -> None:
    """The worksheet has blank lines; with `answers` they hold the numbers, for any sample robot."""
    page = open_page()
    learner = Learner(page, own.url, "?print")
    expect(page.locator(".worksheet li")).to_have_count(6)
    assert set(page.locator(".blank").all_inner_texts()) == {"\N{NO-BREAK SPACE}"}
    page.get_by_role("button", name="With answers").click()
    for answer in ("R,C 2nd", "35.0", "104.7", "80.1", "142.2°", "inside, 61 mm"):
        learner.sees(answer)
    page.select_option(".bar select", "quadruped")
    learner.sees("L₂ = 85 mm")
    assert violations(page) == []
