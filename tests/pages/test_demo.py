"""Tests of `lacoc demo`, the README's first command, in a terminal and with a browser."""

import os
import pty
import re
import signal
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
from chromium import OpenPage
from lacoc_process import COMMAND, environment
from show import Show
from waiting import LIMIT_S

pytestmark = [pytest.mark.slow, pytest.mark.long]


@pytest.fixture(params=["a browser", "no browser"])
def demo(tmp_path: Path, built_pages: Path, request: pytest.FixtureRequest) -> Iterator[str]:
    """Give the address of the pages of a `lacoc demo`, which Ctrl-C ends after the test."""
    browser = tmp_path / "browser"
    browser.write_text(f"#!/bin/sh\nexit {int(request.param == 'no browser')}\n")
    browser.chmod(0o755)
    no_screen = {"DISPLAY": "", "WAYLAND_DISPLAY": "", "TERM": ""}  # so no other browser is tried
    screen, terminal = pty.openpty()
    process = subprocess.Popen(  # a forked process has no terminal of its own
        [*COMMAND, "demo", "--seconds", "2"],
        stdout=terminal,
        stderr=terminal,
        cwd=tmp_path,
        env={**environment(), **no_screen, "BROWSER": f"{browser} %s"},
    )
    os.close(terminal)
    yield _read(screen, r"Watch at (http://\S+)/watch")
    _read(screen, "(Ctrl-C)")  # before it the demo still proves its record
    process.send_signal(signal.SIGINT)
    assert process.wait(LIMIT_S) == 0
    os.close(screen)


def _read(screen: int, pattern: str) -> str:
    """Read a terminal until it shows a pattern; return the pattern's group."""
    said = ""
    while (found := re.search(pattern, said)) is None:
        said += os.read(screen, 4096).decode(errors="replace")
    return found[1]


def test_it_ends_on_the_result_with_the_replay(demo: str, open_page: OpenPage) -> None:
    """After the demo the page shows the result without an alarm, and a link to the replay."""
    show = Show(open_page(), demo, "/watch?q=low")
    show.sees(".result h1")
    show.sees(".banner.calm", "The match is over. Its court does not answer now.")
    show.misses(".scene.stale")
    show.find(".result a", has_text="Watch the replay").click()
    show.sees(".replay .score-bug .team", "planner")
