"""Tests of the referee's page at a real court and gateway."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from chromium import OpenPage
from playwright.sync_api import Locator, Page, expect
from show import decide, violations
from venue import REFEREE, TOKENS, Venue

from lacoc_client.play.referee import RefereeClient
from lacoc_client.web.gateway.browser import unseen
from lacoc_client.web.gateway.wire import MessageKind
from lacoc_shared import decisions as d
from lacoc_shared.network.session import open_client

pytestmark = pytest.mark.slow

JAPANESE_NAMES = re.compile(
    r"Kim|Ants|Bees|Left|Right|Hexapod|LACOC|Robot-Othello|Ctrl|Enter|main|MuJoCo|lacoc web"
)

HOLD_MESSAGES = """
kind => {
  const send = WebSocket.prototype.send;
  WebSocket.prototype.send = function (data) {
    WebSocket.prototype.send = send;
    const { onmessage } = this, held = [];
    this.onmessage = event => {
      if (new Uint8Array(event.data)[0] === kind) held.push(event);
      else onmessage.call(this, event);
    };
    window.letGo = () => held.forEach(event => onmessage.call(this, event));
    send.call(this, data);
  };
}
"""
"""Program for a page: from its next request on, it holds back one kind of message."""

Referee = Callable[..., Page]

ONLY = "it is possible only while the match is"
IN_LOBBY = "Now the match is in the lobby"


@pytest.fixture
def court(venue: Venue) -> Venue:
    """Give a contest whose court is in the lobby and whose gateway runs."""
    venue.court()
    venue.web()
    return venue


@pytest.fixture
def referee(venue: Venue, open_page: OpenPage) -> Referee:
    """Give a function that opens the referee's page, each time in a fresh browser context."""

    def opened(size: tuple[int, int] = (1366, 768), query: str = "") -> Page:
        page = open_page(viewport={"width": size[0], "height": size[1]})
        page.goto(f"{venue.url}/referee{query}")
        expect(page.locator(".score-bug")).to_be_visible()
        return page

    return opened


def enter(page: Page, name: str = "Kim", token: str = REFEREE) -> None:
    page.locator("input[name=by]").fill(name)
    page.locator("input[name=token]").fill(token)
    page.locator(".enter button[type=submit]").click()


def at_the_desk(page: Page, name: str = "Kim") -> Page:
    """Enter as the acting referee, and return the page."""
    enter(page, name)
    expect(page.locator(".acting.mine")).to_be_visible()
    return page


def big(page: Page) -> Locator:
    return page.locator(".big .act")


def step(page: Page, key: str = "") -> None:
    """Wait until the big button accepts a press, then click it or press the given key."""
    expect(page.locator(".big.fresh")).to_have_count(0)
    if key:
        page.keyboard.press(key)
    else:
        big(page).click()


def phase(page: Page, number: int) -> None:
    """Wait until the page shows this phase."""
    expect(page.locator("main.referee")).to_have_attribute("data-phase", str(number))


def group(page: Page, name: str) -> Locator:
    """Find a button of the match card."""
    return page.locator(".groups").get_by_role("button", name=name, exact=True)


def seat(page: Page, index: int, name: str) -> Locator:
    """Find a button of a seat's card."""
    return page.locator(f".seat[data-seat='{index}']").get_by_role("button", name=name, exact=True)


def log_has(page: Page, text: str) -> None:
    expect(page.locator(".log")).to_contain_text(text)


def confirm(page: Page, chip: str | None = None, words: str = "") -> None:
    """Choose or type a reason in the open dialog and confirm; wait until the dialog closes."""
    dialog = page.get_by_role("dialog")
    if chip:
        expect(dialog.locator("[type=submit]")).to_be_disabled()
        dialog.locator("label.chip", has_text=re.compile(f"^{chip}$")).click()
    if words:
        dialog.locator("input[name=words]").fill(words)
    dialog.locator("[type=submit]").click()
    expect(dialog).to_have_count(0)


def why(button: Locator) -> str:
    """Return the text that tells a screen reader why a button can't be pressed."""
    expect(button).to_have_attribute("aria-disabled", "true")
    described = button.get_attribute("aria-describedby")
    return button.page.locator(f"[id='{described}']").inner_text()


def scores(page: Page) -> list[str]:
    return page.locator(".score-bug .points").all_inner_texts()


def has_scores(page: Page, *points: int) -> None:
    expect(page.locator(".score-bug .points")).to_have_text([str(point) for point in points])


def disc(page: Page, name: str) -> Locator:
    return page.locator(f".board g[data-marker='{name}']")


def start(page: Page, venue: Venue) -> None:
    """Begin a match's countdown; a busy browser may not show a second or two of play."""
    venue.contestant("left", "Ants")
    venue.contestant("right", "Bees")
    phase(page, 2)
    step(page)


def to_playing(page: Page, venue: Venue) -> None:
    start(page, venue)
    phase(page, 4)


def test_a_referees_link_has_the_token(court: Venue, open_page: OpenPage) -> None:
    """With the link that the organiser prints, a referee types only their name."""
    page = open_page()
    page.goto(f"{court.url}/referee#token={REFEREE}")
    page.locator("input[name=by]").fill("Kim")
    page.locator(".enter button[type=submit]").click()
    expect(page.locator(".acting.mine")).to_be_visible()
    assert "#" not in page.url, "the token stays in the address"


@pytest.mark.long
def test_a_replay_is_advised(venue: Venue, referee: Referee) -> None:
    """If a match ran too slowly, the page advises a rematch and says why, in both languages."""
    wanted = "[health]\nreal_time_factor = 2.0\n"  # no court can be so fast
    venue.contest.write_text(wanted + venue.contest.read_text())
    venue.court("--seconds", "2")
    venue.web()
    page, other = at_the_desk(referee()), referee(query="?lang=ja")
    start(page, venue)
    phase(page, 6)
    advice = page.locator(".match .advice")
    expect(advice).to_contain_text("times real time (at least 2 is required)")
    log_has(page, "A rematch is advised: the match ran at ")
    expect(other.locator(".match .advice h3")).to_have_text("再試合を推奨")
    expect(other.locator(".match .advice li").first).to_contain_text("実時間の")
    step(page)  # the referee may still make the result official
    confirm(page)
    phase(page, 7)
    expect(advice).to_be_visible()


@pytest.mark.long
def test_every_decision_to_official_and_next(court: Venue, referee: Referee) -> None:
    """The referee makes each kind of decision on the page, and the log shows each."""
    page = at_the_desk(referee())
    # In the lobby: the page lists what is missing, and the referee says ready for a contestant.
    expect(page.locator(".missing li")).to_have_text(
        ["left: nobody has joined", "right: nobody has joined"]
    )
    ants = court.page(court.key, hz=50)
    ants.ask("join", seat="left", token=TOKENS["left"], name="Ants")
    expect(page.locator(".missing li")).to_have_text(
        ["Ants has not said ready", "right: nobody has joined"]
    )
    expect(big(page)).to_have_attribute("aria-disabled", "true")
    seat(page, 0, "Say ready").click()
    log_has(page, "Referee Kim: Ants is set to ready.")
    court.contestant("right", "Bees")
    phase(page, 2)
    step(page, "Control+Enter")
    log_has(page, "Referee Kim: play begins in 1 second.")
    expect(page.locator(".answer.yes")).to_have_text(
        re.compile(r"^✓ Done Play begins in 1 second\. [1-9]\d* s ago$")
    )
    phase(page, 4)
    expect(page.locator(".answer")).to_have_count(0)  # it was of another phase
    # While the match is played.
    seat(page, 0, "Restart").click()
    confirm(page, "fell over")
    log_has(page, "Referee Kim: Ants goes back to the start. Reason: fell over")
    seat(page, 1, "Freeze").click()
    page.get_by_role("dialog").get_by_role("button", name="30", exact=True).click()
    confirm(page, "rule", "pushed")
    log_has(page, "Referee Kim: Bees is frozen for 30 seconds. Reason: rule: pushed")
    seat(page, 1, "Unfreeze").click()
    log_has(page, "Referee Kim: Bees may move again.")
    seat(page, 0, "Score ±").click()
    page.locator("input[name=amount]").fill("-3")
    expect(page.locator(".shows")).to_have_text("18 : 18 → 15 : 18")
    confirm(page, "other", "a warning")
    log_has(page, "Referee Kim: −3 points for Ants: Ants 15 : 18 Bees. Reason: a warning")
    has_scores(page, 15, 18)
    # While the match is halted: set a disc, take that back, change the clock.
    expect(page.locator(".why-halted")).to_have_count(0)
    group(page, "Halt").click()
    phase(page, 5)
    cause = page.locator(".why-halted")
    expect(cause).to_have_text("Referee Kim: halted.")
    text_px, large_px = (
        float(found.evaluate("(at) => parseFloat(getComputedStyle(at).fontSize)"))
        for found in (page.locator(".log li").first, cause)
    )
    assert large_px > 1.3 * text_px
    expect(disc(page, "c0r0").locator("text").last).to_have_text("A1")  # as the log names it
    disc(page, "c0r0").click()
    page.locator(".pick .states .act").nth(2).click()
    confirm(page, "rule")
    log_has(page, "Referee Kim: disc A1 goes to Bees: Ants 14 : 19 Bees. Reason: rule")
    has_scores(page, 14, 19)
    page.keyboard.press("Control+z")
    preview = page.locator(".preview")
    expect(preview.locator(".then")).to_have_text("15 : 18")
    has_scores(page, 14, 19)
    confirm(page, "other", "wrong disc")
    log_has(page, "the change of disc A1 is taken back: Ants 15 : 18 Bees. Reason: wrong disc")
    has_scores(page, 15, 18)
    expect(page.locator(".fate")).to_have_text("taken back")
    group(page, "+10 s").click()
    confirm(page, "network")
    log_has(page, "Referee Kim: 10 seconds added to the match. Reason: network")
    group(page, "Other …").click()
    page.locator("input[name=amount]").fill("-600")
    confirm(page, "rule")
    log_has(page, "600 seconds taken from the match.")
    step(page)
    log_has(page, "Referee Kim: play goes on in 1 second.")
    phase(page, 6)
    # After the end of play.
    group(page, "Draw").click()
    confirm(page, "rule")
    log_has(page, "Referee Kim: the match is declared a draw. Reason: rule")
    step(page, "Control+Enter")
    expect(page.get_by_role("dialog")).to_contain_text("15 : 18")
    phase(page, 6)
    confirm(page)
    phase(page, 7)
    log_has(page, "Referee Kim: the result is official: a draw.")
    step(page)
    confirm(page)
    expect(page.locator(".top h1")).to_contain_text("Match 2")
    phase(page, 1)
    # A match that is declared void.
    group(page, "Declare void").click()
    confirm(page, "network")
    phase(page, 8)
    log_has(page, "Referee Kim: the match is void. Reason: network")
    group(page, "Next match").click()
    confirm(page)
    expect(page.locator(".top h1")).to_contain_text("Match 3")


@pytest.mark.long
def test_declaring_a_winner_ends_a_halted_match(court: Venue, referee: Referee) -> None:
    """Declaring a winner ends a halted match; the log also has the computed result (rules 4.1)."""
    page = at_the_desk(referee())
    to_playing(page, court)
    step(page, "Control+Enter")
    phase(page, 5)
    group(page, "Bees wins").click()
    confirm(page, "stuck", "Ants can't go on")
    phase(page, 6)
    log_has(page, "Referee Kim: Bees is declared the winner. Reason: stuck: Ants can't go on")
    log_has(page, "By the rules, the match is a draw. Score: 18")


@pytest.mark.long
def test_a_wrong_token_is_said_beside_the_field(court: Venue, referee: Referee) -> None:
    """A wrong token is refused beside its field; the name stays, and the right token works."""
    page = referee()
    enter(page, token="x" * 26)
    expect(page.locator("#token-refused")).to_have_text(
        "This is not a referee's token of this court."
    )
    assert page.locator("input[name=token]").get_attribute("aria-invalid") == "true"
    expect(page.locator("input[name=by]")).to_have_value("Kim")
    assert why(group(page, "Declare void")) == "enter with the referee's token first"
    at_the_desk(page)


@pytest.mark.long
def test_a_token_that_was_replaced_is_not_shown_for_ever(venue: Venue, referee: Referee) -> None:
    """A tab forgets its old token after one refusal."""
    venue.court()
    venue.web()
    page = at_the_desk(referee())
    page.evaluate(f"sessionStorage.setItem('lacoc-referee', '{'o' * 26}')")
    shown: list[Any] = []

    def heed(sent: bytes | str) -> None:
        if "enter" in str(sent):
            shown.append(sent)

    page.on("websocket", lambda socket: socket.on("framesent", heed))
    page.reload()
    refused = page.locator("#token-refused")
    expect(refused).to_contain_text("not a referee's token of this court")
    page.wait_for_timeout(5000)
    assert len(shown) == 1
    at_the_desk(page)


@pytest.mark.long
def test_the_file_that_a_browser_is_given_leads_to_the_page(
    court: Venue, open_page: OpenPage, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The file that a browser opens leads to the page, which removes the key from its address."""
    monkeypatch.setenv("HOME", str(tmp_path))
    page = open_page()
    with unseen(f"{court.url}/referee#key={court.key}") as address:
        assert address.startswith(tmp_path.as_uri())
        page.goto(address)
        at_the_desk(page)
    assert page.url == f"{court.url}/referee"
    assert court.key not in page.content()


def test_each_closed_decision_says_why(court: Venue, referee: Referee) -> None:
    """If a decision is not legal now, its button can't be pressed and says why."""
    page = at_the_desk(referee())
    expect(big(page)).to_have_attribute("aria-disabled", "true")
    assert why(big(page)) == (
        f"{ONLY} ready to start. Now the match is in the lobby; "
        "nobody has joined the left seat, nobody has joined the right seat"
    )
    assert why(group(page, "Halt")) == f"{ONLY} in its countdown or being played. {IN_LOBBY}"
    assert why(group(page, "Draw")) == f"{ONLY} halted or finished. {IN_LOBBY}"
    assert why(seat(page, 0, "Say ready")) == "nobody has joined"
    assert why(seat(page, 1, "Freeze")) == f"{ONLY} being played or halted. {IN_LOBBY}"
    bubble = page.locator(".reason-bubble")
    group(page, "Halt").press("Tab")
    expect(bubble).to_have_text(f"{ONLY} halted. {IN_LOBBY}")
    group(page, "Resume").press("Enter")
    expect(bubble).to_be_visible()
    group(page, "Make official").hover()
    expect(bubble).to_have_text(f"{ONLY} finished. {IN_LOBBY}")
    big(page).hover()
    expect(bubble).to_contain_text("nobody has joined the left seat")
    court.contestant("left", "Ants")
    expect(bubble).to_contain_text(f"{IN_LOBBY}; nobody has joined the right seat")
    page.keyboard.press("Control+Enter")  # not legal: nothing happens
    phase(page, 1)
    # Enter on a disc opens a popover, whose choices also say why they can't be pressed.
    disc(page, "c3r3").focus()
    page.keyboard.press("ArrowRight")
    page.keyboard.press("Enter")
    expect(page.locator("#pick-title")).to_have_text("Disc E4")
    choice = page.locator(".pick .states .act").first
    assert "the match is in the lobby" in why(choice)
    page.keyboard.press("Escape")
    expect(page.locator(".pick")).to_have_count(0)
    expect(disc(page, "c4r3")).to_be_focused()


@pytest.mark.long
def test_no_reason_no_decision(court: Venue, referee: Referee) -> None:
    """A decision that needs a reason can't be confirmed without one; Escape cancels."""
    page = at_the_desk(referee())
    group(page, "Declare void").click()
    dialog = page.get_by_role("dialog")
    expect(dialog).to_contain_text("Choose a reason first")
    expect(dialog.locator("[type=submit]")).to_be_disabled()
    dialog.locator("label.chip", has_text="other").click()
    expect(dialog).to_contain_text("Write the reason in words")
    expect(dialog.locator("[type=submit]")).to_be_disabled()
    page.keyboard.press("Escape")
    expect(dialog).to_have_count(0)
    phase(page, 1)


@pytest.mark.long
def test_a_number_is_taken_as_it_is_typed(court: Venue, referee: Referee) -> None:
    """A number can be typed key by key, even while the text is no number yet, such as "-"."""
    page = at_the_desk(referee())
    to_playing(page, court)
    group(page, "Halt").click()
    phase(page, 5)
    group(page, "Other …").click()
    field = page.locator("input[name=amount]")
    shown: dict[str, str] = {}
    field.click()
    for typed in ("10.5", "1.05", "20.05", "-0.5", "-10.50"):
        field.press("Control+a")
        page.keyboard.type(typed)
        expect(field).to_have_value(typed)
        shown[typed] = page.locator(".shows").inner_text()
    left, then = (60 * int(m) + int(s) for m, s in re.findall(r"(\d+):(\d\d)", shown["10.5"]))
    assert then - left in (10, 11)
    field.press("Control+a")
    field.press("Delete")
    expect(page.get_by_role("dialog")).to_contain_text("−3600 to 3600, not 0")
    page.get_by_role("dialog").get_by_role("button", name="+30", exact=True).click()
    expect(field).to_have_value("30")
    field.press("Control+a")
    page.keyboard.type("-10.50")
    confirm(page, "rule")
    log_has(page, "10.5 seconds taken from the match.")


@pytest.mark.long
def test_a_decision_whose_answer_was_lost(court: Venue, referee: Referee) -> None:
    """If the answer to a decision is lost, the page says so and does not repeat the decision."""
    page = at_the_desk(referee())
    to_playing(page, court)
    group(page, "Halt").click()
    phase(page, 5)
    seat(page, 0, "Score ±").click()
    page.locator("input[name=amount]").fill("3")
    dialog = page.get_by_role("dialog")
    dialog.locator("label.chip", has_text="rule").click()
    reply = 9  # the first byte of a reply, its kind
    dialog.locator("[type=submit]").evaluate(
        "(button, reply) => { const { send } = WebSocket.prototype;"
        " WebSocket.prototype.send = function (data) {"
        " WebSocket.prototype.send = send; const take = this.onmessage;"
        " this.onmessage = (event) => new Uint8Array(event.data)[0] === reply"
        " ? this.close() : take.call(this, event);"
        " this.send(data); };"
        " button.click(); }",
        reply,
    )
    answer = page.locator(".answer")
    expect(answer).to_contain_text("No answer")
    expect(answer).to_contain_text("Check under Events whether it was done")
    expect(page.locator(".toast.no")).to_have_count(0)
    expect(dialog).to_have_count(0)
    log_has(page, "Referee Kim: +3 points for Ants: Ants 21 : 18 Bees. Reason: rule")
    has_scores(page, 21, 18)
    expect(page.locator(".acting.mine")).to_be_visible()


@pytest.mark.long
def test_a_double_click_does_one_thing(court: Venue, referee: Referee) -> None:
    """The second click of a double click does not repeat the decision or make the next one."""
    page = at_the_desk(referee())
    court.contestant("left", "Ants")
    court.contestant("right", "Bees")
    phase(page, 2)
    good = page.locator(".answer.yes")
    big(page).evaluate("(button) => { button.click(); button.click(); }")
    expect(good).to_contain_text("Play begins")
    phase(page, 4)
    page.evaluate(  # the page does it: the driver's presses may be a second apart on a busy machine
        "() => { for (const _ of [1, 2]) dispatchEvent(new KeyboardEvent("
        "'keydown', { key: 'Enter', code: 'Enter', ctrlKey: true, cancelable: true })); }"
    )
    phase(page, 5)
    expect(page.locator(".big.fresh")).to_have_count(0)
    expect(good).to_contain_text("Halted")
    big(page).evaluate(
        "(button) => { button.click(); new MutationObserver(() => button.click())"
        ".observe(button, { attributeFilter: ['aria-label'] }); }"
    )
    expect(good).to_contain_text("Play goes on")
    phase(page, 4)
    expect(page.locator(".toast.no")).to_have_count(0)
    group(page, "Halt").click()  # this button never changes its meaning: no pause
    phase(page, 5)
    group(page, "Resume").click()
    phase(page, 4)
    group(page, "Halt").click()
    phase(page, 5)


def test_a_reason_goes_with_its_button(court: Venue, referee: Referee) -> None:
    """The text that says why a choice can't be made closes together with the choice's popover."""
    page = at_the_desk(referee())
    disc(page, "c2r2").click()
    page.locator(".pick .states .act").first.hover()
    bubble = page.locator(".reason-bubble")
    expect(bubble).to_contain_text("the match is in the lobby")
    page.keyboard.press("Escape")
    expect(page.locator(".pick")).to_have_count(0)
    expect(bubble).to_have_count(0)


@pytest.mark.long
def test_a_dialog_gives_the_focus_back(court: Venue, referee: Referee) -> None:
    """After a dialog closes, the button that opened it has the keyboard focus again."""
    page = at_the_desk(referee())
    void = group(page, "Declare void")
    dialog = page.get_by_role("dialog")
    for leave in ("Cancel", "Close", "Escape"):
        void.focus()
        void.press("Enter")
        expect(dialog).to_be_visible()
        if leave == "Escape":
            page.keyboard.press("Escape")
        else:
            dialog.get_by_role("button", name=leave).press("Enter")
        expect(page.locator("dialog")).to_have_count(0)
        expect(void).to_be_focused()
    void.press("Enter")
    confirm(page, "network")
    phase(page, 8)
    expect(void).to_be_focused()


@pytest.mark.long
def test_what_becomes_official_is_said_as_it_is(venue: Venue, referee: Referee) -> None:
    """The open dialog shows the score and winner to be made official, also if they change."""
    venue.court("--seconds", "1")
    venue.web()
    page = at_the_desk(referee())
    start(page, venue)
    phase(page, 6)
    step(page)
    dialog = page.get_by_role("dialog")
    expect(dialog).to_contain_text("18 : 18 · A draw")
    other = venue.referee("Sato")
    other.ask("take_over")
    decide(other, "rule", type="adjust", seat="left", points=3)
    expect(dialog).to_contain_text("21 : 18")
    decide(other, "rule", type="declare", winner="right")
    expect(dialog).to_contain_text("21 : 18 · Bees wins")


@pytest.mark.long
def test_an_open_dialog_decides_nothing_about_the_next_match(
    court: Venue, referee: Referee
) -> None:
    """Somebody else ends the match meanwhile: the dialog says so, and its button is closed."""
    page = at_the_desk(referee())
    group(page, "Declare void").click()
    dialog = page.get_by_role("dialog")
    dialog.locator("label.chip", has_text="network").click()
    expect(dialog.locator("[type=submit]")).to_be_enabled()
    other = court.referee("Sato")
    other.ask("take_over")
    decide(other, "network", type="abort")
    decide(other, type="next")
    other.close()
    expect(dialog).to_contain_text("You began this decision in the match before")
    expect(dialog.locator("[type=submit]")).to_be_disabled()
    page.keyboard.press("Escape")
    page.locator(".acting").get_by_role("button", name="Take over").click()
    expect(page.locator(".acting.mine")).to_be_visible()
    group(page, "Declare void").click()
    confirm(page, "network")
    phase(page, 8)


@pytest.mark.long
def test_a_flag_is_named_well(venue: Venue, referee: Referee) -> None:
    """The page names a marker in the page's language, not by its name in the record."""
    text = venue.contest.read_text("utf-8").replace("othello", "flag-strike")
    venue.contest.write_text(text, "utf-8")
    venue.court()
    venue.web()
    page = at_the_desk(referee(query="?lang=ja"))
    to_playing(page, venue)
    step(page)
    phase(page, 5)
    for name, words in (("flag7", "フラッグ 7"), ("corner2", "コーナー 2")):
        disc(page, name).click()
        expect(page.locator("#pick-title")).to_contain_text(words)
        expect(page.locator("#pick-title")).not_to_contain_text(name)
        page.locator(".pick .states .act:not([aria-disabled])").first.click()
        title = page.get_by_role("dialog").locator("h2")
        expect(title).to_contain_text(f"{words} を")
        page.keyboard.press("Escape")


@pytest.mark.long
def test_two_referees_and_taking_over(court: Venue, referee: Referee) -> None:
    """One referee acts, and another one watches until taking over."""
    first, second = at_the_desk(referee(), "Kim"), referee()
    enter(second, "Sato")
    expect(second.locator(".acting.other")).to_contain_text("Kim is the referee")
    assert why(group(second, "Declare void")) == "Kim is the referee now: take over first"
    second.locator(".acting").get_by_role("button", name="Take over").click()
    second.get_by_role("dialog").get_by_role("button", name="Take over").click()
    expect(second.locator(".acting.mine")).to_be_visible()
    expect(first.locator(".acting.other")).to_contain_text("Sato is the referee")
    group(second, "Declare void").click()
    confirm(second, "network")
    log_has(first, "Referee Sato: the match is void. Reason: network")
    assert why(group(first, "Next match")) == "Sato is the referee now: take over first"
    second.close()  # nobody acts now, so taking over asks no question
    expect(first.locator(".acting.other")).to_contain_text("There is no referee now")
    first.locator(".acting").get_by_role("button", name="Take over").click()
    expect(first.locator(".acting.mine")).to_be_visible()
    # Another tab of the same browser may be another referee's; a reload keeps each name.
    tab = first.context.new_page()
    tab.goto(first.url)
    expect(tab.locator("input[name=by]")).to_have_value("Kim")
    enter(tab, "Lee")
    expect(tab.locator(".acting.other")).to_be_visible()
    first.reload()
    expect(first.locator(".acting.mine")).to_contain_text("Kim")
    # A question whether to take over ends when that referee goes.
    tab.locator(".acting").get_by_role("button", name="Take over").click()
    expect(tab.get_by_role("dialog")).to_contain_text("Kim")
    first.get_by_role("button", name="Leave").click()
    expect(tab.get_by_role("dialog")).to_have_count(0)
    expect(tab.locator(".acting.other")).to_contain_text("There is no referee now")
    enter(first, "Kim")
    expect(first.locator(".acting.mine")).to_be_visible()
    expect(tab.locator(".acting.other")).to_contain_text("Kim is the referee")
    expect(tab.get_by_role("dialog")).to_have_count(0)


@pytest.mark.long
def test_a_take_back_is_what_was_shown(court: Venue, referee: Referee) -> None:
    """If the match changes meanwhile, the open dialog asks again; a refusal is said in words."""
    page = at_the_desk(referee())
    to_playing(page, court)
    step(page)
    phase(page, 5)
    with open_client([f"tcp/127.0.0.1:{court.court_port}"]) as session:
        other = RefereeClient(session, "main", REFEREE)
        adjusted = other.decide(d.Adjust("left", 7), "rule", "Sato")
        has_scores(page, 25, 18)
        page.keyboard.press("Control+z")
        dialog = page.get_by_role("dialog")
        expect(dialog.locator(".then")).to_have_text("18 : 18")
        other.decide(d.Adjust("right", 3), "rule", "Sato")
        expect(dialog.locator(".then")).to_have_text("18 : 21")
        expect(dialog.locator(".scores dd").first).to_have_text("25 : 21")
        dialog.locator("label.chip", has_text="rule").click()
        expect(dialog.locator("[type=submit]")).to_be_enabled()
        page.evaluate(HOLD_MESSAGES, MessageKind.EVENT)
        page.get_by_role("button", name="and if play went on").click()  # a request
        expect(dialog.locator(".outlook .preview")).to_be_visible()
        assert adjusted.event is not None
        other.decide(d.TakeBack(adjusted.event), "rule", "Sato")
        dialog.locator("[type=submit]").click()
        expect(dialog.locator("[role=alert]")).to_contain_text("can't be taken back")
        expect(page.locator(".answer.no")).to_contain_text("can't be taken back")
        page.evaluate("letGo()")
        expect(dialog.locator(".why")).to_contain_text("can't be taken back")
        expect(dialog.locator("[type=submit]")).to_be_disabled()


@pytest.mark.long
def test_an_answer_closes_only_its_own_dialog(court: Venue, referee: Referee) -> None:
    """The answer to a decision whose dialog was left does not close the dialog after it."""
    page = at_the_desk(referee())
    to_playing(page, court)
    step(page)
    phase(page, 5)
    page.evaluate(HOLD_MESSAGES, MessageKind.REPLY)
    seat(page, 0, "Score ±").click()
    dialog = page.get_by_role("dialog")
    dialog.locator("label.chip", has_text="rule").click()
    dialog.locator("[type=submit]").click()
    page.keyboard.press("Escape")
    expect(dialog).to_have_count(0)
    seat(page, 1, "Freeze").click()
    dialog.locator("input[name=words]").fill("cable")
    page.evaluate("letGo()")
    has_scores(page, 19, 18)
    expect(page.locator(".answer.yes")).to_be_visible()
    expect(dialog.locator("input[name=words]")).to_have_value("cable")


@pytest.mark.long
def test_a_reload_goes_on(court: Venue, referee: Referee) -> None:
    """After a reload the referee still acts; after leaving, the page only keeps the name."""
    page = at_the_desk(referee())
    page.reload()
    expect(page.locator(".acting.mine")).to_contain_text("Kim")
    page.get_by_role("button", name="Leave").click()
    expect(page.locator("input[name=by]")).to_have_value("Kim")
    expect(page.locator(".acting")).to_have_count(0)


@pytest.mark.long
def test_a_court_that_was_killed(venue: Venue, referee: Referee, console: Any) -> None:
    """While the court is gone, the page is marked as not live and allows no decision."""
    console.expect_a_break()  # the gateway is killed too
    court, web = venue.court(), venue.web()
    page = at_the_desk(referee())
    to_playing(page, venue)
    court.kill()
    expect(page.locator(".banner")).to_contain_text("court main")
    expect(page.locator("main.referee")).to_have_attribute("data-live", "false")
    expect(page.locator(".stale")).to_be_visible()
    expect(page.locator(".health .verdict")).to_contain_text("no news")
    assert why(big(page)) == "no connection to the court"
    venue.court()
    phase(page, 5)  # a court that was killed in play goes on halted
    expect(page.locator("main.referee")).to_have_attribute("data-live", "true")
    expect(page.locator(".banner")).to_have_count(0)
    log_has(page, "The court: halted. Reason: the court was started again")
    web.kill()
    expect(page.locator(".banner")).to_be_visible()
    venue.web()
    expect(page.locator(".banner")).to_have_count(0)
    expect(page.locator(".acting.mine")).to_be_visible()  # it has entered again by itself
    group(page, "Declare void").click()
    confirm(page, "network")
    phase(page, 8)


@pytest.mark.long
def test_take_back_of_a_strike(venue: Venue, referee: Referee) -> None:
    """Before an event is taken back, the page shows the new score and the events that vanish."""
    text = venue.contest.read_text("utf-8").replace("othello", "flag-strike")
    venue.contest.write_text(text, "utf-8")
    venue.court()
    venue.web()
    page = referee()
    at_the_desk(page)
    looks: dict[str, set[str | None]] = {}
    for flag in page.locator(".board g[data-marker^='flag']").all():
        colour = flag.locator("circle").get_attribute("fill")
        points = flag.locator("text").first.text_content() or ""
        looks.setdefault(points, set()).add(colour)
    assert sorted(looks) == ["1", "2", "3", "5"]  # also 1 point is shown (rules 6)
    assert len(set.union(*looks.values())) == 4  # and each number has its colour
    ants, bees = venue.contestant("left", "Ants"), venue.contestant("right", "Bees")
    phase(page, 2)
    step(page)
    phase(page, 4)
    for robot in (ants, bees):
        robot.press(level=1, key=2)
    strike = page.locator(".log li[data-kind=strike]").last
    expect(strike).to_be_visible()
    assert (
        why(strike.locator(".act")) == f"{ONLY} halted or finished. Now the match is being played"
    )
    step(page, "Control+Enter")
    phase(page, 5)
    before = scores(page)
    page.get_by_role("button", name="If play went on").click()
    on = page.locator(".match .outlook")
    expect(on).to_contain_text("After 10 s more of play")
    assert on.locator("dd").first.inner_text().split(" : ") == before
    assert len(on.locator(".then").inner_text().split(" : ")) == 2
    expect(strike.locator(".act")).not_to_have_attribute("aria-disabled", "true")
    strike.locator(".act").click()
    preview = page.get_by_role("dialog").locator(".preview")
    expect(preview).to_contain_text("removed: strike of flag")
    then = preview.first.locator(".then").inner_text().split(" : ")
    assert then != before == scores(page)
    page.get_by_role("button", name="and if play went on").click()
    on = page.get_by_role("dialog").locator(".outlook .preview")
    expect(on).to_be_visible()
    assert on.locator("dd").first.inner_text().split(" : ") == then
    confirm(page, "rule")
    has_scores(page, *map(int, then))
    expect(page.locator(".match .outlook .preview")).to_have_count(0)  # it was about another score
    expect(strike.locator(".fate")).to_have_text("taken back")
    # The referee can also click a robot on the field.
    page.locator(".board g[aria-label='Ants (left)']").click()
    page.locator(".pick").get_by_role("button", name="Restart").click()
    confirm(page, "stuck")
    log_has(page, "Ants goes back to the start. Reason: stuck")


@pytest.mark.long
def test_both_links_are_shown_and_what_makes_them_equal(venue: Venue, referee: Referee) -> None:
    """With equal links (rules 3) the page shows each seat's round trip and the common delay."""
    equal = 'arena = "othello"\ninput_delay = "equal"'
    venue.contest.write_text(venue.contest.read_text().replace('arena = "othello"', equal))
    venue.court()
    venue.web()
    page = at_the_desk(referee())
    venue.contestant("left", "Ants")
    left, right = (page.locator(f".seat[data-seat='{index}']") for index in (0, 1))
    expect(left.locator("dd[data-trip]")).to_have_text(re.compile(r"\d+ ms \(95 %: \d+ ms\)"))
    expect(left.locator("dd[data-equal]")).to_have_text(re.compile(r"\d+ ms\s*0 late"))
    expect(right.locator("dd[data-trip]")).to_have_text("–")


@pytest.mark.long
def test_the_log_is_filtered(court: Venue, referee: Referee) -> None:
    """The log can be filtered, for instance by "Links" or by "Decisions"."""
    page = at_the_desk(referee())
    court.contestant("left", "Ants")
    log_has(page, "Ants is ready.")
    card = page.locator(".log-card")
    card.locator("label.chip", has_text="Links").click()
    expect(page.locator(".log li")).to_have_count(1)
    log_has(page, "Ants takes the left seat")
    card.locator("label.chip", has_text="Decisions").click()
    expect(card).to_contain_text("Nothing has happened yet")


@pytest.mark.long
def test_all_of_it_in_japanese(court: Venue, referee: Referee) -> None:
    """In Japanese no English is left in the page, its reasons, its log and its dialogs."""
    page = at_the_desk(referee(query="?lang=ja"))
    court.contestant("left", "Ants")
    log_has(page, "Ants の準備が完了しました。")
    group(page, "無効試合にする").click()
    texts = [page.locator("main").inner_text(), *page.locator(".hidden-text").all_inner_texts()]
    left = [
        line
        for text in texts
        for line in text.splitlines()
        if re.search(r"[A-Za-z]{2,} [A-Za-z]{2,}", JAPANESE_NAMES.sub("", line))
    ]
    assert not left
    confirm(page, "通信", "LAN")
    log_has(page, "審判 Kim：無効試合としました。理由：通信：LAN")


@pytest.mark.parametrize(
    "size",
    [
        (390, 844),
        pytest.param((1366, 768), marks=pytest.mark.long),
        pytest.param((1920, 1080), marks=pytest.mark.long),
    ],
    ids=str,
)
def test_nothing_runs_off_the_screen(court: Venue, referee: Referee, size: tuple[int, int]) -> None:
    """On a screen of each size the big button is in sight, and nothing runs off to the right."""
    page = at_the_desk(referee(size=size))
    expect(big(page)).to_be_in_viewport(ratio=1)
    wide = page.evaluate(
        "[...document.querySelectorAll('main *')].filter(e => {"
        " const box = e.getBoundingClientRect();"
        " return box.width && box.right > innerWidth + 1; }).map(e => e.className || e.tagName)"
    )
    assert not wide


@pytest.mark.long
def test_the_longest_name_fits_a_phone(court: Venue, referee: Referee) -> None:
    """A name of one long word widens neither a dialog nor the choices of a disc."""
    page = at_the_desk(referee(size=(390, 844), query="?lang=ja"))
    court.contestant("left", "久保田研究室六脚歩行ロボット開発チーム第二班東京")
    court.contestant("right", "Bees")
    phase(page, 2)
    step(page)
    phase(page, 4)
    step(page)
    phase(page, 5)
    seat(page, 0, "再スタート").click()
    dialog = page.get_by_role("dialog")
    assert dialog.evaluate("it => it.scrollWidth <= it.clientWidth")
    page.keyboard.press("Escape")
    disc(page, "c3r3").click()
    expect(page.locator(".pick .close")).to_be_in_viewport(ratio=1)
    choices = page.locator(".pick .states .act").all()
    assert all(choice.evaluate("it => it.scrollWidth <= it.clientWidth") for choice in choices)


@pytest.mark.long
def test_no_serious_barriers(court: Venue, referee: Referee) -> None:
    """Axe-core finds no serious mistake in the lobby, in a dialog and in a popover."""
    pytest.importorskip("axe_core_python")
    page = at_the_desk(referee())
    assert violations(page) == []
    group(page, "Declare void").click()
    assert violations(page) == []
    page.keyboard.press("Escape")
    disc(page, "c3r3").click()
    assert violations(page) == []
