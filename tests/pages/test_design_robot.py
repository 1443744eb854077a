"""Tests of the robot's numbers on /design (workshop 4-3)."""

import os
from collections.abc import Iterator
from pathlib import Path

import pytest
from chromium import OpenPage
from own_page import OwnPage
from playwright.sync_api import expect
from show import violations
from test_design import Designer, write_sample

from lacoc_robots.library import find_robot

pytestmark = pytest.mark.slow


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Give a folder with the sample's postures and no robot."""
    write_sample(tmp_path)
    return tmp_path


@pytest.fixture
def address(folder: Path, built_pages: Path) -> Iterator[tuple[str, str]]:
    """Give the address and the page key of a `lacoc design` on the folder."""
    with OwnPage(folder, "design") as command:
        yield command.url, command.key


@pytest.mark.long
def test_a_number_of_the_robot_is_changed_and_saved(
    address: tuple[str, str], open_page: OpenPage, folder: Path
) -> None:
    """A new length shows in 3D at once; a wrong one is told at its field; saving keeps comments.

    Undo takes the change back. If another program saved the robot file meanwhile, the page asks.
    """
    url, key = address
    text = find_robot("hexapod")[1].decode()
    file = folder / "robot.toml"

    def field(page: Designer, name: str) -> str:
        return page.find(f"[data-fact={name}] input").input_value()

    def field_is(page: Designer, name: str, value: str) -> None:
        expect(page.find(f"[data-fact={name}] input")).to_have_value(value)

    page = Designer(open_page, url, viewport={"width": 1280, "height": 800})
    page.begin(key)
    page.page.click("#tab-robot")
    page.sees(".robot", "the workshop's hexapod")
    first = page.find("[data-fact=first_link_m] input")
    assert field(page, "first_link_m") == "70"

    # With the keyboard: full-width digits, a length that no robot may have, and Esc.
    before = page.body()
    first.focus()
    page.page.keyboard.insert_text("７８")
    page.press("Enter")
    page.moves(before)
    field_is(page, "first_link_m", "78")
    page.sees("[data-fact=width_m] td", "316")
    page.sees(".robot .unsaved", "not saved")
    moved = page.rests()
    page.page.keyboard.press("Control+a")
    page.page.keyboard.type("300")
    page.press("Enter")
    page.sees("[data-fact=first_link_m] .wrong", "The contest allows 20 – 120 mm")
    assert first.get_attribute("aria-invalid") == "true"
    assert violations(page.page) == []
    page.press("Escape")
    page.misses(".robot .wrong")
    assert field(page, "first_link_m") == "78"
    assert page.rests() == pytest.approx(moved, abs=1e-3)

    # What only the robot as a whole forbids is told at the field too.
    page.find("[data-fact=link_radius_m] input").fill("20")
    page.press("Enter")
    page.sees("[data-fact=link_radius_m] .wrong", "The robot keeps 15 mm")
    page.press("Escape")

    # Legs that would begin in the floor begin higher.
    page.find("[data-fact=second_link_m] input").fill("110")
    page.press("Enter")
    field_is(page, "second_link_m", "110")
    page.is_toasted("starts at another height")
    page.press("Control+Enter")
    page.sees(".tiles [data-figure=speed_mm_s]")

    # A leg is moved, and the one of the other side with it; undo brings both back.
    right, left = (page.page.get_by_label(f"{leg}, forward (mm)") for leg in ("R,F", "L,F"))
    right.fill("52")
    page.press("Enter")
    expect(left).to_have_value("52")
    right.fill("-60")
    page.press("Enter")
    page.sees(".leg-places .wrong", "clockwise")
    page.press("Escape")
    page.press("Control+z")
    expect(left).to_have_value("45")

    # Undo and redo, a step of the arrow keys, and a file that keeps its comments.
    page.press("Control+z")
    field_is(page, "second_link_m", "70")
    page.press("Control+z")
    field_is(page, "first_link_m", "70")
    page.press("Control+y")
    field_is(page, "first_link_m", "78")
    first.focus()
    page.press("ArrowUp", "ArrowUp")
    field_is(page, "first_link_m", "80")
    page.page.click(".robot-file .button")
    page.sees(".robot-file small", "saved")
    expect(page.find(".robot-file .button")).to_be_disabled()
    saved = file.read_bytes().decode()
    assert saved == text.replace("0.015, 0.070, 0.070", "0.015, 0.08, 0.070")

    # Another program saves: the page follows, or asks if it has changes of its own.
    def save(new: str) -> None:
        other = folder / "new"
        other.write_bytes(new.encode())
        os.replace(other, file)

    save(saved.replace("0.08,", "0.09,"))
    field_is(page, "first_link_m", "90")
    page.find("[data-fact=friction] input").fill("0.5")
    page.press("Enter")
    page.sees(".robot .unsaved")
    save(saved.replace("0.08,", "0.1,"))
    page.sees("dialog[open]", "Your robot has changes")
    page.page.click("dialog >> text=Keep mine")
    page.misses("dialog[open]")
    page.until("window.__studio.learning.isTold.value")

    # What was not saved comes back, on a phone too.
    phone = Designer(
        open_page, url, viewport={"width": 390, "height": 844}, has_touch=True, is_mobile=True
    )
    phone.begin(key)
    phone.page.tap("#tab-robot")
    field_is(phone, "friction", "0.5")
    field_is(phone, "first_link_m", "90")
    phone.find("[data-fact=body_mass_kg] input").fill("-5")
    phone.page.tap("[data-fact=legs] th")
    phone.sees("[data-fact=body_mass_kg] .wrong")
    assert phone.page.evaluate("document.scrollingElement.scrollWidth") == 390
    assert violations(phone.page) == []
