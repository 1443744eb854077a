"""Tests of /design, the page that `lacoc design` opens (workshop 3-2, 4-1, 4-2)."""

import math
import re
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import av
import psutil
import pytest
from chromium import OpenPage
from contestant import Contestant
from drop import drop
from given_files import given_in
from openpyxl import load_workbook
from own_page import OwnPage
from PIL import Image, ImageStat
from playwright.sync_api import expect
from show import violations
from waiting import until

from lacoc_robots.library import find_robot, sample_gait_files

pytestmark = pytest.mark.slow

BOOK = "Loco-data.xlsx"
BRED_MS = 240_000

"""Variants are tried in the background, which is slow while other tests keep the machine busy."""
TIP = "solo/leg4_2"
"""The 2nd link of the left middle leg."""


def breed_on(page: Contestant, then: str) -> None:
    """Press "Next six" until the next round is there: a busy studio may refuse a search."""
    shown = page.find(".variants").first
    button = page.find("button:text-is('Next six')")
    end_s = time.monotonic() + BRED_MS / 1000
    while then not in shown.inner_text():
        assert time.monotonic() < end_s, f"no {then}: {shown.inner_text()}"
        if button.is_enabled():
            button.click()
        page.page.wait_for_timeout(500)


class Designer(Contestant):
    """A person who designs a gait on the page."""

    def begin(self, key: str) -> None:
        """Open the page and wait until it has a table and a studio."""
        self.open("/design", key)
        self.sees("#gait-grid td")
        expect(self.find(".try")).to_be_enabled()

    def go(self, row: int, col: int) -> None:
        """Select a cell by a click."""
        self.page.click(f"#cell-{row}-{col}")

    def type(self, text: str) -> None:
        """Type into the selected cell, as a keyboard without an input method does."""
        self.page.keyboard.type(text)
        self.press("Enter")

    def cell(self, row: int, col: int) -> str:
        return self.find(f"#cell-{row}-{col}").inner_text()

    def cell_is(self, row: int, col: int, text: str) -> None:
        expect(self.find(f"#cell-{row}-{col}")).to_have_text(text)

    def tries(self) -> None:
        """Let the robot walk, and wait for the trial's figures."""
        said = self.find("#tab-trials small")
        before = int(said.inner_text()) if said.count() else 0
        self.press("Control+Enter")
        self.trials_are(before + 1)

    def trials_are(self, count: int) -> None:
        """Wait until the tab of the trials says so many."""
        self.sees("#tab-trials small", str(count))

    def saves(self) -> None:
        """Save the table, and wait until the page says that it is saved."""
        expect(self.find(".bar .name small")).to_have_text("not saved")
        self.press("Control+s")
        expect(self.find(".bar .name small")).to_have_text("saved")

    def figure(self, name: str) -> float:
        """Return a figure of the shown trial."""
        text = self.find(f".tiles [data-figure={name}] dd").inner_text().splitlines()[0]
        return float(text.replace("\N{MINUS SIGN}", "-").split("mm")[0].split("°")[0].strip(" %"))

    def body(self, name: str = TIP) -> list[float]:
        """Return where a body is drawn [m, world]."""
        found: list[float] = self.page.evaluate(
            "name => window.__lacoc.view.bodyPos(name) ?? [0, 0, 0]", name
        )
        return found

    def moves(self, before: list[float]) -> None:
        """Wait until the body is drawn in another place than `before`."""
        for _ in range(200):
            if math.dist(before, self.body()) > 1e-3:
                return
            self.page.wait_for_timeout(50)
        pytest.fail(f"the body stays at {before}")

    def rests(self) -> list[float]:
        """Wait until the body is drawn at one place for a second; return the place [m, world].

        A picture moves to a new posture in steps, and a busy machine draws twice a second.
        """
        for _ in range(100):
            before = self.body()
            self.page.wait_for_timeout(1000)
            if math.dist(before, self.body()) < 1e-4:
                return before
        pytest.fail("the body never rests")

    def paste(self, text: str) -> None:
        """Paste text into the focused element, as a browser does."""
        self.page.evaluate(
            """text => {
              const clipboardData = new DataTransfer();
              clipboardData.setData("text/plain", text);
              const init = { clipboardData, bubbles: true, cancelable: true };
              document.activeElement.dispatchEvent(new ClipboardEvent("paste", init));
            }""",
            text,
        )


def write_sample(folder: Path) -> None:
    """Write the sample's postures into a folder."""
    postures = sample_gait_files("hexapod").postures
    assert postures is not None
    (folder / "Loco-data.txt").write_bytes(postures.data)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give the folder with the sample's postures on which `lacoc design` runs."""
    folder = tmp_path_factory.mktemp("design")
    write_sample(folder)
    return folder


@pytest.fixture(scope="module")
def address(folder: Path, built_pages: Path) -> Iterator[tuple[str, str]]:
    """Give the address and the page key of a `lacoc design` that all tests of this file share."""
    with OwnPage(folder, "design") as command:
        yield command.url, command.key


@pytest.fixture
def sample(folder: Path) -> Path:
    """Write the sample's postures into the folder again, and give the folder."""
    write_sample(folder)
    return folder


def designer(open_page: OpenPage, address: tuple[str, str], **options: Any) -> Designer:
    """Open the page in its own browser profile, and drop what another test has not saved."""
    settings = {"viewport": {"width": 1280, "height": 800}} | options
    page = Designer(open_page, address[0], **settings)
    page.begin(address[1])
    page.until("window.__studio.learning.isTold.value")
    if page.find("dialog[open]").count():
        page.page.click("dialog >> .button:not(.quiet) >> nth=0")  # take the file's table
    else:
        page.press("Control+z")
    page.until("window.__studio.files.isSaved.value")
    if page.page.evaluate("window.__studio.files.file.value.name") == "":  # it was in no file
        page.page.evaluate("window.__studio.files.open('Loco-data.txt')")
    page.until("window.__studio.files.file.value.name")
    return page


def test_a_number_moves_the_leg_and_a_trial_explains_it(
    open_page: OpenPage, address: tuple[str, str], sample: Path
) -> None:
    """With the keyboard alone a number moves the leg, Try shows figures, and undo works."""
    page = designer(open_page, address)
    page.sees(".task", "Click a number")
    page.tries()
    assert page.figure("speed_mm_s") == pytest.approx(60, abs=3)
    assert page.figure("stable_share") == 100
    page.sees(".sentences", "slide")
    assert page.find(".bars .bar").count() == 6
    before = page.body()
    page.moves(before)  # the trial plays

    page.find(".cell-input").focus()
    page.press("Control+Home", "ArrowDown", *["ArrowRight"] * 4)  # key 1, root of L,C
    page.until("window.__lacoc.view.lit.join() === 'solo/leg4_0'")
    page.page.wait_for_timeout(400)  # the picture goes from the trial to the posture
    before = page.body()
    page.type("-40")
    page.moves(before)
    page.cell_is(1, 4, "-40")
    page.sees(".bar .name", "not saved")
    page.press("Alt+ArrowUp", "Alt+Shift+ArrowUp")
    page.cell_is(1, 4, "-34")
    page.sees(".task", "The table has changed")
    page.tries()
    page.sees(".tiles [data-figure=speed_mm_s] i")  # how much it has changed

    page.press("Control+z", "Control+z", "Control+z")
    page.cell_is(1, 4, "0")
    page.sees(".bar .name", "saved")
    page.page.click("#tab-trials")
    page.sees(".trials > li:last-child", "this table")  # the first trial was of this table
    page.find(".cell-input").focus()
    page.press("Control+y")
    page.cell_is(1, 4, "-40")
    page.type("200")
    assert page.find("#cell-1-4").get_attribute("aria-invalid") == "true"
    page.press("Control+Enter")
    page.is_toasted("red cells have no angle")


@pytest.mark.long
def test_a_beginner_s_first_gait(
    open_page: OpenPage, address: tuple[str, str], sample: Path
) -> None:
    """A beginner makes a gait that walks over 100 mm in five cycles, with at most 60 actions."""
    page = designer(open_page, address)
    actions = 0

    def click(selector: str) -> None:
        nonlocal actions
        page.page.click(selector)
        actions += 1

    click(".bar .name")
    click("dialog >> text=New table")
    page.cell_is(1, 0, "45")  # a new table has the standing posture
    own = {
        1: {0: "0", 3: "0", 12: "40", 14: "40", 16: "40"},
        2: {2: "0", 5: "0", 12: "40", 14: "40", 16: "40"},
    }
    for row, cells in own.items():
        for col, angle in cells.items():
            click(f"#cell-{row}-{col}")
            page.type(angle)
            actions += 1
    click(".strip >> text=Tools")
    click("text=Make the other half")
    page.cell_is(3, 13, "40")
    click(".try")
    page.sees(".trial-result .tiles")
    figures = page.page.evaluate("window.__studio.showing.shown.value.trial.reply.figures")
    assert figures["cycles"] == 5
    assert figures["speed_mm_s"] * figures["seconds"] > 100
    assert figures["upright"] > 0.9
    assert actions <= 60


@pytest.mark.long
def test_the_coach_works_and_can_be_stopped(
    open_page: OpenPage, address: tuple[str, str], sample: Path
) -> None:
    """The goal "left" chooses key 1; the coach shows its progress and ends after Stop."""
    page = designer(open_page, address)
    page.page.click("#tab-coach")
    page.find(".coach select").select_option("left")
    expect(page.find(".chooser select")).to_have_value("1")
    page.page.click("text=Which numbers matter?")
    page.sees(".coach .working progress")
    page.page.click("text=Stop")
    page.misses(".coach .working")
    page.sees(".coach >> text=Which numbers matter?")


@pytest.mark.long
def test_the_coach_repairs_a_wrong_sign(
    open_page: OpenPage, address: tuple[str, str], sample: Path
) -> None:
    """A wrong sign is named by the trial, then repaired by the coach with the same sentence."""
    page = designer(open_page, address)
    page.go(1, 14)
    page.type("-40")
    page.tries()
    page.sees(".sentences li:first-child", "has the other sign than its partner")
    page.page.click("#tab-coach")
    page.page.click(".coach .sizes >> text=one number")
    page.page.click(".coach .guess >> text=twice or more", timeout=BRED_MS)
    page.sees(".coach .repairs", "has the other sign than its partner")
    page.sees(".coach .better", "Your prediction is right")
    page.page.click("text=Change these and try")
    page.cell_is(1, 14, "40")


@pytest.mark.long(minutes=1)
def test_other_gaits_are_watched_and_taken(
    open_page: OpenPage, address: tuple[str, str], sample: Path
) -> None:
    """A gait of the map is chosen by keyboard and watched; variants are bred, and one is taken."""
    page = designer(open_page, address)
    page.page.click("#tab-coach")
    page.page.click(".coach >> text=Map of gaits")
    page.until("(window.__studio.search.progress.value?.filled ?? 0) > 0")
    page.page.click(".coach .working >> text=Stop")
    page.sees(".gait-map", "Stopped early")
    page.find(".map-grid .has-gait").first.click()
    page.sees(".other-gait .words", "mm/s")
    page.press("ArrowDown")
    chosen = page.find(".map-grid [aria-selected=true] button")
    expect(chosen).to_be_focused()
    assert violations(page.page) == []
    page.find(".map-grid .has-gait").first.click()
    name = page.find(".other-gait").get_attribute("aria-label")
    page.page.click(".other-gait >> text=Watch")
    page.sees(".trial-result h2", name)
    assert page.page.evaluate("window.__studio.trials.all.value.length") == 0
    page.page.click(".coach >> text=Six variants")
    cards = page.find(".variants li")
    expect(cards).to_have_count(6, timeout=BRED_MS)
    first = cards.first.inner_text()
    page.find(".variants .keep input").nth(0).check()
    page.find(".variants .keep input").nth(3).check()
    assert violations(page.page) == []
    breed_on(page, "Round 2")
    page.page.click(".variants button:text-is('Back')")
    page.sees(".variants", "Round 1")
    assert cards.first.inner_text() == first
    page.page.click("[aria-label='Take it: Variant 1.1']")
    page.sees(".trial-result h2", "Trial 1")
    page.sees(".coach", "The table has changed")
    page.page.click("[aria-label*='Variant 1.1'][title*='Ctrl+Z']")  # one step
    page.sees(".bar .name small", "saved")
    page.sees(".variants", "Round 1")  # variants of the table that is back


@pytest.mark.long
def test_a_table_goes_to_the_page_on_which_teams_enter(
    open_page: OpenPage, address: tuple[str, str]
) -> None:
    """The opened address has the table's files in its fragment, which no server gets to see."""
    page = designer(open_page, address)
    page.page.click(".bar .name")
    page.page.get_by_label("Address of the contest's pages").fill(address[0])
    with page.page.context.expect_page() as coming:
        page.page.get_by_role("button", name="Enter a contest").click()
    tab = coming.value
    tab.wait_for_url("**/enter#files=*", wait_until="commit")
    assert tab.url.startswith(f"{address[0]}/enter#")
    files = given_in(tab.url)["files"]
    assert (files["postures"]["name"], files["robot"]) == ("Loco-data.txt", None)
    assert b"\t" in files["postures"]["data"]


@pytest.mark.long
def test_a_table_goes_to_practice(
    open_page: OpenPage, address: tuple[str, str], sample: Path
) -> None:
    """The button opens practice in a new tab; if no tab can be opened, the page shows a link."""
    page = designer(open_page, address)
    page.page.click(".bar .name")
    with page.page.context.expect_page() as coming:
        page.page.click("dialog >> text=Practise with it")
    practice = coming.value
    practice.wait_for_url("**/practice*")
    expect(practice.locator(".pad, .key").first).to_be_visible()
    practice.close()
    page.page.evaluate("window.open = () => null")
    page.page.click("dialog >> text=Practise with it")
    expect(page.find("dialog a")).to_have_attribute("href", re.compile("/practice#key="))
    assert violations(page.page) == []


@pytest.mark.long
def test_a_foot_is_moved_in_the_picture(open_page: OpenPage, address: tuple[str, str]) -> None:
    """A foot follows arrow keys and a drag: three cells change in one step; too far is said."""
    page = designer(open_page, address)
    page.go(1, 3)
    before = [page.cell(1, col) for col in range(18)]
    foot = page.find(".feet .foot").first
    foot.focus()
    expect(page.find("#cell-1-12")).to_have_attribute("aria-selected", "true")

    def place_mm() -> list[int]:
        said = (foot.get_attribute("aria-label") or "").replace("−", "-")
        return [int(one) for one in re.findall(r"-?\d+", said)]

    was = place_mm()
    for _ in range(4):
        page.press("Shift+ArrowDown")
    page.press("PageUp")
    # Whole degrees bring it only near.
    until(lambda: math.dist(place_mm(), (was[0], was[1] - 40, was[2] + 2)) < 4)
    moved = [page.cell(1, col) for col in range(18)]
    assert [col for col in range(18) if moved[col] != before[col]] == [0, 6, 12]
    page.press("Control+z")  # one step
    assert [page.cell(1, col) for col in range(18)] == before

    box = foot.bounding_box()
    page.page.wait_for_timeout(1000)
    while box != (now := foot.bounding_box()):  # the camera comes to rest
        box = now
        page.page.wait_for_timeout(1000)
    assert box
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    mouse = page.page.mouse
    mouse.move(x, y)
    mouse.down()
    mouse.move(x - 24, y + 6, steps=4)

    def off_px() -> float:
        place = foot.bounding_box() or box
        return math.hypot(place["x"] - box["x"] + 24, place["y"] - box["y"] - 6)

    until(lambda: off_px() < 6)  # whole degrees are not as fine as the pointer
    assert place_mm() != was
    mouse.move(x + 900, y - 300, steps=4)
    page.sees(".feet .why", "Too far, by")
    mouse.up()
    assert [page.cell(1, col) for col in (1, 7, 13)] == [before[col] for col in (1, 7, 13)]
    page.press("Control+z")
    assert [page.cell(1, col) for col in range(18)] == before
    expect(page.find(".feet polyline.way")).to_have_count(6)
    page.page.click(".ways")
    expect(page.find(".feet polyline.way")).to_have_count(0)
    assert violations(page.page) == []


@pytest.mark.long
def test_a_gait_is_shared(
    open_page: OpenPage, address: tuple[str, str], tmp_path: Path, built_pages: Path
) -> None:
    """A link brings table and robot to another computer's page; a trial is a picture and a film."""
    page = designer(open_page, address)
    page.go(1, 0)
    page.type("12.5")
    page.tries()
    page.page.click("text=Share")
    link = page.find(".design-share input")
    expect(link).to_have_value(re.compile(r"/design#files=[\w-]{100,}$"))
    assert violations(page.page) == []
    with page.page.expect_download() as picture:
        page.page.click("text=Save a picture")
    with Image.open(picture.value.path()) as found:
        assert ImageStat.Stat(found.convert("L")).stddev[0] > 5, "there is a robot in it"
    with page.page.expect_download() as film:
        page.page.click("text=Save a film")
    with av.open(str(film.value.path())) as found:
        shown = [frame.to_ndarray(format="gray") for frame in found.decode(video=0)]
    assert len({each.tobytes() for each in shown}) > 10
    assert shown[0].std() > 5, "there is a robot in it"

    (tmp_path / "robot.toml").write_bytes(find_robot("quadruped")[1])
    with OwnPage(tmp_path, "design") as own:
        friend = Designer(open_page, own.url)
        friend.begin(own.key)
        friend.paste(f"Look: {link.input_value()}")
        friend.sees(".banner", "A friend shares a gait: Loco-data.txt")
        friend.page.click("text=Take it")
        friend.cell_is(1, 0, "12.5")
        friend.trials_are(1)
        assert friend.figure("speed_mm_s") == page.figure("speed_mm_s")
        friend.press("Control+z")
        expect(friend.find("#cell-1-12")).to_have_count(0)  # four legs again, in one step
        friend.paste(f"{link.input_value()[:-20]}")
        friend.is_toasted("has no whole gait")
        friend.page.close()


@pytest.mark.long
def test_predict_compare_and_the_way_back(
    open_page: OpenPage, address: tuple[str, str], sample: Path
) -> None:
    """Predictions get a verdict, Compare shows two trials, and a trial's table can be taken."""
    page = designer(open_page, address)
    page.tries()
    page.go(1, 0)
    page.paste("10\t0\t-45\t10\t0\t45\r\n")
    page.page.click("text=Predict")
    page.page.locator(".foretell label", has_text="straight on").locator("input").check(force=True)
    page.page.locator(".foretell label", has_text="faster").locator("input").check(force=True)
    page.page.click(".foretell .strong")
    expect(page.find(".trial-result .verdict")).to_have_count(2)
    page.page.click(".acts >> text=Compare")
    page.sees(".differences tbody tr", "Forward")
    page.sees(".shows", "pale: trial 1")
    page.until(f"window.__lacoc.view.ghostPos('{TIP}') !== null")
    page.page.click("#tab-trials")
    page.find("[aria-label='Take the table of Trial 1, key 2']").click()
    page.cell_is(1, 0, "0")


@pytest.mark.long
def test_what_is_pasted_dropped_and_composed(
    open_page: OpenPage, address: tuple[str, str], sample: Path
) -> None:
    """Pasted cells are all taken or none is; a robot file can be dropped; a Japanese IME works."""
    page = designer(open_page, address)
    page.go(1, 0)
    page.paste("1\t２\r\n−3\t4,5\r\n")
    assert [[page.cell(row, col) for col in (0, 1)] for row in (1, 2)] == [
        ["1", "2"],
        ["-3", "4.5"],
    ]
    page.paste("7\tseven\r\n")
    page.is_toasted("Nothing was pasted")
    assert page.cell(1, 0) == "1"
    assert page.find("#cell-1-1").get_attribute("data-unpasted") == "true"

    sheet = (sample / "Loco-data.txt").read_text(encoding="utf-8").replace("\t45", "\t44")
    page.paste(sheet)
    page.cell_is(0, 0, "44")
    page.press("Control+z")  # one step
    page.cell_is(0, 0, "45")

    page.go(3, 2)
    link = page.page.context.new_cdp_session(page.page)
    link.send("Input.imeSetComposition", {"text": "１", "selectionStart": 1, "selectionEnd": 1})
    link.send("Input.imeSetComposition", {"text": "１２", "selectionStart": 2, "selectionEnd": 2})
    assert page.cell(3, 2) == "0"  # nothing is taken while it is being composed
    link.send("Input.insertText", {"text": "１２"})
    page.press("Enter")
    page.cell_is(3, 2, "12")

    # A robot with four legs begins a new table; undo brings back table, robot and file.
    drop(page.page, dict([find_robot("quadruped")]))
    page.misses("#cell-0-12")
    page.sees(".bar .name b", "New gait")
    page.press("Control+z")
    page.cell_is(3, 2, "12")
    page.sees(".bar .name b", "Loco-data.txt")
    page.sees(".bar .name small", "not saved")
    page.tries()
    page.press("Control+y")
    page.misses("#cell-0-12")
    page.press("Control+z")
    page.cell_is(3, 2, "12")


@pytest.mark.long
def test_what_is_being_typed_is_saved_and_no_step_yet(
    open_page: OpenPage, address: tuple[str, str], sample: Path
) -> None:
    """Ctrl-S takes a number that is being typed, too. Until then leaving asks.

    Ctrl-Z takes back what is typed, and no step before it. Two saves in a row are no conflict.
    """
    page = designer(open_page, address)
    leaves = "dispatchEvent(new Event('beforeunload', { cancelable: true }))"
    page.go(1, 2)
    page.type("11")
    page.saves()
    assert page.page.evaluate(leaves)
    page.go(4, 4)
    before = page.cell(4, 4)
    page.page.keyboard.type("5")
    assert not page.page.evaluate(leaves)
    page.press("Control+Shift+z", "Control+z")
    assert page.page.evaluate(leaves)
    page.cell_is(4, 4, before)
    page.cell_is(1, 2, "11")
    page.go(1, 0)
    page.page.keyboard.type("33")
    page.press("Control+s", "Control+s")
    expect(page.find(".bar .name small")).to_have_text("saved")
    page.page.keyboard.type("34")  # the cell keeps the keyboard
    page.press("Control+s")
    page.cell_is(1, 0, "34")
    expect(page.find(".bar .name small")).to_have_text("saved")
    page.page.evaluate("window.__studio.files.saving")
    assert "1 Key\t34\t" in (sample / "Loco-data.txt").read_text(encoding="utf-8")
    page.misses("dialog[open]")


@pytest.mark.long
def test_a_file_that_changed_meanwhile_is_asked_about(
    open_page: OpenPage, address: tuple[str, str], sample: Path
) -> None:
    """If another program has saved the file, the page asks first; both tables can be kept.

    Where the page can't save, Ctrl-S downloads the table as a file.
    """
    page = designer(open_page, address)
    file = sample / "Loco-data.txt"
    page.go(1, 0)
    page.type("11")
    page.saves()
    assert "1 Key\t11\t" in file.read_text(encoding="utf-8")

    page.go(1, 0)
    page.type("12")
    other = file.read_text(encoding="utf-8").replace("1 Key\t11\t", "1 Key\t13\t")
    file.write_text(other, encoding="utf-8")
    page.sees("dialog[open]", "was saved by another program")
    page.page.click("dialog >> text=Take the file's table")
    page.cell_is(1, 0, "13")
    page.press("Control+z")
    page.cell_is(1, 0, "12")
    page.saves()
    assert "1 Key\t12\t" in file.read_text(encoding="utf-8")

    page.page.click(".bar .name")
    page.page.click("dialog >> text=New table")
    page.cell_is(1, 0, "45")
    page.press("Control+s")  # under the usual name, which another table has
    page.sees("dialog[open]", "is in the folder already")
    page.press("Escape")
    page.misses("dialog[open]")
    assert "1 Key\t12\t" in file.read_text(encoding="utf-8")
    page.press("Control+s")
    page.page.click("dialog >> text=Save mine over it")
    expect(page.find(".bar .name small")).to_have_text("saved")
    assert "1 Key\t45\t" in file.read_text(encoding="utf-8")

    page.page.click(".bar .name")
    with page.page.expect_download() as coming:
        page.page.click("text=Download .xlsx")
    coming.value.save_as(sample.parent / BOOK)
    rows = load_workbook(sample.parent / BOOK).worksheets[0].iter_rows(values_only=True)
    assert any(row[:2] == ("1 Key", 45) for row in rows)
    page.press("Escape")

    page.page.evaluate(
        "can => { can.value = { ...can.value, save: false, coach: false, learn: false } }",
        page.page.evaluate_handle("window.__studio.can"),
    )
    with page.page.expect_download() as coming:
        page.press("Control+s")
    assert coming.value.suggested_filename == "Loco-data.txt"
    page.misses("#tab-coach, #tab-phase, .phase-dots")


@pytest.mark.long
def test_a_phone_in_japanese_tries_and_compares(
    open_page: OpenPage, address: tuple[str, str], sample: Path
) -> None:
    """On a phone a button changes a number, two trials are compared, and nothing is too wide."""
    page = designer(
        open_page,
        address,
        viewport={"width": 390, "height": 844},
        locale="ja-JP",
        has_touch=True,
        is_mobile=True,
    )
    page.sees(".try", "歩かせる")
    page.page.tap(".try")
    page.sees(".tiles", "前進")
    page.page.tap("#cell-2-3")
    page.page.tap(".strip .round >> nth=1")
    page.cell_is(2, 3, "-40")
    page.page.tap(".try")
    page.trials_are(2)
    page.page.tap(".bar >> text=比べる")
    page.sees(".differences")
    assert page.find("kbd:visible").count() == 0
    assert page.page.evaluate("document.scrollingElement.scrollWidth") == 390
    assert violations(page.page) == []


@pytest.mark.long
def test_axe_finds_nothing(open_page: OpenPage, address: tuple[str, str], sample: Path) -> None:
    """The tool axe finds no serious accessibility mistake on the page, in its tabs and a dialog."""
    page = designer(open_page, address)
    assert violations(page.page) == []
    page.tries()
    page.page.click("text=Predict")
    for tab in ("coach", "robot", "trials"):
        page.page.click(f"#tab-{tab}")
        assert violations(page.page) == []
    page.page.click(".bar .name")
    page.sees("dialog[open]")
    assert violations(page.page) == []


@pytest.mark.long
def test_a_page_that_comes_while_the_studio_stands_still_opens_by_itself(
    open_page: OpenPage, tmp_path: Path, console: Any
) -> None:
    """The page says that there is no studio, asks again by itself, and then opens."""
    console.expect_a_break()  # at the end
    with OwnPage(tmp_path, "design") as own:
        children = psutil.Process(own.process.pid).children(recursive=True)
        (studio,) = (child for child in children if "studio" in child.cmdline())
        Designer(open_page, own.url).begin(own.key)
        studio.suspend()
        other = find_robot("hexapod")[1].replace(b"Hexapod", b"Another")  # not known yet
        (tmp_path / "robot.toml").write_bytes(other)
        try:
            page = Designer(open_page, own.url)
            page.open("/design", own.key)
            page.sees(".banner", "no studio")
        finally:
            studio.resume()
        page.sees("#gait-grid td")
        page.misses(".banner")


@pytest.mark.long
def test_trials_outlive_a_reload_and_an_outage(
    open_page: OpenPage, tmp_path: Path, console: Any
) -> None:
    """Trials are there after a reload; one that is asked for in an outage is made after it."""
    console.expect_a_break()
    with OwnPage(tmp_path, "design") as own:
        page = Designer(open_page, own.url)
        page.begin(own.key)
        page.tries()
        speed = page.figure("speed_mm_s")
        page.page.reload()
        page.trials_are(1)
        page.page.click("#tab-trials")
        page.page.click(".trials > li button >> nth=0")
        assert page.figure("speed_mm_s") == speed

        gateway = psutil.Process(own.process.pid)
        gateway.suspend()
        try:
            page.sees(".banner", "connection")
            page.press("Control+Enter")
            page.is_toasted("as soon as it is back")
        finally:
            gateway.resume()
        page.trials_are(2)
