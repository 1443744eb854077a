"""Tests of /office and /enter: an event from its file until its first games are called."""

import io
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.parse import quote

import pytest
from chromium import OpenPage
from given_files import fragment_of
from office_event import Event, running
from PIL import Image
from playwright.sync_api import FilePayload, Page, expect
from show import violations

from lacoc_robots.library import robot_folder

pytestmark = pytest.mark.slow

LAPTOP = {"width": 1366, "height": 768}
PHONE = {"width": 390, "height": 844}
TEAMS = ("Ants", "六脚の会", "Crabs & <b>Co</b>", "Dogs")
FIRST = TEAMS[0]


@pytest.fixture(scope="module")
def event(built_pages: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Event]:
    """Give a contest whose entries are open; nobody has entered yet."""
    with running(tmp_path_factory.mktemp("event")) as event:
        yield event


def fill(page: Page, event: Event, team: str, code: str = "") -> None:
    """Fill in the form of /enter, with files that have no mistakes."""
    page.goto(f"{event.url}/enter")
    page.locator("input.code").fill(code or event.code.lower())
    page.locator(".field input").nth(1).fill(team)
    page.locator("input[type=file]").set_input_files(list(event.right))
    expect(page.locator(".files li b").nth(2)).to_have_text("LocoTra-data.txt")


def enter(open_page: OpenPage, event: Event, team: str) -> Page:
    """Let a team enter from a browser of its own; return its page."""
    page = open_page(viewport=PHONE)
    fill(page, event, team)
    page.locator("button[type=submit]").click()
    expect(page.locator(".qr img")).to_be_visible()
    expect(page.locator(".state")).to_be_focused()
    expect(page.locator(".state")).to_be_in_viewport(ratio=1)
    return page


@pytest.mark.long(minutes=1)
def test_an_event_from_its_file_to_its_first_game(
    event: Event, open_page: OpenPage, console: Any
) -> None:
    """Teams enter; the organiser approves them, moves and decides a match, and prints papers.

    The organiser needs two commands and four clicks until the first games are called.
    """
    office = open_page(viewport=LAPTOP)
    office.goto(event.office)
    expect(office.locator(".head .code")).to_have_text(event.code)
    assert "#" not in office.url, "the key stays in the address"
    assert violations(office) == []
    before_the_event(open_page, event)
    first = first_team(open_page, event)
    for team in TEAMS[1:-1]:
        enter(open_page, event, team)
    enter_a_workbook(open_page, event, TEAMS[-1])
    enter(open_page, event, "Nobody")
    decline(office, "Nobody")
    keep_strangers_out(office, event)
    rows = office.locator(".entries li")
    expect(rows).to_have_count(len(TEAMS))
    a_card_opens_its_team(office)
    assert violations(office) == []
    approve_and_draw(office)
    see_the_picture(office, FIRST)
    expect(first.locator(".state")).to_contain_text("You are in")
    move(office)
    decide(office)
    late_files(office, first, event)
    papers(office)
    on_a_phone(open_page, event)


def a_card_opens_its_team(office: Page) -> None:
    """The whole card of a team opens it, by mouse and by keyboard, and looks so."""
    card = office.locator(".entries li", has_text=TEAMS[1])
    box = card.bounding_box()
    assert box is not None
    card.click(position={"x": box["width"] / 2, "y": box["height"] - 8})
    title = office.get_by_role("heading", name=TEAMS[1], exact=True)
    expect(title).to_be_visible()
    office.keyboard.press("Escape")
    expect(title).to_be_hidden()
    team = card.get_by_role("button", name=TEAMS[1], exact=True)
    assert team.evaluate("it => getComputedStyle(it, '::before').cursor") == "pointer"
    team.focus()
    office.keyboard.press("Enter")
    expect(title).to_be_visible()
    office.keyboard.press("Escape")
    expect(title).to_be_hidden()


def before_the_event(open_page: OpenPage, event: Event) -> None:
    """The page that follows the director has nothing to show yet: it says so without an alarm."""
    page = open_page(viewport=PHONE)
    page.goto(f"{event.url}/watch?director=1&q=low")
    card = page.locator(".event")
    expect(card).to_contain_text("Not drawn yet")
    expect(page.locator(".banner")).to_have_count(0)
    assert violations(page) == []


def first_team(open_page: OpenPage, event: Event) -> Page:
    """Enter with a wrong code, with mistakes, then rightly; a reload keeps the team's link."""
    page = open_page(viewport=LAPTOP)
    fill(page, event, FIRST, "AAAAAA")
    page.locator("button[type=submit]").click()
    expect(page.get_by_role("alert")).to_contain_text("not the code")
    page.locator("input.code").fill(event.code)
    page.locator("input[type=file]").set_input_files(event.wrong)
    page.locator("button[type=submit]").click()
    expect(page.locator(".mistakes li")).to_have_count(3)
    expect(page.locator(".why > p")).to_be_focused()
    expect(page.locator(".why > p")).to_be_in_viewport(ratio=1)
    assert violations(page) == []
    page.locator("input[type=file]").set_input_files([event.right[1], event.cut])
    expect(page.locator(".files li b").nth(1)).to_have_text("Loco-data.xlsx")
    page.locator("button[type=submit]").click()
    expect(page.get_by_role("alert")).to_contain_text(
        "Your files have 1 mistake. Nothing was entered."
    )
    expect(page.locator(".mistakes li")).to_have_count(1)
    expect(page.locator(".mistakes")).to_contain_text("Loco-data.xlsx")
    give_a_picture(page)
    page.locator("input[type=file]").set_input_files(list(event.right))
    expect(page.locator(".files li b").nth(2)).to_have_text("LocoTra-data.txt")
    page.locator("button[type=submit]").click()
    expect(page.locator(".qr img")).to_be_visible()
    expect(page.get_by_role("status").first).to_contain_text("waits for the organiser")
    page.reload()
    expect(page.locator("h1")).to_have_text(FIRST)
    expect(page.get_by_role("link", name="To your matches")).to_be_visible()
    assert violations(page) == []
    return page


def give_a_picture(page: Page) -> None:
    """Give a picture of the team; what is none is told, and changes nothing."""
    picture = io.BytesIO()
    Image.new("RGB", (640, 480), "green").save(picture, "PNG")
    files = page.locator("input[type=file]")
    shown = page.get_by_role("img", name="Picture of the team")
    files.set_input_files(FilePayload(name="x.png", mimeType="image/png", buffer=b"no"))
    expect(page.locator(".toast")).to_contain_text("x.png is no picture")
    expect(shown).to_have_count(0)
    files.set_input_files(
        FilePayload(name="we.png", mimeType="image/png", buffer=picture.getvalue())
    )
    expect(shown).to_be_visible()


def see_the_picture(office: Page, team: str) -> None:
    """Everybody sees the picture of a team that is in, until the organiser takes it away."""
    contest = office.context.new_page()
    contest.goto(office.url.partition("/office")[0] + f"/contest#team={quote(team)}")
    picture = contest.locator(".one-team .team-picture")
    expect(picture).to_be_visible()
    assert picture.evaluate("it => it.naturalWidth") > 0
    office.locator(".entries li", has_text=team).get_by_role("button", name=team).click()
    expect(office.get_by_role("img", name=f"Picture of {team}")).to_be_visible()
    assert violations(office) == []
    office.get_by_role("button", name="Take the picture away").click()
    expect(office.get_by_role("button", name="Take the picture away")).to_have_count(0)
    office.keyboard.press("Escape")
    expect(picture).to_have_count(0)
    contest.close()


def enter_a_workbook(open_page: OpenPage, event: Event, team: str) -> None:
    """Enter with a workbook alone, after a look at the sample; level B is made of either."""
    page = open_page(viewport=PHONE)
    handed_on = {"name": "歩容.txt", "data": event.right[0].read_bytes()}
    page.goto(f"{event.url}/enter{fragment_of({'postures': handed_on})}")
    expect(page.locator(".files li b").nth(1)).to_have_text("歩容.txt")
    assert "#" not in page.url
    page.get_by_role("button", name="Remove 歩容.txt").click()
    page.get_by_role("button", name="Take the sample gait").click()
    expect(page.locator(".files li b").nth(2)).to_have_text("made from Loco-data.txt")
    fill(page, event, team)
    page.get_by_role("button", name="Remove LocoTra-data.txt").click()
    book = robot_folder("hexapod") / "Loco-data.xlsx"
    page.locator("input[type=file]").set_input_files(book)
    expect(page.locator(".files li b").nth(2)).to_have_text("made from Loco-data.xlsx")
    page.locator("button[type=submit]").click()
    expect(page.locator(".qr img")).to_be_visible()


def decline(office: Page, team: str) -> None:
    """Decline a team; the page asks first, and Escape declines nobody."""
    row = office.locator(".entries li", has_text=team)
    dialog = office.get_by_role("dialog", name=f"Decline {team}")
    office.get_by_role("button", name=f"Decline {team}").click()
    expect(dialog).to_contain_text("forgets this application")
    assert violations(office) == []
    office.keyboard.press("Escape")
    expect(dialog).to_have_count(0)
    expect(row).to_have_attribute("data-state", "waits")
    office.get_by_role("button", name=f"Decline {team}").click()
    dialog.get_by_role("button", name="Decline").click()
    expect(row).to_have_count(0)


def keep_strangers_out(office: Page, event: Event) -> None:
    """Look at what all who wait would lose, keep them, and make another event code."""
    office.get_by_role("button", name=f"Decline all {len(TEAMS)}").click()
    everybody = office.get_by_role("dialog", name=f"Decline all {len(TEAMS)}")
    expect(everybody).to_contain_text(TEAMS[-1])
    assert violations(office) == []
    office.keyboard.press("Escape")
    office.get_by_role("button", name="New code").click()
    dialog = office.get_by_role("dialog", name="New code")
    expect(dialog).to_contain_text("nobody can apply any more")
    assert violations(office) == []
    dialog.get_by_role("button", name="New code").click()
    expect(dialog).to_have_count(0)
    expect(office.locator(".head .code")).not_to_have_text(event.code)


def approve_and_draw(office: Page) -> None:
    """Approve all teams: until the draw, they stand above the timetable; then draw."""
    expect(office.locator(".head .title")).to_contain_text(f"{len(TEAMS)} wait for you")
    office.get_by_role("button", name=f"Approve all {len(TEAMS)}").click()
    expect(office.locator('.entries li[data-state="in"]')).to_have_count(len(TEAMS))
    expect(office.locator(".head .title")).not_to_contain_text("wait for you")
    expect(office.locator(".entries ~ .timetable .slot").first).to_contain_text("seed")
    office.get_by_role("button", name="Close entries and draw").click()
    expect(office.get_by_role("dialog")).to_contain_text("4 teams take part")
    office.get_by_role("button", name="Close and draw with 4 teams").click()
    expect(office.locator('.slot[data-state="running"]')).to_have_count(2)
    assert violations(office) == []


def move(office: Page) -> None:
    """Move a match with its button, without dragging it."""
    office.locator('.slot[data-state="open"] button').last.click()
    dialog = office.get_by_role("dialog", name="Move a match")
    assert violations(office) == []
    dialog.locator("select").first.select_option("main-2")
    dialog.get_by_role("button", name="Move").click()
    expect(office.locator(".moved")).to_have_count(1)
    assert (
        office.locator(".column", has=office.locator(".moved")).get_attribute("aria-label")
        == "Court main-2"
    )


def decide(office: Page) -> None:
    """Decide a match; the page shows what the decision changes before it can be made."""
    line = office.locator(".rulings li").first
    line.get_by_role("button").click()
    dialog = office.get_by_role("dialog")
    go = dialog.get_by_role("button", name="Decide this")
    points = dialog.locator(".points input")
    expect(dialog.locator(".effects")).to_be_empty()
    points.nth(0).fill("3")
    points.nth(1).fill("9")
    expect(dialog.locator(".effects li").first).to_contain_text("round 1 (")
    expect(go).to_be_disabled()
    assert violations(office) == []
    dialog.get_by_label("A team did not come").check()
    teams = dialog.locator(".absent label")
    expect(teams).to_have_count(2)
    teams.first.click()
    expect(dialog.locator(".effects li").first).to_contain_text(teams.nth(1).inner_text())
    assert violations(office) == []
    dialog.get_by_label("The game counts with this result").check()
    dialog.get_by_label("Reason").fill("the scores were swapped")
    go.click()
    expect(dialog).to_have_count(0)
    expect(office.locator(".rulings .score").first).to_have_text("3 : 9")
    office.locator(".rulings li").first.get_by_role("button").click()
    expect(dialog.locator(".points p")).to_contain_text("3 : 9")
    office.keyboard.press("Escape")


def late_files(office: Page, team: Page, event: Event) -> None:
    """Replace files after entries closed: they wait until the organiser approves with a reason."""
    changed = event.right[1].with_name("LocoTra-late.txt")
    changed.write_bytes(event.right[1].read_bytes() + b"\n")
    team.get_by_text("Replace the files", exact=True).click()
    team.locator("input[type=file]").set_input_files(changed)
    team.get_by_role("button", name="Weigh in and replace").click()
    expect(team.locator(".state")).to_contain_text("after entries were closed")
    expect(team.locator(".state")).to_be_focused()
    expect(team.locator(".state")).to_be_in_viewport(ratio=1)
    office.get_by_role("button", name=f"Approve {FIRST}").first.click()
    dialog = office.get_by_role("dialog")
    expect(dialog.get_by_role("button", name="Approve")).to_be_disabled()
    dialog.get_by_label("Reason").fill("the motor limit was misread")
    dialog.get_by_role("button", name="Approve").click()
    expect(team.locator(".state")).to_contain_text("You are in. Your files")


def papers(office: Page) -> None:
    """Check that each paper has the right content, and that its buttons are not printed."""
    for paper, content in (
        ("schedule", "main-1"),
        ("results", "3:9"),
        ("certificates", "No team has its final place"),
        ("links", "/play#token="),
        ("links", "/referee?court=main-2#token="),
    ):
        office.get_by_label("Print …").select_option(paper)
        expect(office.locator(".papers")).to_contain_text(content)
        assert violations(office) == []
        office.emulate_media(media="print")
        expect(office.locator(".paper-tools")).not_to_be_visible()
        office.emulate_media(media="screen")
        office.get_by_role("button", name="Back").click()


def on_a_phone(open_page: OpenPage, event: Event) -> None:
    """On a phone in Japanese nothing scrolls sideways, and axe-core finds no serious mistake."""
    for path in (event.office, f"{event.url}/enter"):
        page = open_page(viewport=PHONE, has_touch=True, is_mobile=True, locale="ja-JP")
        page.goto(path)
        expect(page.locator("h1")).not_to_have_text("")
        if path == event.office:
            expect(page.locator(".timetable")).to_be_visible()
        for element in ("document.documentElement", "document.querySelector('main')"):
            assert page.evaluate(f"{element}.scrollWidth") <= PHONE["width"]
        assert violations(page) == []


@pytest.fixture
def waiting(built_pages: Path, tmp_path: Path) -> Iterator[Event]:
    """Give a contest of two teams whose finals wait for the organiser's draw."""
    with running(tmp_path, "Ants", "Bees", waits=True) as event:
        yield event


@pytest.mark.long
def test_finals_wait_for_the_organiser(waiting: Event, open_page: OpenPage) -> None:
    """When the groups are over, the organiser sees who is in the finals, and draws them."""
    office = open_page(viewport=LAPTOP)
    office.goto(waiting.office)
    office.get_by_role("button", name="Close entries and draw").click()
    office.get_by_role("button", name="Close and draw with 2 teams").click()
    draw = office.get_by_role("button", name="Draw Knockout")
    expect(office.locator('.slot[data-state="running"]')).to_have_count(1)
    expect(draw).to_have_count(0)
    office.locator(".slot").get_by_role("button", name="Decide about").click()
    points = office.get_by_role("dialog").locator(".points input")
    points.nth(0).fill("3")
    points.nth(1).fill("9")
    first = office.get_by_role("dialog").locator(".points span").nth(1).inner_text()
    effects = office.get_by_role("dialog").locator(".effects")
    expect(effects).to_contain_text("Knockout then waits for the organiser's draw, with")
    office.get_by_label("Reason").fill("the court is not ready")
    office.get_by_role("button", name="Decide this").click()
    draw.click()
    dialog = office.get_by_role("dialog", name="Draw Knockout")
    expect(dialog.locator(".seeds li")).to_have_count(2)
    winner = dialog.locator(".seeds li b").first.inner_text()
    assert winner in first
    assert violations(office) == []
    phone = open_page(viewport=PHONE, has_touch=True, is_mobile=True, locale="ja-JP")
    phone.goto(waiting.office)
    expect(phone.get_by_role("button", name="組み合わせを決定")).to_be_visible()
    assert phone.evaluate("document.documentElement.scrollWidth") <= PHONE["width"]
    assert violations(phone) == []
    dialog.get_by_role("button", name="Draw with 2 teams").click()
    expect(dialog).to_have_count(0)
    expect(draw).to_have_count(0)
    expect(office.locator(".slot", has_text="Final")).to_have_count(1)


@pytest.mark.long
def test_a_wrong_key_opens_no_office(event: Event, open_page: OpenPage) -> None:
    """With a wrong key the page shows no entries, and says why."""
    page = open_page(viewport=LAPTOP)
    page.goto(f"{event.url}/office#token=guess")
    expect(page.get_by_role("alert")).to_contain_text("does not open")
    assert page.locator(".entries").count() == 0
