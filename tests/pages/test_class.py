"""Tests of /class, the teacher's page of `lacoc class`, with real students (docs/studio.md 8)."""

import os
import signal
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest
from chromium import OpenPage
from class_room import ClassRoom, StudentPage
from contestant import Contestant
from playwright.sync_api import expect
from show import violations

from lacoc_client.web.gateway.wire import MessageKind
from lacoc_robots.library import sample_gait_files

pytestmark = pytest.mark.slow

FINISHED = """(name) => {
  const { cards } = window.__class;
  const done = (card) => ({ ...card, states: card.states.map(() => "met"), best_mm_s: 84.4 });
  cards.value = cards.value.map((card) => (card.name === name ? done(card) : card));
}"""
SEQUENCES = [[0], [4, 3, 2, 1], [1, 2, 3, 4]]


class Desk(Contestant):
    """The teacher at the page."""

    def begin(self, key: str) -> None:
        """Open the page and wait for the students' cards."""
        self.open("/class", key)
        self.sees(".student")

    def card(self, student: str) -> str:
        """Return the selector of a student's card."""
        return f".student[data-student={student!r}]"

    def order(self) -> list[str]:
        """Return the names on the cards, in the order of the page."""
        cards = self.find(".student")
        return [str(one) for one in cards.evaluate_all("all => all.map(x => x.dataset.student)")]

    def comes_first(self, *students: str) -> None:
        expect(self.find(".student b").first).to_have_text(students[0])
        assert tuple(self.order()[: len(students)]) == students

    def focuses(self, selector: str) -> None:
        self.find(selector).first.focus()


@pytest.fixture(scope="module")
def room(tmp_path_factory: pytest.TempPathFactory, built_pages: Path) -> Iterator[ClassRoom]:
    """Give a class that runs during the module; tests have students of their own."""
    room = ClassRoom(tmp_path_factory.mktemp("class"))
    yield room
    room.close()


@pytest.fixture
def closing() -> Iterator[ExitStack]:
    """Give a stack that closes students' pages at the end of a test."""
    with ExitStack() as stack:
        yield stack


def comes(closing: ExitStack, room: ClassRoom, name: str) -> StudentPage:
    """Let a student in, until the end of the test."""
    page = room.student(name)
    closing.callback(page.close)
    return page


def edits(student: StudentPage) -> dict[str, Any]:
    """Let a student change the first number of the sample table; return the student's table."""
    table = student.sample()
    for angle_deg in (0.0, 3.0):
        first, *others = table["rows"]
        row = {**first, "angles_deg": [angle_deg, *first["angles_deg"][1:]]}
        table = {**table, "rows": [row, *others]}
        student.edits(table, sequences=SEQUENCES)
    return table


def tries(student: StudentPage) -> None:
    student.until(lambda: student.last(MessageKind.STUDIO).get("present"))
    student.ask("trial", table=edits(student), sequences=SEQUENCES, keys="2")


@pytest.mark.long
def test_a_raised_hand_comes_first_and_is_taken_down_by_keyboard(
    open_page: OpenPage, room: ClassRoom, closing: ExitStack
) -> None:
    """A card with a raised hand comes first once the pointer is off the cards; Enter lowers it."""
    ada, bob = comes(closing, room, "Ada"), comes(closing, room, "Bob")
    desk = Desk(open_page, room.url, viewport={"width": 1280, "height": 720})
    desk.begin(room.key)
    desk.sees(".code b", room.code)
    desk.sees(".address b", room.listen)
    tries(ada)
    expect(desk.find(f"{desk.card('Ada')} .speeds small")).not_to_have_text("–")
    assert desk.number(f"{desk.card('Ada')} .speeds small") > 30
    desk.sees(f"{desk.card('Ada')} svg.feet")
    # As narrow as one of thirty cards, it still has its figures inside.
    narrow = "(card) => { card.style.width = '157px'; return card.scrollWidth - card.clientWidth; }"
    assert desk.find(desk.card("Ada")).evaluate(narrow) == 0
    before = desk.order()

    desk.page.hover(desk.card("Ada"))
    desk.sees(".holds")
    bob.ask("hand", up=True)
    desk.sees(f"{desk.card('Bob')}[data-need=hand]")
    assert desk.order() == before
    desk.page.mouse.move(5, 5)
    desk.misses(".holds")
    desk.comes_first("Bob")
    assert not violations(desk.page)

    desk.focuses(desk.card("Bob"))
    desk.press("Enter")
    desk.sees(".details", "hand up")
    assert not violations(desk.page)
    desk.focuses(".states button")
    desk.press("Enter")
    bob.until(lambda: not bob.phases["hand_up"])
    desk.misses(".states [data-need=hand]")
    desk.press("Escape")
    desk.misses(".details")


def test_the_teacher_sets_rules_hands_out_and_takes_home(
    open_page: OpenPage, room: ClassRoom, closing: ExitStack, tmp_path: Path
) -> None:
    """The teacher closes a phase and the coach, hands out a file, and downloads the evidence."""
    cem = comes(closing, room, "Cem")
    desk = Desk(open_page, room.url, viewport={"width": 1280, "height": 720})
    desk.begin(room.key)
    desk.find(".phases input").nth(5).uncheck()
    desk.find("select[name=coach]").select_option("none")
    desk.find("input[name=explain-first]").check()
    rules = {"closed": [5], "coach": "none", "explain_first": True}
    cem.until(lambda: cem.phases["rules"] == rules)
    desk.find("select[name=coach]").select_option("table")
    cem.until(lambda: cem.phases["rules"] == {**rules, "coach": "table"})

    postures = sample_gait_files("hexapod").postures
    assert postures is not None
    desk.page.set_input_files(
        "input[type=file]",
        {"name": "Crab walk.txt", "mimeType": "text/plain", "buffer": postures.data},
    )
    expect(desk.find(".handout input")).to_have_value("Crab walk")
    expect(desk.find(".handout input")).to_be_focused()
    desk.press("Enter")
    desk.is_toasted("Crab walk")
    cem.until(lambda: cem.last(MessageKind.HANDED).get("title") == "Crab walk")
    assert cem.last(MessageKind.HANDED)["table"] == cem.sample()
    broken = {"name": "broken.txt", "mimeType": "text/plain", "buffer": b"1\tx\t3\n"}
    desk.page.set_input_files("input[type=file]", broken)
    desk.sees(".mistakes", "broken.txt")
    desk.press("Escape")

    name, text = desk.download(lambda: desk.page.click("text=Evidence (CSV)"), tmp_path)
    assert name.endswith(".csv")
    assert "Cem" in text
    desk.page.click("text=Certificates …")
    desk.sees(".papers", "Nobody has finished all six phases yet.")
    # What the page gets of a student who has: the phases themselves are done elsewhere.
    desk.page.evaluate(FINISHED, "Cem")
    desk.find(".certificate .name").fill("Cem Öz")
    desk.sees(".certificate", "has designed a gait of their own")
    desk.page.click("text=Back")
    desk.sees(".student")


@pytest.mark.long
def test_projector_mode_hides_names_everywhere(
    open_page: OpenPage, room: ClassRoom, closing: ExitStack
) -> None:
    """Projector mode shows no student's name on cards, details or big screen, even on a reload."""
    dan, eva = comes(closing, room, "Danilo"), comes(closing, room, "Evangeline")
    tries(dan)
    tries(eva)
    desk = Desk(open_page, room.url, viewport={"width": 390, "height": 844}, locale="ja-JP")
    desk.begin(room.key)
    desk.sees(desk.card("Evangeline"), "Evangeline")
    width = desk.page.evaluate("document.querySelector('.desk').scrollWidth")
    assert width == 390
    desk.page.click(".projector")
    expect(desk.find(".projector")).to_have_attribute("aria-pressed", "true")
    desk.page.reload()
    desk.sees(desk.card("Evangeline"))
    expect(desk.find("body")).not_to_contain_text("Evangeline")
    label = desk.find(f"{desk.card('Evangeline')} b").first.inner_text()
    assert label.startswith("ロボット")
    assert not violations(desk.page)

    desk.page.click(desk.card("Evangeline"))
    desk.sees(".details")
    assert desk.find("dialog h2").inner_text() == label
    desk.page.click(".details .acts button >> nth=0")
    desk.sees(".walking h2", label)
    desk.sees(".walking .view")
    desk.until("(window.__lacoc?.view?.drawnFrames ?? 0) > 0")
    assert desk.number(".big-speed b") > 20
    expect(desk.find("body")).not_to_contain_text("Evangeline")
    assert not violations(desk.page)
    desk.press("ArrowRight")
    expect(desk.find(".walking h2")).not_to_have_text(label)
    desk.press("ArrowLeft")
    expect(desk.find(".walking h2")).to_have_text(label)
    desk.press("Escape")
    desk.misses(".screen")
    expect(desk.find(desk.card("Evangeline"))).to_be_focused()


@pytest.mark.long
def test_the_page_goes_on_after_the_gateways_end(
    open_page: OpenPage, built_pages: Path, tmp_path: Path, closing: ExitStack, console: Any
) -> None:
    """The teacher's page finds a restarted gateway again, and asks before it deletes a student."""
    console.expect_a_break()
    room = ClassRoom(tmp_path)
    for name in ("Kim", "Lea"):
        edits(comes(closing, room, name))
    desk = Desk(open_page, room.url)
    desk.begin(room.key)
    os.kill(room.process.pid, signal.SIGKILL)
    room.process.communicate()
    desk.sees(".banner")
    again = ClassRoom(tmp_path, room.listen)
    closing.callback(again.close)
    desk.sees(f"{desk.card('Kim')}[data-online=false]")

    desk.page.click(desk.card("Kim"))
    desk.page.click(".details .acts .danger")
    desk.sees(".forget", "Kim")
    desk.page.click(".forget .danger")
    desk.misses(desk.card("Kim"))
    assert desk.order() == ["Lea"]


@pytest.mark.long
def test_a_tournament_ends_in_large_standings(
    open_page: OpenPage, room: ClassRoom, closing: ExitStack
) -> None:
    """Projector mode shows a tournament's standings without names; each match has its replay."""
    for name in ("Mia", "Nils"):
        edits(comes(closing, room, name))
    desk = Desk(open_page, room.url, viewport={"width": 1280, "height": 720})
    desk.begin(room.key)
    desk.focuses("#tab-rules")
    desk.press("ArrowRight")
    expect(desk.find("#tab-play")).to_be_focused()
    desk.page.get_by_label("Opponents of each").fill("1")
    desk.page.get_by_label("Seconds a match").fill("10")
    desk.page.click(".projector")
    desk.page.click(".start button[type=submit]")
    desk.sees(".big-standings tbody tr")
    expect(desk.find("body")).not_to_contain_text("Nils")
    assert not violations(desk.page)
    desk.press("Escape")
    desk.misses(".screen")
    desk.misses(".matches a")
    desk.page.click(".projector")
    left, _, right = desk.find(".matches .sides").first.inner_text().partition(" – ")
    with desk.page.expect_popup() as opened:
        desk.page.click(".matches a >> nth=0")
    replay = opened.value
    for name in (left, right):
        expect(replay.locator("body")).to_contain_text(name)
    replay.close()
