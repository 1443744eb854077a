"""Tests of /play, a contestant's page, at a real court through a real gateway (workshop 5-4)."""

import base64
import json
import math
import random
import re
import signal
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from contestant import Contestant, Sit
from drop import drag_in, drop
from own_page import OwnPage
from page_client import PageClient
from playwright.sync_api import expect
from show import violations
from venue import TOKENS, Venue

from lacoc_robots.library import sample_gait_files
from lacoc_shared.codec import encode
from lacoc_shared.messages import Frame, SeatFrame
from lacoc_shared.record.export.pos_data import PosData
from lacoc_shared.seat import Phase, SeatFlag

pytestmark = pytest.mark.slow


def opened(venue: Venue, sit: Sit, *words: str, **options: Any) -> Contestant:
    """Start a court and its gateway, and open the link of the left seat."""
    venue.court(*words)
    venue.web()
    page = sit(venue.url, **options)
    page.open(token=TOKENS["left"])
    return page


def seated(venue: Venue, sit: Sit, *words: str, **options: Any) -> Contestant:
    """Start a court and its gateway, and open a page that has taken the left seat."""
    page = opened(venue, sit, *words, **options)
    page.join(TOKENS["left"])
    page.stands("seated")
    return page


def started(venue: Venue, page: Contestant) -> PageClient:
    """Begin a match's countdown; return the opponent, a page without a browser."""
    page.page.click("button.ready")
    other = venue.contestant("right", "Bees")
    referee = venue.referee()
    referee.phase(Phase.READY)
    page.phase(Phase.READY)
    referee.ask("decide", decision={"type": "start"}, reason="")
    return other


COUNTS_DOWN = """() => {
  const button = document.querySelector(".restart");
  new MutationObserver(() => {
    const told = document.querySelector(".next")?.textContent ?? "";
    window.__countsDown ||= button.textContent.includes("in ");
    window.__restartTold ||= told.includes("Restarted: your keys work again in");
  }).observe(document, { subtree: true, childList: true, characterData: true });
}"""
"""Notes that the button of a restart and the line of the next step say when keys work again."""


def playing(venue: Venue, page: Contestant) -> PageClient:
    """Bring a match into play; return the opponent, a page without a browser."""
    other = started(venue, page)
    page.phase(Phase.PLAYING)
    return other


@pytest.mark.long
def test_keys_are_tried_in_the_lobby(venue: Venue, sit: Sit) -> None:
    """In the lobby the own robot stands on the field and walks by keys, until Ready: alone."""
    page = seated(venue, sit)
    page.is_told("Try your keys: only you see it")
    body = "window.__lacoc.view.bodyPos('left/body')"
    page.until(f"{body} !== null")
    page.sees(".view-tag.own", "You")
    stood = page.page.evaluate(body)
    watcher = sit(venue.url)
    watcher.open("/watch")
    watcher.sees(".opening")
    page.press("2")
    page.key_stands(2)
    page.until(f"Math.hypot({body}[0] - {stood[0]}, {body}[1] - {stood[1]}) > 0.05")
    page.press("1")
    page.key_stands(1)
    page.press("x")
    page.until(f"Math.hypot({body}[0] - {stood[0]}, {body}[1] - {stood[1]}) < 0.01")
    page.misses('.key[aria-pressed="true"]')
    page.press("9")
    page.is_toasted("no such key")
    assert watcher.page.evaluate(body) is None
    page.press("2")
    page.key_stands(2)
    page.page.click("button.ready")
    page.is_told("Waiting for the right seat")
    page.misses('.key[aria-pressed="true"]')
    page.press("2")
    page.is_toasted("[2]")
    other = venue.contestant("right", "Bees")
    page.phase(Phase.READY)
    page.until("window.__lacoc.view.bodyPos('right/body') !== null")
    other.close()


def test_the_card_says_what_is_wrong_and_remembers(venue: Venue, sit: Sit, tmp_path: Path) -> None:
    """The join form shows every mistake; the browser keeps the team's name but not the token."""
    venue.contest.write_text('[contest]\nname = "Autumn cup"\n' + venue.contest.read_text())
    venue.court()
    venue.web()
    page = sit(venue.url)
    page.open()
    page.sees(".entrance", "Autumn cup")
    page.page.fill("#team-token", "not-the-token")
    page.page.click("button[type=submit]")
    page.sees("#team-token-error", "token")
    assert page.find("#team-token").get_attribute("aria-invalid") == "true"
    page.page.fill("#team-token", TOKENS["left"])
    page.page.click("button[type=submit]")
    page.sees(".own-seat", "left")
    page.sees(".safety", "'lacoc play' on your own computer is safer")
    page.page.click("button[type=submit]")
    page.sees("#join-name-error", "1 to 24 characters")

    angles = ["45"] * 16
    bad = tmp_path / "LocoTra-data-new.txt"
    bad.write_text("1\n1\n" + "\t".join([*angles, "x", "200"]) + "\n")
    page.find("input[type=file]").set_input_files(bad)
    page.sees(".files li:nth-child(2)", "LocoTra-data-new.txt")
    page.join(TOKENS["left"])
    page.sees(".refusal", "Your files have 2 mistakes.")
    rows = page.find(".mistakes li")
    assert rows.nth(0).locator("p").all_inner_texts() == [
        "LocoTra-data-new.txt · row 3 · column 17 · joint 16 (L,C)",
        '"x" expected: an angle from −150 to 150 degrees',
    ]
    assert "joint 17 (L,F)" in rows.nth(1).inner_text()
    page.sees("main[data-standing=outside]")
    page.page.set_viewport_size({"width": 667, "height": 260})
    page.find(".entrance-place").evaluate("(place) => place.scrollTo(0, 0)")
    top = page.find(".entrance").bounding_box()
    assert top is not None
    assert top["y"] >= 0, "what is higher than the window can be scrolled to its top"
    page.page.set_viewport_size({"width": 1280, "height": 720})

    sample = sample_gait_files("hexapod").locomotion
    assert sample is not None
    bad.write_bytes(sample.data)
    page.find("input[type=file]").set_input_files(bad)
    page.misses(".refusal")
    page.page.click("button[type=submit]")
    page.stands("seated")
    page.is_told("Press Ready when you are ready")
    kept: dict[str, str] = page.page.evaluate("({...localStorage})")
    assert TOKENS["left"] not in json.dumps(kept)
    assert json.loads(kept["lacoc.team"]) == "Ants"

    page.page.reload()
    page.stands("seated")
    other = sit(venue.url)
    other.open(token=TOKENS["right"])
    other.sees(".own-seat[data-seat='1']", "free")


@pytest.mark.long
def test_files_are_sorted_by_what_is_in_them(venue: Venue, sit: Sit, tmp_path: Path) -> None:
    """The page tells files apart by their content, not by their names or encodings."""
    page = opened(venue, sit)
    page.sees(".own-seat")
    sample = sample_gait_files("hexapod")
    assert sample.postures is not None
    assert sample.locomotion is not None
    files = {
        "a.txt": sample.postures.data.decode().encode("utf-16"),
        "b.txt": b"\xef\xbb\xbf" + sample.locomotion.data,
        "c.toml": b"name = 'My robot'",
    }
    for name, data in files.items():
        (tmp_path / name).write_bytes(data)
    page.find("input[type=file]").set_input_files([tmp_path / name for name in files])
    for slot, name in (("Robot", "c.toml"), ("Level A", "a.txt"), ("Level B", "b.txt")):
        page.sees(f".files li:has-text('{slot}')", name)
    page.page.click("[aria-label='Remove c.toml']")
    page.sees(".files li:has-text('Robot')", "the contest's")
    page.join(TOKENS["left"])
    page.stands("seated")


@pytest.mark.long
def test_files_are_dropped_anywhere(venue: Venue, sit: Sit) -> None:
    """Files may be dropped anywhere on the page, and the browser does not leave the page."""
    page = opened(venue, sit)
    page.sees(".own-seat")
    sample = sample_gait_files("hexapod")
    assert sample.locomotion is not None
    drop(page.page, {"mine.txt": sample.locomotion.data, "mine.toml": b"name = 'My robot'"})
    page.sees(".files li:has-text('Robot')", "mine.toml")
    page.sees(".files li:has-text('Level B')", "mine.txt")
    page.misses(".files.over")
    page.find("[aria-label='Remove mine.toml']").click()
    page.join(TOKENS["left"])
    page.stands("seated")

    page.page.click("text=Change files")
    page.sees("dialog .files")
    drop(page.page, {"other.txt": sample.locomotion.data})
    page.sees("dialog .files li:has-text('Level B')", "other.txt")
    drop(page.page, {"huge.txt": bytes(70_000)})
    page.is_toasted("huge.txt is too large")
    page.page.click("text=Use these files")
    page.misses("dialog")
    page.stands("seated")


def test_a_folder_is_not_passed_over_in_silence(venue: Venue, sit: Sit, tmp_path: Path) -> None:
    """The page says that a dropped folder can't be read, and takes the file dropped with it."""
    page = opened(venue, sit)
    page.sees(".own-seat")
    folder = tmp_path / "gaits"
    folder.mkdir()
    mine = tmp_path / "mine.toml"
    mine.write_text("name = 'My robot'")
    drag_in(page.page, folder, mine)
    page.is_toasted("gaits can't be read. If it is a folder, drop the files in it instead.")
    page.sees(".files li:has-text('Robot')", "mine.toml")


@pytest.mark.long
def test_a_file_dropped_on_a_seated_page(venue: Venue, sit: Sit, tmp_path: Path) -> None:
    """A file dropped on the page can be used or put away before a match, but not during it."""
    page = seated(venue, sit, "--seconds", "120")
    mine = tmp_path / "mine.toml"
    mine.write_text("name = 'My robot'")
    drag_in(page.page, mine)
    page.sees("dialog .files li:has-text('Robot')", "mine.toml")
    page.press("Escape")
    page.misses("dialog")
    page.page.click("text=Change files")
    page.sees("dialog .files li:has-text('Robot')", "the contest's")
    page.press("Escape")
    page.misses("dialog")
    other = playing(venue, page)
    drag_in(page.page, mine)
    page.is_toasted("Choose files before a match.")
    page.misses("dialog")
    page.press("2")
    page.key_stands(2)
    assert page.page.url.startswith(f"{venue.url}/play")
    assert len(page.page.context.pages) == 1
    other.close()


@pytest.mark.long
def test_tabs_of_one_browser_have_their_own_files(
    venue: Venue, sit: Sit, tmp_path: Path, console: Any
) -> None:
    """Two tabs of one browser have their own files, also after a reload."""
    sample = sample_gait_files("hexapod").locomotion
    assert sample is not None
    left = opened(venue, sit)
    right = sit(venue.url)
    right.page = left.page.context.new_page()
    console.watch(right.page)
    right.open(token=TOKENS["right"])
    for page, seat in ((left, "left"), (right, "right")):
        page.sees(".own-seat")
        page.misses(".files .name:not(.muted)")
        file = tmp_path / f"{seat}.txt"
        file.write_bytes(sample.data)
        page.find("input[type=file]").set_input_files(file)
        page.sees(".files li:nth-child(2)", file.name)
        page.join(TOKENS[seat], seat.title())
        page.stands("seated")
    left.page.reload()
    left.stands("seated")
    left.page.click("text=Change files")
    left.sees("dialog .files li:nth-child(2)", "left.txt")

    left.page = left.page.context.new_page()  # a new tab, for the next team
    console.watch(left.page)
    left.open(token=TOKENS["left"])
    left.sees(".own-seat")
    left.misses(".files .name:not(.muted)")


@pytest.mark.long
def test_a_kept_seat_of_another_court_is_none(venue: Venue, sit: Sit) -> None:
    """A page that kept a seat of another court does not ask for this seat; its user can join."""
    page = opened(venue, sit)
    page.sees(".own-seat")
    wish = {"court": "side", "seat": "left", "token": "x", "name": "Ants"}
    page.page.evaluate("(wish) => sessionStorage.setItem('lacoc.wish', wish)", json.dumps(wish))
    page.page.reload()
    page.stands("outside")
    page.join(TOKENS["left"])
    page.stands("seated")


@pytest.fixture
def own(venue: Venue, tmp_path: Path) -> Iterator[tuple[str, str]]:
    """Give the address and page key of `lacoc play`, started with seat, name, token and gait."""
    court = venue.court()
    sample = sample_gait_files("hexapod").locomotion
    assert sample is not None
    (tmp_path / "LocoTra-data.txt").write_bytes(sample.data)
    words = ("--connect", court.opened["locators"][0], "--name", "Bees")
    with OwnPage(tmp_path, "play", *words, "--token", TOKENS["right"]) as command:
        yield command.url, command.key


@pytest.mark.long
def test_equal_links_are_shown(venue: Venue, sit: Sit) -> None:
    """With equal links (rules 3), the page shows its round trip and the common delay."""
    equal = 'arena = "othello"\ninput_delay = "equal"'
    venue.contest.write_text(venue.contest.read_text().replace('arena = "othello"', equal))
    page = seated(venue, sit)
    page.sees(".foot dd[data-link]:not([data-link=''])", "ms")
    page.sees(".foot", "equal for both")


@pytest.mark.long
def test_what_the_command_line_said_needs_one_click(own: tuple[str, str], sit: Sit) -> None:
    """`lacoc play` fills in the join form of its page, so that one click joins the match."""
    url, key = own
    page = sit(url)
    page.open(key=key)
    page.sees(".own-seat", "right")
    page.sees(".files", "LocoTra-data.txt (from this computer's folder)")
    assert page.find("#join-name").input_value() == "Bees"
    page.misses(".safety")
    page.page.click("button[type=submit]")
    page.stands("seated")
    page.sees(".foot .who", "Bees (right)")
    page.page.reload()
    page.stands("seated")


def test_only_its_owner_plays_on_an_own_page(own: tuple[str, str], sit: Sit) -> None:
    """Without the page key, the page of `lacoc play` only watches and says what to open."""
    page = sit(own[0])
    page.open()
    page.stands("watching")
    page.sees(".entrance", "#key=")
    page.misses("form")


HIDE = """(() => {
  const draw = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (make) => draw((ms) => window.isHidden || make(ms));
  for (const name of ["setTimeout", "setInterval"]) {
    const set = window[name].bind(window);
    window[name] = (run, ms) => set(run, window.isHidden ? Math.max(1000, ms || 0) : ms);
  }
})()"""
"""With `isHidden` a page gets no pictures, and new timers of a second, as in a hidden tab."""


@pytest.mark.long
def test_a_hidden_tab_keeps_its_seat(venue: Venue, sit: Sit) -> None:
    """A page that gets no pictures goes on to name frames, and is heard by the court."""
    page = opened(venue, sit)
    page.page.add_init_script(HIDE)
    page.page.reload()
    page.join(TOKENS["left"])
    page.stands("seated")
    court = venue.page()
    page.page.evaluate("window.isHidden = true")
    court.wait(lambda: court.frame)
    for _ in range(4):
        before = court.health
        court.wait(lambda before=before: court.health is not before)  # type: ignore[misc]
    assert court.health is not None
    seat = court.health.seats[0]
    assert seat.refused == {}
    assert seat.round_trip_p50_ms is not None
    # Where the machine stalled, it was silent for a moment.
    court.wait(lambda: court.frame and not court.frame.seats[0].flags & SeatFlag.SILENT)


@pytest.mark.long
def test_a_contestant_tests_the_link_before_a_match(venue: Venue, sit: Sit) -> None:
    """Before a match /play measures the way to the court, and says in a sentence what it means."""
    page = opened(venue, sit)
    for has_seat in (False, True):
        if has_seat:
            page.join(TOKENS["left"])
            page.stands("seated")
        page.page.get_by_role("button", name="Test my connection").click()
        page.sees(".link-test [role=status]", "Measuring")
        page.sees(".link-test :is(.good, .equal, .slow)")
        figures = page.find(".link-test dd").all_inner_texts()
        assert all(re.fullmatch(r"\d+ ms", figure) for figure in figures[:2]), figures
        assert re.fullmatch(r"\d+: \d+ lost, \d+ late", figures[2])
        assert violations(page.page) == []
        page.press("Escape")
        page.misses(".link-test")
    playing(venue, page)
    page.misses("button:has-text('Test my connection')")


@pytest.mark.slow(minutes=0.4)
def test_keys_drive_the_robot(venue: Venue, sit: Sit, tmp_path: Path) -> None:
    """A contestant plays by the page's keys, from the lobby to Pos-data.txt (workshop 5-4)."""
    page = seated(venue, sit, "--seconds", "120")
    page.press("r")
    page.is_told("You are ready. Waiting for the right seat")
    page.press("2")
    page.is_toasted("[2] Keys work only while the match is being played")
    page.page.click(".ready.said button")
    page.is_told("Press Ready when you are ready")
    other = playing(venue, page)
    page.is_told("All discs next to disc A3 are yours: walk on to where theirs begin.")
    page.misses(".view-worth")

    page.press("2")
    page.key_stands(2)
    page.sees(".stands", "B 2: posture")
    expect(page.find(".foot dd[data-trip]")).not_to_have_attribute("data-trip", "")
    page.sees(".foot dd[data-link]:not([data-link=''])")
    before = other.frame
    assert before is not None
    other.wait(lambda: other.frame and other.frame.beat > before.beat + 100)
    assert moved_m(before, other.frame, seat=0) > 0.05  # it walks 90 mm/s after a slow start

    page.press("7")
    page.is_toasted("[7] Your gait file has no such key")
    assert hidden_discs(page) == []
    page.press("Tab")  # only level B is open: Tab leads out of the field, and keys still steer
    page.sees(".stage .badge:focus")
    page.press("ArrowLeft")
    page.key_stands(1)
    page.press("Numpad3")
    page.key_stands(3)
    other.wait(lambda: other.frame and other.frame.seats[0].key == 3)
    seq = other.own().applied_seq, other.frame.seats[0].applied_seq  # type: ignore[union-attr]
    page.page.keyboard.down("2")
    page.page.keyboard.down("2")  # the repeat of a held key
    page.page.keyboard.up("2")
    page.key_stands(2)
    other.wait(lambda: other.frame and other.frame.seats[0].key == 2)
    assert other.frame is not None
    assert other.frame.seats[0].applied_seq == seq[1] + 1
    page.find('.key[data-key="1"]').click()
    page.key_stands(1)
    page.press("3")  # the pad did not take the focus
    page.key_stands(3)

    page.page.evaluate(COUNTS_DOWN)
    page.press("x")
    page.until("window.__countsDown && window.__restartTold")
    page.press("2")  # at once: keys are refused for five seconds only
    page.is_toasted("[2] Your robot was restarted a moment ago")
    page.key_stands(0)

    # Pressed by mistake for [x], and let go beside Ctrl: the page does not leave, and keys work.
    for act, key in (("down", "z"), ("down", "Control"), ("up", "z"), ("up", "Control")):
        getattr(page.page.keyboard, act)(key)
    page.sees(".leaving", "Hold z to leave the match")
    page.misses("dialog")
    page.until("!document.querySelector('.restart').textContent.includes('in ')")
    page.press("3")
    page.key_stands(3)
    badge = page.find(".badge").inner_text()
    page.press("Space")
    page.until(f"document.querySelector('.badge').innerText !== {json.dumps(badge)}")
    page.sees(".foot .who b", "Ants (left)")
    page.misses(".leaving")  # the hint disappears by itself
    page.find("button.leave").click()
    page.press("2")  # after the click keys still work
    page.key_stands(2)
    page.sees(".leaving")
    name, text = page.download(lambda: page.page.keyboard.down("z"), tmp_path)
    page.page.keyboard.up("z")
    assert name == "Pos-data.txt"
    header, *rows = text.splitlines()
    assert header.split("\t")[:8] == [
        *("time_s", "x_m", "y_m", "z_m", "roll_deg", "pitch_deg", "yaw_deg", "j0_deg")
    ]
    assert len(header.split("\t")) == 7 + 18
    assert len(rows) > 100
    assert float(rows[0].split("\t")[1]) == pytest.approx(-0.75, abs=0.02)  # column 0 (rules 5)
    page.stands("left")
    other.wait(lambda: any(event.kind == "leave" for event in other.events))
    page.page.click("text=Join again")
    page.stands("seated")
    page.phase(Phase.PLAYING)
    # Whoever leaves the page in a match is asked first.
    page.page.on("dialog", lambda dialog: dialog.dismiss())
    with page.page.expect_event("dialog") as asked:
        page.page.evaluate("setTimeout(() => location.assign('watch'))")
    assert asked.value.type == "beforeunload"
    page.stands("seated")
    other.close()


def hidden_discs(page: Contestant) -> list[int]:
    """Return which discs of the field a message, a button or the score covers."""
    page.until("window.__lacoc?.view?.screen(0, 0, 0)")
    found: list[int] = page.page.evaluate(
        """() => {
          const over = ".told > *, .score-bug, .badge, .third, .brief, .toast";
          const boxes = [...document.querySelectorAll(over)]
            .filter((one) => one.checkVisibility())
            .map((one) => one.getBoundingClientRect());
          return [...Array(36).keys()].filter((at) => {
            const [column, row] = [at % 6, Math.floor(at / 6)];
            const [x, y] = __lacoc.view.screen(0.3 * column - 0.75, 0.3 * row - 0.75, 0);
            return boxes.some(
              (box) => box.left < x && x < box.right && box.top < y && y < box.bottom,
            );
          });
        }"""
    )
    return found


def moved_m(before: Frame, after: Frame | None, seat: int) -> float:
    """Return how far a robot's place on the floor moved between two frames [m]."""
    assert after is not None
    size = 4 * (7 + 18)
    places = [np.frombuffer(f.poses[seat * size :][:8], "<f4") for f in (before, after)]
    return float(np.hypot(*(places[1] - places[0])))


@pytest.mark.long
def test_views_focus_and_input_method(venue: Venue, sit: Sit) -> None:
    """Space changes the view, a lost focus is shown, and keys work with a Japanese input method."""
    page = seated(venue, sit)
    page.sees(".badge", "View 1/3")
    for number, camera in ((2, "top"), (3, "chase"), (1, "arena")):
        page.press("Space")
        page.sees(".badge", f"View {number}/3")
        page.until(f"window.__lacoc.view?.camera === '{camera}'")
    page.page.keyboard.down("m")
    page.page.keyboard.down("m")  # held too long
    page.page.keyboard.up("m")
    assert page.page.evaluate("localStorage['lacoc.sound']") == "false"
    page.page.click("button.ready")
    other, referee = venue.contestant("right", "Bees"), venue.referee()
    page.phase(Phase.READY)
    page.page.get_by_role("button", name="Settings").click()
    page.sees("dialog[open] .keytest")
    referee.phase(Phase.READY)
    referee.ask("decide", decision={"type": "start"}, reason="")
    page.phase(Phase.PLAYING)
    page.misses("dialog[open]")  # nothing may take the keyboard from who plays
    page.until("document.activeElement.matches('.field3d')")
    page.page.click(".leave")
    page.page.get_by_role("button", name="Stay").click()
    page.until("document.activeElement.matches('.field3d')")

    page.page.evaluate("window.dispatchEvent(new Event('blur'))")
    page.sees(".curtain", "Click here to steer")
    page.page.click(".curtain")
    page.misses(".curtain")

    typed = {"code": "Digit1", "key": "Process", "keyCode": 229, "bubbles": True}
    page.page.evaluate(
        f"document.activeElement.dispatchEvent(new KeyboardEvent('keydown', {json.dumps(typed)}))"
    )
    page.sees(".ime", "半角/全角")
    page.key_stands(1)

    page.page.focus(".field3d")
    page.press("Escape")
    page.until("document.activeElement.closest('.rail, .foot') !== null")
    page.press("Tab")
    page.until("document.activeElement.closest('.rail, .foot') !== null")
    level = page.find(".toast").filter(has_text="level B")
    assert level.count() == 0  # Tab moved the focus and did not ask for another level
    page.press("2")
    page.key_stands(2)
    page.page.focus(".key[data-key='3']")
    page.press("Enter")
    page.key_stands(3)
    other.close()


@pytest.mark.long
def test_a_newcomer_is_told_what_matters(venue: Venue, sit: Sit) -> None:
    """Before play the page says which robot is one's own, how one scores, and what keys do."""
    page = seated(venue, sit)
    page.sees(".brief .own", "Your robot stands on the left")
    page.sees(".brief", "Walk straight from a disc of your own onto the next one")
    page.sees(".brief", "Press a key once: the robot goes on until you press another.")
    assert hidden_discs(page) == []
    for digit, does in enumerate(("stand", "turn left", "forward", "turn right")):
        page.sees(f'.key[data-key="{digit}"] small', does)
    page.press("?")
    page.sees("dialog .key-help", "put the robot back at its start")
    page.press("?")
    page.misses("dialog")
    other = playing(venue, page)
    page.misses(".brief")
    page.sees(".view-tag.own", "You")
    referee = venue.referee()
    referee.ask("take_over")
    # The disc under its feet becomes the other team's: from there nothing flips.
    referee.ask("decide", decision={"type": "halt"}, reason="")
    for disc, state in (("c0r2", "right"), ("c0r3", "right")):
        decision = {"type": "set", "marker": disc, "state": state}
        referee.ask("decide", decision=decision, reason="for the test")
    referee.ask("decide", decision={"type": "resume"}, reason="")
    page.is_told("From disc A3, which is theirs, nothing flips: step onto one of yours first.")
    page.misses(".view-worth")
    referee.ask("decide", decision={"type": "halt"}, reason="")
    decision = {"type": "set", "marker": "c0r2", "state": "left"}
    referee.ask("decide", decision=decision, reason="for the test")
    page.sees_text(".heard[role=log]", "Ants 17, Bees 19")
    referee.ask("decide", decision={"type": "resume"}, reason="")
    page.is_told("From disc A3, which is yours: walk straight onto a marked disc, and it flips.")
    page.sees('.view-worth[data-marker="c0r3"]', "+1")
    other.close()


@pytest.mark.long
def test_a_screen_reader_hears_the_time(venue: Venue, sit: Sit) -> None:
    """One live region of the page says the time at 60, 30 and 10 seconds, and each new score."""
    page = seated(venue, sit, "--seconds", "11")
    other = playing(venue, page)
    page.sees_text(".heard", "10 seconds left")
    live = "[aria-live=polite], [role=log], [role=status]"
    assert page.find(f".stage :is({live}):not(.countdown, .toasts)").count() == 0
    other.close()


@pytest.mark.long
def test_files_are_told_once(venue: Venue, sit: Sit) -> None:
    """Who comes back into a match is not told again that no files were sent."""
    page = seated(venue, sit, "--seconds", "60")
    page.is_toasted("You sent no files.")
    other = playing(venue, page)
    page.page.reload()
    page.stands("seated")
    page.phase(Phase.PLAYING)
    page.steer(2)
    assert "You sent no files." not in page.find(".toasts").inner_text()
    other.close()


@pytest.mark.long
def test_the_key_test_and_the_language(venue: Venue, sit: Sit) -> None:
    """The key test in the settings shows what each key does; the language changes at once."""
    page = seated(venue, sit)
    page.page.click("text=Settings")
    page.page.click(".keytest")
    page.press("Numpad4", "KeyK", "x")
    page.sees(".keytest", "Numpad4 digit 4")
    page.sees(".keytest", "KeyK does nothing")
    page.sees(".keytest", "KeyX restart")
    page.page.select_option("dialog select", "ja")
    page.sees("dialog", "キーのテスト")
    page.press("Escape")
    page.is_told("準備ができたら「準備完了」を押してください")
    assert page.find("html").get_attribute("lang") == "ja"


@pytest.mark.long
def test_a_japanese_browser_gets_a_japanese_page(venue: Venue, sit: Sit) -> None:
    """In a Japanese browser the page and the court's messages are in Japanese."""
    page = opened(venue, sit, locale="ja-JP")
    page.sees(".entrance h1", "試合に参加")
    page.join(TOKENS["left"])
    page.stands("seated")
    page.press("r")
    page.is_told("準備完了です。右の席の参加を待っています")  # until then keys walk in the lobby
    page.press("2")
    page.is_toasted("キーは試合中だけ使えます")
    words = page.find("main").inner_text().replace("LACOC", "")
    # Names, keys and units stay English.
    english = set(re.findall(r"[A-Za-z]{4,}", words)) - {"Ants", "Space", "Hexapod", "main"}
    assert english <= {"Robot", "Othello"}, english


@pytest.mark.long
def test_a_seat_taken_elsewhere_can_be_taken_back(venue: Venue, sit: Sit) -> None:
    """A page whose seat was taken elsewhere says so, and takes it back only after a click."""
    page = seated(venue, sit)
    elsewhere = venue.contestant("left", "Ants")
    page.stands("lost")
    page.sees(".entrance", "nother window or computer has taken")
    assert elsewhere.seat["hold"] == "held"
    page.page.click("text=Join again")
    page.stands("seated")
    elsewhere.wait(lambda: elsewhere.seat["hold"] == "replaced")


@pytest.mark.long
def test_a_page_that_comes_back_takes_no_seat_from_who_drives_it(venue: Venue, sit: Sit) -> None:
    """A device that slept is told that another one has its seat now, and disturbs nobody."""
    page = seated(venue, sit)
    page.page.reload()
    page.stands("seated")  # its own seat, at once
    page.page.goto("about:blank")
    elsewhere = venue.contestant("left", "Ants")
    # The court says twice a second who holds a seat.
    elsewhere.wait(lambda: elsewhere.seat["session"] in _holders(elsewhere))
    page.page.go_back()
    page.stands("lost")
    page.sees(".entrance", "nother window or computer has taken")
    assert elsewhere.seat["hold"] == "held"
    elsewhere.close()  # nobody drives the seat any more
    page.page.click("text=Join again")
    page.stands("seated")


def _holders(page: PageClient) -> set[int]:
    """Return the sessions that hold a seat, as the newest health says."""
    return {seat.session for seat in page.health.seats} if page.health is not None else set()


@pytest.mark.long
def test_court_and_gateway_may_die(venue: Venue, sit: Sit, console: Any) -> None:
    """While court or gateway is down, the page shows a banner and grey keys; then play goes on."""
    court = venue.court("--seconds", "120")
    web = venue.web()
    page = sit(venue.url)
    page.open(token=TOKENS["left"])
    page.join(TOKENS["left"])
    page.stands("seated")
    other = playing(venue, page)
    page.press("2")
    page.key_stands(2)
    joined = seats_taken(page)
    assert joined  # a slow page may have asked for its seat again

    court.kill()
    page.sees(".banner", "Waiting for court main")
    page.sees(".pad.off")
    page.press("3")  # has no effect
    venue.court("--seconds", "120")
    page.misses(".banner")
    page.misses(".pad.off")
    page.phase(Phase.HALTED)
    page.is_told("Halted. Please wait until the referee resumes")
    other.close()

    console.expect_a_break()
    web.kill()
    page.sees(".banner", "The connection is lost.")
    page.sees(".pad.off")
    page.is_told("No connection to the court")
    venue.web()
    page.stands("seated")
    page.misses(".banner")
    referee = venue.referee()
    referee.ask("decide", decision={"type": "resume"}, reason="power cut")
    page.phase(Phase.PLAYING)
    page.press("1")
    page.key_stands(1)
    assert seats_taken(page) == joined  # no event is shown twice


def seats_taken(page: Contestant) -> int:
    """Return how often the page's log says that its team took the seat."""
    said = page.find(".log li").all_inner_texts()
    return sum("Ants takes the left seat" in one for one in said)


@pytest.mark.long
def test_a_silent_court_is_not_shown_as_live(venue: Venue, sit: Sit) -> None:
    """While its court sends nothing, the page shows a banner and calls the connection bad."""
    court = venue.court()
    venue.web()
    page = sit(venue.url)
    page.open(token=TOKENS["left"])
    page.join(TOKENS["left"])
    page.stands("seated")
    court.signal(signal.SIGSTOP)
    page.sees(".banner")
    page.sees(".link-state:not(.good)")
    court.signal(signal.SIGCONT)
    page.sees(".link-state.good")


@pytest.mark.long
def test_the_result_says_who_won_and_one_stays_for_the_next(venue: Venue, sit: Sit) -> None:
    """The page shows who won and why, links to the replay, and keeps its seat."""
    page = seated(venue, sit, "--seconds", "1")
    other = started(venue, page)  # a busy browser may not show one second of play
    page.sees(".result h1", "A draw")
    page.is_told("The referee is confirming the result")
    referee = venue.referee()
    referee.ask("take_over")
    decision = {"type": "adjust", "seat": "left", "points": 3}
    referee.ask("decide", decision=decision, reason="for the test")
    decision = {"type": "declare", "winner": "left"}
    referee.ask("decide", decision=decision, reason="for the test")
    page.sees(".result h1", "You win")
    page.sees(".result .by", "by 3")
    page.sees(".result .kicker", "By the rules")
    page.sees(".result .corrected li", "+3 for Ants. Reason: for the test")
    decision = {"type": "declare", "winner": "right"}
    referee.ask("decide", decision=decision, reason="it left the field")
    page.sees(".result h1", "Bees wins")
    page.sees(".result .kicker", "Decided by the referee, not by the score")
    page.sees(".result .ruling", "Reason: it left the field")
    page.sees(".result", "time is up · 0:01.0 played")
    referee.ask("decide", decision={"type": "official"}, reason="")
    page.is_told("Wait here: you play in the next match too")
    # The replay is listed before the next match opens, with the teams and the result.
    page.sees(".result a", "Watch the replay")
    replay = sit(venue.url)
    replay.open("/replay")
    replay.sees(".recordings b", "Ants 21 : 18 Bees")
    replay.sees(".recordings .won", "Bees")
    replay.sees(".recordings li", "Robot-Othello")
    replay.page.click(".recordings a")
    replay.sees(".score-bug .team", "Ants")
    referee.ask("decide", decision={"type": "next"}, reason="")
    page.phase(Phase.LOBBY)
    page.is_told("Press Ready when you are ready")
    page.misses(".result")
    other.close()


@pytest.mark.long
def test_a_tablet_and_a_phone(venue: Venue, sit: Sit) -> None:
    """On a phone touch steers the robot, and all keys fit on the screen."""
    phone = {"width": 390, "height": 844}
    page = seated(venue, sit, viewport=phone, has_touch=True, is_mobile=True)
    page.find("button.ready").tap()
    page.is_told("You are ready")
    page.find(".ready.said button").tap()
    other = playing(venue, page)
    for digit in (2, 1):
        page.find(f'.key[data-key="{digit}"]').tap()
        page.key_stands(digit)
    assert hidden_discs(page) == []
    page.find(".badge").tap()
    page.sees(".badge", "View 2/3")
    assert page.page.evaluate("document.documentElement.scrollWidth") <= phone["width"]
    for digit in range(4):
        box = page.find(f'.key[data-key="{digit}"]').bounding_box()
        assert box is not None
        assert box["x"] >= 0
        assert box["x"] + box["width"] <= phone["width"]
        assert box["y"] + box["height"] <= phone["height"]
        assert min(box["width"], box["height"]) >= 44
    assert page.find('.key[data-key="7"]').is_hidden()  # it does nothing
    box = page.find(".map .board").bounding_box()
    foot = page.find(".foot").bounding_box()
    assert box is not None
    assert foot is not None
    assert box["height"] >= 120
    assert box["y"] + box["height"] <= foot["y"]
    other.close()


@pytest.mark.long
def test_accessible(venue: Venue, sit: Sit) -> None:
    """Axe-core finds no serious mistake in the join form, the match and the dialogs."""
    pytest.importorskip("axe_core_python")
    page = opened(venue, sit)
    page.sees(".own-seat")
    assert violations(page.page) == []
    page.join(TOKENS["left"])
    page.stands("seated")
    assert violations(page.page) == []
    for dialog in ("Settings", "Change files"):
        page.page.click(f"text={dialog}")
        page.sees("dialog")
        assert violations(page.page) == []
        page.press("Escape")
        page.misses("dialog")
    other = playing(venue, page)
    page.press("2")
    page.key_stands(2)
    assert violations(page.page) == []
    other.close()


@pytest.mark.long
def test_pos_data_is_of_the_seat_that_is_held(venue: Venue, sit: Sit, tmp_path: Path) -> None:
    """After a change of seats, Pos-data.txt has only the path of the new seat's robot."""
    page = seated(venue, sit)
    for seat, other in (("left", "right"), ("right", "left")):
        if seat == "right":
            page.press("z")
            page.download(lambda: page.page.click("text=Save and leave"), tmp_path)
            page.page.click("text=Join a match")
            page.page.click("text=Another token")
            page.join(TOKENS[seat])
            page.stands("seated")
        page.page.click("button.ready")
        opponent = venue.contestant(other, "Bees")
        page.phase(Phase.READY)
        stood_on(opponent, beats=25)
        if seat == "left":
            opponent.ask("leave")
            opponent.close()
    page.press("z")
    _, text = page.download(lambda: page.page.click("text=Only save"), tmp_path)
    places_m = [float(row.split("\t")[1]) for row in text.splitlines()[1:]]
    assert len(places_m) > 20
    assert min(places_m) == pytest.approx(0.75, abs=0.02)  # column 5 (rules 5)


def stood_on(page: PageClient, beats: int) -> None:
    """Wait until the court has played this many further beats."""
    page.wait(lambda: page.frame)
    assert page.frame is not None
    until = page.frame.beat + beats
    page.wait(lambda: page.frame and page.frame.beat > until)


def test_pos_data_is_what_python_writes(venue: Venue, sit: Sit) -> None:
    """The page writes Pos-data.txt byte for byte as Python does from the same frames (rules 2)."""
    page = opened(venue, sit)
    page.until("Boolean(window.__lacoc?.posData)")
    joints = (12, 18)
    for seat in range(2):
        frames = list(walk(random.Random(seat), joints))
        expected = PosData(seat, joints)
        for frame in frames:
            expected.add(frame)
        shown = pos_data(page, seat, joints, frames)
        assert shown["text"] == expected.text()
        assert "saved from 0:02.0 on, when this page was loaded" in shown["says"]
        assert "The record of the match has the whole path." in shown["says"]
        assert (
            shown["saysInPractice"] + " The record of the match has the whole path."
            == (shown["says"])
        )  # practice keeps a record only if it is asked to


@pytest.mark.long
def test_pos_data_keeps_the_newest(venue: Venue, sit: Sit) -> None:
    """The page keeps only the newest rows of a long practice, and says when they begin."""
    frames = list(walk(random.Random(0), (12, 18)))
    whole = PosData(1, (12, 18))
    for frame in frames:
        whole.add(frame)
    header, *rows = whole.text().splitlines()
    venue.web()
    for locale, says in (("en-GB", "keeps only the last hour"), ("ja-JP", "最新の 1 時間")):
        page = sit(venue.url, locale=locale)
        page.open()
        page.until("Boolean(window.__lacoc?.posData)")
        shown = pos_data(page, 1, (12, 18), frames, 100)
        assert shown["text"].splitlines() == [header, *rows[-100:]]
        assert says in shown["says"]
        assert re.search(r" 0:\d\d\.\d ", shown["says"])


def pos_data(page: Contestant, *args: Any) -> dict[str, str]:
    """Let a page write Pos-data.txt from frames.

    Args:
        page: the page.
        args: the seat's index, the number of joints of each robot, the frames, and optionally the
            most rows that the page keeps.

    Returns:
        The file's "text", and the page's note about the file: "says", or "saysInPractice".
    """
    seat, joints, frames, *most = args
    sent = [base64.b64encode(encode(frame)).decode() for frame in frames]
    shown: dict[str, str] = page.page.evaluate(
        """([seat, joints, frames, most]) => window.__lacoc.posData(seat, joints, frames.map(
            (text) => Uint8Array.from(atob(text), (one) => one.charCodeAt(0))), most)""",
        [seat, joints, sent, *(most or [180_000])],
    )
    return shown


def walk(chance: random.Random, joints: tuple[int, ...]) -> list[Frame]:
    """Make frames with gaps, several phases, a late frame, and numbers that are hard to round."""
    phases = [Phase.LOBBY, Phase.READY, Phase.COUNTDOWN, Phase.PLAYING, Phase.HALTED]
    beats = sorted(chance.sample(range(4000), 600))
    beats[10:12] = beats[11:9:-1]  # one frame comes late
    frames = []
    for index, beat in enumerate(beats):
        phase = phases[min(index // 100, 4)] if index < 560 else Phase.PLAYING
        if index >= len(beats) - 2:
            phase = Phase.FINISHED
        numbers: list[float] = []
        for count in joints:
            place = [chance.randrange(-400, 400) / 128 for _ in range(3)]
            quat = [chance.gauss(0, 1) for _ in range(4)]
            length = math.hypot(*quat)
            angles = [chance.choice([0.0, -0.0, chance.uniform(-2.7, 2.7)]) for _ in range(count)]
            numbers += [*place, *(part / length for part in quat), *angles]
        poses = b"" if phase == Phase.LOBBY else np.array(numbers, "<f4").tobytes()
        seat = SeatFrame(3, 0, 0, 0, 0, 0, 0, 0, 0, 0)
        clock = min(index, len(beats) - 2)  # the clock stands in the last frame
        frames.append(
            Frame(1, beat, int(phase), 0, clock, (seat, seat), b"", poses, bytes(8), bytes(8))
        )
    return frames
