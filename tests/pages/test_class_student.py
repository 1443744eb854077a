"""Tests of /design for a student of a class, and of unsaved tables that come back."""

import json
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest
from chromium import OpenPage
from class_room import ClassRoom, until_kept
from own_page import OwnPage
from playwright.sync_api import expect
from processes import cut_power
from show import violations
from test_design import Designer, write_sample
from waiting import LIMIT_S

pytestmark = pytest.mark.slow

TOLD = "window.__studio.learning.isTold.value && window.__studio.sharing.isKept.value"
PHONE = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give the folder of the class."""
    return tmp_path_factory.mktemp("class")


@pytest.fixture(scope="module")
def ending() -> Iterator[ExitStack]:
    """Give what is closed after the last test of this file."""
    with ExitStack() as stack:
        yield stack


@pytest.fixture(scope="module")
def room(folder: Path, built_pages: Path, ending: ExitStack) -> ClassRoom:
    """Give a class that the tests of this file share, each with students of its own."""
    room = ClassRoom(folder)
    ending.callback(room.close)
    return room


class Pupil(Designer):
    """A student of a class, in a browser of its own."""

    def joins(self, room: ClassRoom, name: str) -> None:
        """Enter the class by keyboard alone, and wait for the table."""
        self.open("/design")
        self.sees(".join form")
        self.page.keyboard.type(room.code.lower())
        self.press("Tab")
        self.page.keyboard.type(name)
        self.press("Enter")
        self.is_in(name)

    def is_in(self, name: str) -> None:
        self.sees("#gait-grid td")
        self.sees(".bar .name b", name)
        expect(self.find(".try")).to_be_enabled()

    def changes(self, text: str) -> None:
        """Change the table's first number, and wait until the gateway has the change."""
        self.go(0, 0)
        self.type(text)
        self.cell_is(0, 0, text)
        self.until(TOLD)


@pytest.mark.long
def test_joins_by_keyboard_and_the_table_stays(open_page: OpenPage, room: ClassRoom) -> None:
    """A phone's page explains that a class code is wrong; a reload keeps the student's table."""
    page = Pupil(open_page, room.url, **PHONE)
    page.open("/design")
    page.sees(".join form")
    assert violations(page.page) == []
    assert page.page.evaluate("document.scrollingElement.scrollWidth") == 390
    page.page.keyboard.type("wrong1")
    page.press("Tab")
    page.page.keyboard.type("Mia")
    page.press("Enter")
    page.sees(".join-why", "not the code of this class")
    assert page.page.evaluate("document.activeElement.value") == "Mia"
    page.press("Shift+Tab", "Control+a")
    wide = "".join(chr(ord(letter) + 0xFEE0) for letter in room.code)  # as an input method types
    page.page.keyboard.insert_text(wide)
    page.press("Enter")
    page.is_in("Mia")
    page.sees(".bar .name small", "everything is kept")
    page.misses(".bar >> text=Save")
    assert violations(page.page) == []
    assert page.page.evaluate("document.scrollingElement.scrollWidth") == 390

    page.changes("33")
    page.find(".keys input").nth(2).fill("12")
    page.press("Enter")
    page.until(TOLD)
    page.page.evaluate("sessionStorage.clear()")
    page.page.reload()
    page.is_in("Mia")
    page.cell_is(0, 0, "33")
    expect(page.find(".keys input").nth(2)).to_have_value("1 2")


@pytest.mark.long
def test_hand_rules_and_the_handed_out_table(open_page: OpenPage, room: ClassRoom) -> None:
    """The teacher's rules, tables and deletions reach a student; only the newest page works."""
    with ExitStack() as closing:
        teacher = room.teacher()
        closing.callback(teacher.close)
        page = Pupil(open_page, room.url)
        page.joins(room, "Ken")
        page.page.click(".hand")
        page.sees(".hand[aria-pressed=true]", "Hand is up")
        teacher.until(lambda: teacher.card("Ken").get("hand_up_s"))

        rules = {"closed": [2], "coach": "matters", "explain_first": True}
        teacher.ask("rules", rules=rules)
        page.find(".phase-dots button[aria-disabled=true]").focus()
        page.press("Enter")
        page.is_toasted("has not opened phase 2")
        page.page.click(".phase-dots button:nth-child(1)")
        page.sees(".learn details[open] + .learn-task")
        page.page.click("#tab-coach")
        page.sees(".coach", "has closed the other searches")
        page.misses(".coach .sizes button")
        teacher.ask("rules", rules={"closed": [], "coach": "table", "explain_first": False})
        expect(page.find(".coach .sizes button")).to_have_count(5)

        page.changes("31")
        teacher.ask("hand_out", title="Step 1", sample=True)
        page.sees(".banner", "Step 1")
        assert violations(page.page) == []
        page.page.click(".banner >> text=Take it")
        page.cell_is(0, 0, "45")
        page.misses(".banner")
        page.press("Control+z")
        page.cell_is(0, 0, "31")
        page.until(TOLD)
        page.page.reload()
        page.is_in("Ken")
        page.cell_is(0, 0, "31")
        page.misses(".banner")

        other = page.page.context.new_page()
        other.goto(f"{room.url}/design?q=low")
        expect(other.locator("#cell-0-0")).to_have_text("31")
        page.changes("32")
        expect(other.locator("#cell-0-0")).to_have_text("32")
        other.close()

        teacher.ask("forget", student="Ken")
        page.sees("dialog.forgotten", "has deleted this name")
        assert violations(page.page) == []
        page.press("Escape", "Escape")
        page.page.click("button:text-is('Come in again')")
        page.sees(".join form")


@pytest.mark.long
def test_goes_on_after_the_gateway_was_killed(
    open_page: OpenPage, room: ClassRoom, folder: Path, ending: ExitStack, console: Any
) -> None:
    """When a killed gateway is back, a student's page sends it what was typed meanwhile."""
    console.expect_a_break()
    page = Pupil(open_page, room.url)
    page.joins(room, "Zoe")
    page.changes("20.375")
    until_kept(folder, 20.375)
    cut_power(room.process)
    page.sees(".banner")
    page.go(0, 1)
    page.type("21")
    page.sees(".bar .name small", "not kept yet")
    again = ClassRoom(folder, room.listen)
    ending.callback(again.close)
    room.process = again.process
    expect(page.find(".bar .name small")).to_have_text("everything is kept")
    page.until(TOLD)
    own = json.loads(page.page.evaluate("localStorage.getItem('lacoc.class')"))
    other = again.student("Zoe", own["token"])
    first = other.shared.table["rows"][0]["angles_deg"]
    other.close()
    assert first[:2] == [20.375, 21.0]


@pytest.mark.long
def test_the_next_student_at_a_page_gets_nothing_of_the_last(
    open_page: OpenPage, tmp_path: Path, built_pages: Path, console: Any
) -> None:
    """Another class begins at the same address: whoever enters at a page left open begins anew."""
    console.expect_a_break()
    room = ClassRoom(tmp_path / "one")
    page = Pupil(open_page, room.url)
    page.joins(room, "Ada")
    page.changes("33")
    room.close()
    page.sees(".banner")
    page.go(0, 1)
    page.type("34")
    again = ClassRoom(tmp_path / "two", room.listen)
    try:
        page.sees(".join form")
        page.page.fill(".join input >> nth=0", again.code)
        page.page.fill(".join input >> nth=1", "Ben")
        page.press("Enter")
        page.is_in("Ben")
        page.cell_is(0, 0, "45")  # the posture of a new table
        page.changes("21")
        own = json.loads(page.page.evaluate("localStorage.getItem('lacoc.class')"))
        other = again.student("Ben", own["token"])
        first = other.shared.table["rows"][0]["angles_deg"]
        other.close()
        assert first[:2] == [21.0, 0.0]
    finally:
        again.close()


@pytest.mark.long
def test_alone_changes_come_back_after_a_kill(
    open_page: OpenPage, tmp_path: Path, built_pages: Path, console: Any
) -> None:
    """After kill -9 of `lacoc design` the unsaved table is back; undo gives the file's table."""
    console.expect_a_break()
    write_sample(tmp_path)
    command = OwnPage(tmp_path, "design")
    process, url, key = command.process, command.url, command.key
    page = Designer(open_page, url)
    page.begin(key)
    page.go(0, 0)
    page.type("12.375")
    page.until(TOLD)
    until_kept(tmp_path, 12.375)
    cut_power(process)
    page.page.close()

    command = OwnPage(tmp_path, "design")
    process, url, key = command.process, command.url, command.key
    try:
        page = Designer(open_page, url)
        page.begin(key)
        page.cell_is(0, 0, "12.375")
        page.is_toasted("changes that were not saved are back")
        page.sees(".bar .name", "not saved")
        page.press("Control+z")
        page.cell_is(0, 0, "45")
        page.sees(".bar .name small", "saved")
        page.press("Control+y")
        page.cell_is(0, 0, "12.375")
        page.until(TOLD)

        file = tmp_path / "Loco-data.txt"
        text = file.read_text(encoding="utf-8")
        other = Designer(open_page, url)
        file.write_text(text.replace("1 Key\t0", "1 Key\t7"), encoding="utf-8")
        page.sees("dialog[open]", "was saved by another program")
        other.begin(key)
        other.sees("dialog[open]", "was saved by another program")
        other.cell_is(0, 0, "12.375")
        other.page.click("dialog >> text=Take the file's table")
        other.cell_is(1, 0, "7")
        other.press("Control+z")
        other.cell_is(0, 0, "12.375")
    finally:
        process.terminate()
        process.communicate(timeout=LIMIT_S)
