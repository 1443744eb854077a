"""Tests of /practice, the page that `lacoc practice` opens (workshop 4-4, Fig. 4-3)."""

import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from contestant import Contestant, Sit
from own_page import OwnPage
from show import violations
from waiting import LIMIT_S

from lacoc_robots.library import sample_gait_files
from lacoc_shared.gait.cells import leg_labels
from lacoc_shared.gait.tables import PostureTable, to_locomotion
from lacoc_shared.gait.text import read_gait, write_gait
from lacoc_shared.gait.workbook.file import write_workbook
from lacoc_shared.seat import Phase

pytestmark = pytest.mark.slow

Practise = Callable[..., Contestant]


@pytest.fixture
def address(tmp_path: Path, built_pages: Path) -> Iterator[tuple[str, str]]:
    """Give the address and page key of `lacoc practice`, which runs during the test."""
    with OwnPage(tmp_path, "practice") as command:
        yield command.url, command.key


@pytest.fixture
def practise(address: tuple[str, str], sit: Sit) -> Practise:
    """Give a function that opens the practice page in the tests' browser."""

    def begin(**options: object) -> Contestant:
        url, key = address
        page = sit(url, **options)
        page.open("/practice", key)
        return page

    return begin


@pytest.fixture
def practise_in(tmp_path: Path, built_pages: Path, sit: Sit) -> Iterator[Practise]:
    """Give a function that starts practice in the test's folder and opens its page."""
    with ExitStack() as stack:

        def begin(**options: object) -> Contestant:
            command = stack.enter_context(OwnPage(tmp_path, "practice"))
            url, key = command.url, command.key
            page = sit(url, **options)
            page.open("/practice", key)
            stack.callback(page.page.context.close)  # before its gateway ends
            return page

        yield begin


def lessons(page: Contestant, *keys: int) -> None:
    """Press each key when the page shows it as the next one."""
    for key in keys:
        page.sees(".steps li.now", str(key))
        page.press(str(key))
        page.key_stands(key)
        page.page.wait_for_timeout(400)  # a move of 45 degrees (workshop 4-4: slow inputs)


def test_a_student_s_first_five_minutes(practise: Practise, tmp_path: Path) -> None:
    """A student walks by keys 1 to 4, uses level B, [x] and [z], and gets Pos-data.txt."""
    page = practise()
    page.stands("seated")
    page.phase(Phase.PLAYING)  # nobody had to say ready
    page.sees(".lesson", "Slowly press 1, 2, 3, 4")
    page.sees(".key.hinted[data-key='1']")
    lessons(page, 1, 2, 3, 4)
    page.sees(".lesson", "Well done")
    lessons(page, 1, 2, 3, 4)
    page.sees(".lesson", "to walk back")
    assert page.find(".pressed kbd").all_inner_texts() == [*"12341234"]
    page.until("Number(document.querySelectorAll('.figures dd')[1].firstChild.data) > 0.04")
    assert abs(page.number(".figures dd")) < 30  # it walks straight on, along the field's y

    page.press("Tab")
    page.is_toasted("Level B: press a digit")
    page.press("ArrowUp")
    page.key_stands(2)
    page.sees(".stands", "B 2: posture")
    page.sees(".lesson", "Walk anywhere")
    page.until("Number(document.querySelectorAll('.figures dd')[2].firstChild.data) > 2")
    page.press("x")
    page.key_stands(0)
    page.until("Number(document.querySelectorAll('.figures dd')[1].firstChild.data) < 0.04")
    page.press("2")  # at once: in practice [x] does not block the keys
    page.key_stands(2)
    page.until("Number(document.querySelectorAll('.figures dd')[1].firstChild.data) > 0.01")
    page.press("x")  # [x] begins a new walk, also near the start
    page.until("Number(document.querySelectorAll('.figures dd')[1].firstChild.data) === 0")
    page.press("3")
    page.key_stands(3)

    page.page.wait_for_timeout(300)
    heading_deg = page.number(".figures dd")
    page.press("z")
    name, text = page.download(lambda: page.page.click("text=Save and leave"), tmp_path)
    assert name == "Pos-data.txt"
    rows = [line.split("\t") for line in text.splitlines()[1:]]
    assert max(float(row[2]) for row in rows) > 0.04
    yaws_deg = [float(row[6]) for row in rows]  # rules 2: page and file have the same zero
    assert min(abs((yaw_deg - heading_deg + 180) % 360 - 180) for yaw_deg in yaws_deg[-100:]) < 1
    times_s = [float(row[0]) for row in rows]
    assert times_s[0] == 0
    assert times_s == sorted(times_s)
    page.stands("left")
    page.page.click("text=Practise again")
    page.stands("seated")
    page.phase(Phase.PLAYING)


@pytest.mark.long
def test_a_reload_goes_on(practise: Practise) -> None:
    """After a reload the tab has the same seat and level, and its keys work."""
    page = practise()
    page.phase(Phase.PLAYING)
    page.press("Tab", "1")
    page.key_stands(1)
    page.page.reload()
    page.stands("seated")
    page.phase(Phase.PLAYING)
    page.sees(".levels button.on", "B locomotion")
    page.press("2")
    page.key_stands(2)


@pytest.mark.long
def test_own_files_change_while_it_runs(practise: Practise, tmp_path: Path) -> None:
    """During practice a workbook can be loaded, and the pad shows the workbook's keys (rules 2)."""
    sample = sample_gait_files("hexapod")
    assert sample.postures is not None
    table = read_gait(sample.postures.data, "Loco-data.txt")
    assert isinstance(table, PostureTable)
    few = PostureTable({4: table.postures[1], 5: table.postures[2]})
    book = tmp_path / "Loco-data.xlsx"
    book.write_bytes(write_workbook(few, leg_labels(6)))
    page = practise()
    page.stands("seated")
    page.page.click("text=Change files")
    page.find("dialog input[type=file]").set_input_files(book)
    page.sees("dialog .files li:has-text('Level A')", "Loco-data.xlsx")
    page.page.click("text=Use these files")
    page.sees(".lesson", "The gait of your files is loaded")
    page.sees(".key.does[data-key='4']")
    page.sees(".key.none[data-key='1']")
    page.stands("seated")
    page.phase(Phase.PLAYING)
    page.steer(4)

    # Two postures are too few for the sample's sequences, so the test types its own on the page.
    page.page.click("text=Change files")
    page.sees("dialog .files li:has-text('Level B')", "made from Loco-data.xlsx")
    for key, postures in enumerate(("4", "4 5", "", "")):
        page.find(f"[aria-label='Postures of key {key}']").fill(postures)
    # The field that was typed in last has the focus: the click must not miss a button that moves.
    page.page.click("text=Use these files")
    # The match with these files may begin anew a moment later, at level A again.
    end_s = time.monotonic() + LIMIT_S
    while page.find(".key[data-key='1'] small").inner_text() != "2 postures":
        assert time.monotonic() < end_s, "level B has no key 1"
        page.find(".levels button:has-text('B locomotion')").click()
        page.page.wait_for_timeout(300)
    page.steer(1)
    page.sees(".stands", "B 1: posture")


@pytest.mark.long
def test_a_folder_s_workbook_is_all_that_it_takes(practise_in: Practise, tmp_path: Path) -> None:
    """The form shows the folder's files, and the page offers to load a changed file."""
    book = tmp_path / "Loco-data.xlsx"
    sample = sample_gait_files("hexapod")
    assert sample.postures is not None
    table = read_gait(sample.postures.data, "Loco-data.txt")
    assert isinstance(table, PostureTable)
    book.write_bytes(write_workbook(table, leg_labels(6)))
    page = practise_in()
    page.phase(Phase.PLAYING)
    page.press("Tab", "2")
    page.key_stands(2)
    page.sees(".stands", "B 2: posture")
    page.page.click("text=Change files")
    page.sees("dialog .files li:has-text('Level A')", "Loco-data.xlsx")
    page.sees("dialog .files li:has-text('Level B')", "made from Loco-data.xlsx")
    assert page.find("[aria-label='Postures of key 2']").input_value() == "1 2 3 4"
    page.press("Escape")
    page.misses("dialog")

    (tmp_path / "LocoTra-data.txt").write_bytes(
        write_gait(to_locomotion(table, ((0,), (1, 2), (3, 4), (5,), (6, 7))), leg_labels(6))
    )
    page.sees(".changed", "LocoTra-data.txt has changed.")
    page.press("3")  # the robot still walks with the old gait
    page.key_stands(3)
    page.page.click("text=Use it now")
    page.misses(".changed")
    page.phase(Phase.PLAYING)
    page.sees(".key.does[data-key='4']")
    page.press("4")
    page.key_stands(4)

    (tmp_path / "LocoTra-data.txt").write_text("2\n1\n45\n")
    page.sees(".changed summary", "Mistakes in LocoTra-data.txt: ")
    page.page.click(".changed summary")
    page.sees(".changed li", "LocoTra-data.txt · row 2 · column 1")
    page.page.click(".changed [aria-label=Close]")
    page.misses(".changed")


@pytest.mark.long
def test_practice_on_a_phone_in_japanese(practise: Practise) -> None:
    """On a phone the whole pad fits on the screen, and the page is in the browser's language."""
    phone = {"width": 390, "height": 844}
    page = practise(viewport=phone, has_touch=True, is_mobile=True, locale="ja-JP")
    page.phase(Phase.PLAYING)
    page.sees(".lesson", "ゆっくり順番に")
    page.find(".key[data-key='1']").tap()
    page.key_stands(1)
    assert page.page.evaluate("document.documentElement.scrollWidth") <= phone["width"]
    assert page.find('.key[data-key="9"]').is_hidden()  # it does nothing
    for digit in range(9):
        box = page.find(f'.key[data-key="{digit}"]').bounding_box()
        assert box is not None
        assert box["y"] + box["height"] <= phone["height"]


@pytest.mark.long
def test_accessible(practise: Practise) -> None:
    """Axe-core finds no serious mistake on the practice page, in its dialogs and after leaving."""
    pytest.importorskip("axe_core_python")
    page = practise()
    page.phase(Phase.PLAYING)
    page.sees(".lesson")
    assert violations(page.page) == []
    for dialog in ("Settings", "Change files"):
        page.page.click(f"text={dialog}")
        page.sees("dialog")
        assert violations(page.page) == []
        page.press("Escape")
        page.misses("dialog")
    page.press("z")
    page.page.click("text=Save and leave")
    page.stands("left")
    assert violations(page.page) == []
