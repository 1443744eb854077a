"""Tests of one table on several pages: two windows at a folder, a student's devices, a group."""

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
from waiting import until

pytestmark = pytest.mark.slow


@pytest.mark.long
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


@pytest.mark.long
def test_a_table_that_is_too_large_stays_on_its_page(
    open_page: OpenPage, tmp_path: Path, built_pages: Path, console: Any
) -> None:
    """The page says so once, and goes on."""
    console.expect_a_break()
    row = "\t".join(["0"] * 18) + "\n"
    postures = [50] * 10
    postures[2] = 4  # the key that is tried, so that the trial is short
    keys = (f"{count}\n" + row * count for count in postures)
    (tmp_path / "LocoTra-data.txt").write_text("10\n" + "".join(keys))
    sent: list[int] = []
    with OwnPage(tmp_path, "design") as own:
        page = Designer(open_page, own.url)
        page.page.on(
            "websocket", lambda it: it.on("framesent", lambda data: sent.append(len(data)))
        )
        page.begin(own.key)
        page.is_toasted("too many rows")
        page.go(0, 0)
        page.type("12")
        page.tries()
        page.cell_is(0, 0, "12")
        assert sum(size > 100_000 for size in sent) == 1


@pytest.fixture
def room(tmp_path: Path, built_pages: Path) -> Iterator[ClassRoom]:
    """Give a class."""
    with ExitStack() as stack:
        room = ClassRoom(tmp_path)
        stack.callback(room.close)
        yield room


@pytest.mark.long
def test_a_student_works_on_two_devices(room: ClassRoom, open_page: OpenPage) -> None:
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


def joins_group(page: Pupil, name: str) -> None:
    """Make or join a group, and wait until the page says so."""
    page.page.click("#tab-group")
    page.page.fill(".group input", name)
    page.press("Enter")
    page.sees(".group h3", name)


EDITS = 1000
TYPES = """([edits, seed]) => {
  const { sheet } = window.__studio;
  let state = seed;
  const draw = (below) => {
    state = (state * 16807) % 2147483647;
    return state % below;
  };
  window.__edits = new Promise((done) => {
    let made = 0;
    const some = () => {
      for (let each = 0; each < 5 && made < edits; each++, made++) {
        const [row, col] = [draw(sheet.table.value.rows.length), draw(18)];
        const angle = draw(120) - 60;
        const change = (table) => ({
          ...table,
          rows: table.rows.map((one, at) =>
            at === row ? { ...one, cells: one.cells.with(col, angle) } : one),
        });
        if (draw(10)) sheet.edit("typing", change);
        else sheet.undo();
      }
      made < edits ? setTimeout(some, 30) : done();
    };
    some();
  });
}"""
"""Types at random, five times in 30 ms; one time in ten it takes back its own last number."""


@pytest.mark.long
def test_four_browsers_of_one_group_converge(
    room: ClassRoom, open_page: OpenPage, console: Any
) -> None:
    """Four pages make 1,000 random edits each, with outages: in the end all have one table."""
    console.expect_a_break()
    pages = [Pupil(open_page, room.url) for _ in range(4)]
    for name, page in zip(("Ann", "Ben", "Cleo", "Dora"), pages, strict=True):
        page.joins(room, name)
        joins_group(page, "Ants")
    gateway = psutil.Process(room.process.pid)
    for seed, page in enumerate(pages, 1):
        page.page.evaluate(TYPES, [EDITS, seed])
    for _ in range(3):
        pages[0].page.wait_for_timeout(1000)
        gateway.suspend()
        pages[0].page.wait_for_timeout(500)
        gateway.resume()
        for page in pages[:2]:
            page.page.context.set_offline(True)
            page.page.wait_for_timeout(300)
            page.page.context.set_offline(False)
    for page in pages:
        page.page.evaluate("window.__edits")
    digest = "window.__studio.sheet.digest.value"
    until(lambda: len({page.page.evaluate(digest) for page in pages}) == 1)
    for page in pages:
        expect(page.find(".bar .name small")).to_have_text("everything is kept")
    (last,) = {page.page.evaluate(digest) for page in pages}
    pages[3].page.reload()
    pages[3].until(f"window.__studio?.sheet.digest.value === '{last}'")


@pytest.mark.long
def test_four_students_make_one_gait(room: ClassRoom, open_page: OpenPage, console: Any) -> None:
    """Four students share a table with roles and a word; an outage loses nothing.

    A number in somebody else's row is a proposal, which its owner takes in with one press. The
    teacher has one card for the group.
    """
    console.expect_a_break()
    ann, ben, cleo, dora = (Pupil(open_page, room.url) for _ in range(4))
    group = {"Ann": ann, "Ben": ben, "Cleo": cleo, "Dora": dora}
    for name, page in group.items():
        page.joins(room, name)
    ann.changes("33")
    for page in group.values():
        joins_group(page, "Ants")
        page.cell_is(0, 0, "33")
    expect(ann.find(".people li")).to_have_count(3)
    expect(ann.find(".group-members li")).to_have_count(4)
    assert violations(ann.page) == []

    ann.page.click(".group-roles button >> nth=0")
    ben.page.click(".group-roles button >> nth=1")
    ben.sees("#gait-grid th[title='Ann designs this row']")
    colours = [
        ben.find(where).first.evaluate("it => getComputedStyle(it).getPropertyValue('--person')")
        for where in (
            ".group-members li:has-text('Ann') i",
            "#gait-grid th[title='Ann designs this row']",
            ".group-members li:has-text('Ben') i",
        )
    ]
    assert colours[0] == colours[1] != colours[2], "whose row it is has one colour everywhere"
    ben.go(1, 2)
    ben.type("44")
    ben.is_toasted("your number for row 1")
    ben.cell_is(1, 2, "-4544")  # the number, and the proposal over it
    ann.sees(".proposals", "Ben proposes 44°")
    assert violations(ann.page) == []
    ann.page.click(".proposals >> text=Take it in")
    for page in group.values():
        page.cell_is(1, 2, "44")
    ann.misses(".proposals")

    with room.teacher() as desk:
        # Ben typed the number that Ann took in: it is his own.
        until(lambda: "Ben,edited" in desk.ask("export", what="evidence")["data"].decode())
        text = desk.ask("export", what="evidence")["data"].decode()
        assert [line.split(",")[2] for line in text.splitlines() if "44.0" in line] == ["Ben"]

    for page in (cleo, dora):
        page.page.fill(".group-words input", "calm")
        page.press("Enter")
    ann.sees(".group-words p", "calm")

    gateway = psutil.Process(room.process.pid)
    gateway.suspend()
    try:
        for number, page in enumerate(group.values()):
            page.sees(".banner", "connection")
            page.go(0, 6 + number)
            page.type(f"5{number}")
        ann.sees(".bar .name small", "not kept yet")
    finally:
        gateway.resume()
    for page in group.values():
        for number in range(4):
            page.cell_is(0, 6 + number, f"5{number}")
        expect(page.find(".bar .name small")).to_have_text("everything is kept")

    teacher = Designer(open_page, room.url, locale="ja-JP")
    teacher.open("/class", room.key)
    teacher.sees(".class-group", "Ants")
    expect(teacher.find(".class-group .member")).to_have_count(4)
    expect(teacher.find(".students > li")).to_have_count(1)
    assert violations(teacher.page) == []
    teacher.page.select_option("select[name=recipient]", "Ants")
    teacher.page.click("text=見本 >> nth=0")
    for page in group.values():
        page.sees(".banner", "見本")
    dora.page.click("#tab-group")
    dora.page.click("text=Leave the group")
    dora.sees(".group h3", "Work as a group")
    expect(teacher.find(".class-group .member")).to_have_count(3)
