"""Tests of one table on several pages: two windows at a folder, and two devices of a student."""

from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import psutil
import pytest
from chromium import OpenPage
from class_room import ClassRoom
from own_page import OwnPage
from playwright.sync_api import expect
from show import violations
from test_class_student import PHONE, TOLD, Pupil
from test_design import Designer, write_sample

pytestmark = pytest.mark.slow


def test_two_windows_at_one_folder_lose_nothing(
    open_page: OpenPage, tmp_path: Path, built_pages: Path, console: Any
) -> None:
    """Each window gets the other's numbers, also of an outage; undo takes back one's own only.

    Where both typed into the same cell in the outage, both have the same number and are told.
    """
    console.expect_a_break()
    write_sample(tmp_path)
    with OwnPage(tmp_path, "design") as own:
        one, other = (Designer(open_page, own.url) for _ in range(2))
        one.begin(own.key)
        one.misses(".people")
        one.go(5, 0)
        one.type("11.5")
        other.begin(own.key)
        other.cell_is(5, 0, "11.5")
        other.go(1, 0)
        other.page.keyboard.type("22")
        one.sees("#cell-1-0 .typing", "22")
        one.sees(".people li", "Window 2")
        other.press("Enter")
        one.cell_is(1, 0, "22")
        assert violations(one.page) == []

        one.press("Control+z")
        for page in (one, other):
            page.cell_is(5, 0, "45")
            page.cell_is(1, 0, "22")
        expect(other.find("button[aria-label^=Undo]")).to_be_enabled()

        gateway = psutil.Process(own.process.pid)
        gateway.suspend()
        try:
            for page, angle in ((one, "31"), (other, "32")):
                page.sees(".banner", "connection")
                page.go(2, 2)
                page.type(angle)
            one.go(3, 3)
            one.type("33")
            other.go(4, 4)
            other.type("34")
        finally:
            gateway.resume()
        for page in (one, other):
            page.cell_is(3, 3, "33")
            page.cell_is(4, 4, "34")
            page.is_toasted("typed into the same cell at the same time")
            page.until(TOLD)
        one.cell_is(2, 2, other.cell(2, 2))

        one.saves()
        expect(other.find(".bar .name small")).to_have_text("saved")
        other.misses("dialog[open]")
        one.page.reload()
        one.cell_is(3, 3, "33")


@pytest.fixture
def room(tmp_path: Path, built_pages: Path) -> Iterator[ClassRoom]:
    """Give a class."""
    with ExitStack() as stack:
        room = ClassRoom(tmp_path)
        stack.callback(room.close)
        yield room


def test_a_student_works_on_two_devices(open_page: OpenPage, room: ClassRoom) -> None:
    """A tablet that the teacher lets in has the table; what is typed on it is on the laptop too."""
    laptop = Pupil(open_page, room.url)
    laptop.joins(room, "Mia")
    laptop.changes("33")
    teacher = room.teacher()
    teacher.ask("admit", student="Mia")
    teacher.close()
    tablet = Pupil(open_page, room.url, **PHONE, locale="ja-JP")
    tablet.joins(room, "Mia")
    tablet.cell_is(0, 0, "33")
    tablet.page.click("#cell-1-1")
    tablet.page.click(".strip button.round >> nth=1")
    laptop.cell_is(1, 1, "5")
    tablet.sees(".people li", "ウィンドウ 1")
    assert tablet.page.evaluate("document.scrollingElement.scrollWidth") == 390
    assert violations(tablet.page) == []
