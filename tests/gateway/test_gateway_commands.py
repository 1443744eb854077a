"""Tests of commands that open a page: what they print and fill in, and how they end."""

import contextlib
import re
import signal
import subprocess
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from court_process import CourtProcess
from lacoc_process import Lacoc, environment, run_lacoc
from own_page import OwnPage
from page_client import PageClient
from waiting import LIMIT_S

from lacoc_client.web.gateway.files import NOT_BUILT, PageFiles
from lacoc_robots.library import sample_gait_files
from lacoc_shared.seat import Phase
from lacoc_shared.words import render

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not PageFiles().built, reason=render(NOT_BUILT)),
]


@pytest.fixture
def stack() -> Iterator[ExitStack]:
    with ExitStack() as opened:
        yield opened


def test_play_fills_its_page_in(tmp_path: Path, stack: ExitStack) -> None:
    """The page of `lacoc play` gets the command's seat, name and files, and needs no token."""
    court = CourtProcess(tmp_path, "--arena", "othello")
    stack.callback(court.close)
    gait = sample_gait_files("hexapod").locomotion
    assert gait is not None
    (tmp_path / "LocoTra-data.txt").write_bytes(gait.data)
    play = OwnPage(tmp_path, "play", "--name", "Ants", *court.where("left"))
    assert play.path == "/play"
    assert "Files used from this folder: LocoTra-data.txt." in play.said
    with PageClient(play.url) as stranger:
        assert stranger.welcome["prefill"] is None
    with PageClient(play.url, play.key) as page:
        assert page.welcome["home"] == "player"
        assert page.welcome["prefill"] == {"seat": "", "name": "Ants", "has_token": True}
        there = page.ask("where", token=None)
        assert (there["seat"], there["open"]) == ("left", True)
        assert page.files["locomotion"] == "LocoTra-data.txt"
        assert page.files["postures"] == page.files["robot"] == ""
        page.ask("join", seat="left", token=None, name="Ants")
        page.wait(lambda: page.sheet is not None and page.sheet.seats[0].team == "Ants")
        assert page.sheet is not None
        assert page.sheet.seats[0].keys == ((), (0, 1, 2, 3))
    assert play.ended() == 0
    assert "Traceback" not in play.said


BROWSER = """#!/bin/sh
exec >/dev/null 2>&1
printf '%s' "$1" > "$0.opened"
sleep 10
exit 0
"""


def browse(folder: Path, home: Path) -> tuple[Lacoc, str, str]:
    """Start `lacoc play` with a fake browser; return process, page key and the opened address."""
    browser = folder / "browser"
    browser.write_text(BROWSER)
    browser.chmod(0o755)
    play = Lacoc(
        *("play", "--connect", "tcp/127.0.0.1:1"),
        stdout=subprocess.PIPE,
        stdin=subprocess.DEVNULL,
        text=True,
        cwd=folder,
        env={**environment(), "BROWSER": f"{browser} %s", "HOME": str(home)},
    )
    assert play.stdout is not None
    found = re.search(r"Opened http\S+#key=(\S+)", play.stdout.readline())
    assert found is not None
    return play, found[1], (folder / "browser.opened").read_text()


@pytest.mark.skipif(not Path("/proc/self/cmdline").exists(), reason="reads /proc")
def test_the_key_stands_in_no_command_line(tmp_path: Path) -> None:
    """No command line has the page key: the browser opens a file that other users can't read."""
    play, key, opened = browse(tmp_path, tmp_path)
    try:
        titles = b""
        for process in Path("/proc").glob("[0-9]*"):
            with contextlib.suppress(OSError):  # it has ended
                titles += (process / "cmdline").read_bytes()
        assert str(tmp_path / "browser").encode() in titles
        assert key.encode() not in titles
        file = Path(opened.removeprefix("file://"))
        assert f"/play#key={key}" in file.read_text()
        assert file.stat().st_mode & 0o777 == 0o600
        assert file.parent.stat().st_mode & 0o777 == 0o700
        # A browser in a sandbox sees neither /tmp nor hidden folders.
        assert file.parent.parent == tmp_path
        assert not file.parent.name.startswith(".")
    finally:
        play.send_signal(signal.SIGINT)
        play.communicate(timeout=LIMIT_S)
    assert play.returncode == 0
    assert not file.parent.exists()


def test_without_a_home_the_page_opens_all_the_same(tmp_path: Path) -> None:
    """If the file with the page key can't be written, the browser gets an address with the key."""
    play, key, opened = browse(tmp_path, tmp_path / "nowhere")
    play.send_signal(signal.SIGINT)
    play.communicate(timeout=LIMIT_S)
    assert opened.endswith(f"/play#key={key}")
    assert play.returncode == 0


def test_play_needs_no_seat_to_open(tmp_path: Path, stack: ExitStack) -> None:
    """`lacoc play` opens its page without seat, name or token, even before a court runs."""
    play = OwnPage(tmp_path, "play", "--connect", "tcp/127.0.0.1:1")
    with PageClient(play.url, play.key) as page:
        expected = {"seat": "", "name": "", "has_token": False}
        assert page.welcome["prefill"] == expected
        page.wait(lambda: page.waits_why == "connect.nobody")
    assert play.ended() == 0


def test_practice_has_a_court_of_its_own(tmp_path: Path) -> None:
    """`lacoc practice` runs a court of its own, in which a page joins and plays (workshop 4-4)."""
    practice = OwnPage(tmp_path, "practice", "--recordings", "kept")
    assert practice.path == "/practice"
    with PageClient(practice.url, practice.key, hz=50) as page:
        assert page.welcome["home"] == "practice"
        assert page.welcome["prefill"]["seat"] == "solo"
        page.ask("join", seat="solo", token=None, name="")
        page.ask("ready", ready=True)
        page.phase(Phase.PLAYING)
        seq = page.press(level=0, key=1)
        page.wait_own(lambda own: own.applied_seq >= seq)
    assert practice.ended() == 0
    assert [path.suffix for path in (tmp_path / "kept").iterdir()] == [".mcap"]


def test_watch_shows_a_court(tmp_path: Path, stack: ExitStack) -> None:
    """The address that `lacoc watch` opens has no page key, so its page can only watch."""
    court = CourtProcess(tmp_path, "--arena", "othello")
    stack.callback(court.close)
    watch = OwnPage(tmp_path, "watch", *court.where())
    assert (watch.path, watch.key) == ("/watch", "")
    with PageClient(watch.url) as page:
        page.wait(lambda: page.frame and page.scene)
    assert watch.ended() == 0


@pytest.mark.long
def test_demo_says_where_its_page_is_early(tmp_path: Path) -> None:
    """`lacoc demo` first prints its page's address, and ends after the official result."""
    words = ("demo", "--seconds", "2", "--speed", "4")
    no_screen = {**environment(), "DISPLAY": "", "WAYLAND_DISPLAY": "", "BROWSER": ""}
    done = run_lacoc(*words, cwd=tmp_path, env=no_screen, timeout_s=90)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("Watch at http://127.0.0.1:")
    assert "The result is official." in done.stdout


@pytest.mark.long
def test_demo_without_a_head_opens_nothing(tmp_path: Path) -> None:
    """`lacoc demo --headless` opens no page."""
    words = ("demo", "--headless", "--seconds", "2", "--speed", "4")
    done = run_lacoc(*words, cwd=tmp_path, env=environment(), timeout_s=90)
    assert done.returncode == 0, done.stderr
    assert "http://" not in done.stdout
