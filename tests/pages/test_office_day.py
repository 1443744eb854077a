"""Tests of the day on /office: pause, later, a line to all, staff, publishing."""

import re
from collections.abc import Iterator

import pytest
from chromium import OpenPage
from office_event import Event, running
from playwright.sync_api import Page, expect
from show import covered, violations

pytestmark = pytest.mark.slow

LAPTOP = {"width": 1366, "height": 768}
PHONE = {"width": 390, "height": 844}
TEAMS = ("Ants", "Bees", "Crabs", "Dogs")


@pytest.fixture(scope="module")
def event(built_pages: object, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Event]:
    """Give a contest of four teams of people, whose entries are open."""
    with running(tmp_path_factory.mktemp("day"), *TEAMS) as event:
        yield event


def press(page: Page, name: str) -> None:
    """Press a button of the page itself."""
    page.locator("main").get_by_role("button", name=name, exact=True).click()


def confirm(page: Page, name: str) -> None:
    """Press a button of the open dialog, which closes it."""
    page.locator("dialog[open]").get_by_role("button", name=name, exact=True).click()
    expect(page.locator("dialog[open]")).to_have_count(0)


def say(page: Page, label: str, text: str) -> None:
    page.locator("dialog").get_by_label(label).fill(text)


def nothing_is_covered(watch: Page, event: Event, open_page: OpenPage) -> None:
    """A line to all covers no head of /referee and no button of /play.

    The bar of /watch covers no rule.
    """
    for size in (PHONE, {"width": 1280, "height": 800}):
        referee = open_page(viewport=size)
        referee.goto(f"{event.url}/referee")
        expect(referee.locator(".banner")).to_contain_text("Lunch until one")
        expect(referee.locator(".top h1")).to_be_visible()
        assert bottom(referee, ".banner") <= top(referee, ".top h1")
        referee.close()
        player = open_page(viewport=size)
        player.goto(f"{event.url}/play")
        expect(player.locator(".banner")).to_contain_text("Lunch until one")
        expect(player.get_by_role("button", name="Test my connection")).to_be_visible()
        assert covered(player, ".banner", "main :is(button, a, input):not(.banner *)") == []
        assert covered(player, ".entrance", ".corner button") == []
        player.close()
    watch.set_viewport_size({"width": 1280, "height": 800})
    expect(watch.locator(".opening .rules")).to_be_visible()
    expect(watch.locator(".foot .cheers")).to_be_visible()
    watch.wait_for_function(
        "document.querySelector('.opening').getBoundingClientRect().bottom"
        " <= document.querySelector('.foot').getBoundingClientRect().top"
    )
    watch.set_viewport_size(LAPTOP)


def top(page: Page, selector: str) -> float:
    box = page.locator(selector).bounding_box()
    assert box is not None
    return box["y"]


def bottom(page: Page, selector: str) -> float:
    box = page.locator(selector).bounding_box()
    assert box is not None
    return box["y"] + box["height"]


@pytest.mark.long
def test_a_day_is_steered_on_the_page(event: Event, open_page: OpenPage) -> None:
    """The organiser steers the day; everybody reads it, and the staff decide under their names."""
    office = open_page(viewport=LAPTOP)
    office.goto(event.office)
    press(office, "Close entries and draw")
    confirm(office, "Close and draw with 4 teams")
    expect(office.locator(".slot")).not_to_have_count(0)
    expect(office.locator(".slot", has_text="Final").first).to_be_visible()
    expect(office.locator(".slot", has_text="winner of Semi-final 1").first).to_be_visible()
    assert violations(office) == []

    contest = open_page(viewport=PHONE)
    contest.goto(f"{event.url}/contest")
    watch = open_page(viewport=LAPTOP)
    watch.goto(f"{event.url}/watch")
    press(office, "Line to all")
    say(office, "All pages show this line", "Lunch until one")
    confirm(office, "Show it")
    for page in (contest, watch):
        expect(page.locator(".banner")).to_contain_text("Lunch until one")
    nothing_is_covered(watch, event, open_page)

    press(office, "Pause")
    say(office, "Reason, if you like (everybody can read it)", "a cable")
    confirm(office, "Pause now")
    for page in (office, contest):
        pause = page.locator(".pause")
        expect(pause).to_contain_text("A pause, until the organiser goes on. (a cable)")
        expect(pause).to_contain_text(re.compile("Then: Group stage|Then: Round robin"))
    expect(office.locator(".slot .time", has_text="from ").first).to_be_visible()
    expect(watch.locator(".banner")).to_contain_text("a cable")
    watch.locator(".banner button").click()
    expect(watch.locator(".banner")).to_have_count(0)
    press(office, "Go on")
    expect(office.locator(".day [role=status]")).to_have_count(0)
    expect(contest.locator(".banner")).not_to_contain_text("a cable")
    expect(watch.locator(".banner")).to_have_count(0)  # the line was read before

    press(office, "All later")
    confirm(office, "15 minutes later")
    expect(office.locator(".day [role=status]")).to_contain_text("A pause until")
    expect(contest.locator(".coming .expected").first).to_contain_text("not before")
    assert violations(office) == []
    press(office, "Take the 15 minutes back")
    expect(office.locator(".day [role=status]")).to_have_count(0)  # the buttons move then

    press(office, "Staff")
    say(office, "Name", "Aiko")
    office.locator("dialog").get_by_role("button", name="Make a link").click()
    link = office.locator("dialog .staff a")
    expect(link).to_have_text(re.compile(r"/office#token="))
    expect(office.locator("dialog .staff").get_by_role("button", name="Copy")).to_be_visible()
    expect(office.locator("dialog .referees a").first).to_have_text(re.compile("/referee.court="))
    helper = open_page(viewport=PHONE)
    helper.goto(link.inner_text())
    expect(helper.locator(".day")).to_contain_text("You decide as Aiko.")
    expect(helper.get_by_role("button", name="Staff")).to_have_count(0)
    assert violations(helper) == []
    office.keyboard.press("Escape")

    press(helper, "Publish")
    published = helper.get_by_role("link", name="The published contest")
    expect(helper.locator(".folder")).to_contain_text(str(event.facts.parent / "contest-published"))
    published.click()
    expect(helper.locator("h1")).to_be_visible()
    assert "/published/" in helper.url
