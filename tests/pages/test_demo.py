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
from court_process import environment
from lacoc_process import COMMAND
from show import Show

pytestmark = [pytest.mark.slow, pytest.mark.long]


@pytest.fixture
def demo(tmp_path: Path, built_pages: Path) -> Iterator[str]:
    """Give the address of the pages of a `lacoc demo`, which Ctrl-C ends after the test."""
    browser = tmp_path / "browser"
    browser.write_text("#!/bin/sh\n")
    browser.chmod(0o755)
    screen, terminal = pty.openpty()
    process = subprocess.Popen(  # a forked process has no terminal of its own
        [*COMMAND, "demo", "--seconds", "2"],
        stdout=terminal,
        cwd=tmp_path,
        env={**environment(), "BROWSER": f"{browser} %s"},
    )
    os.close(terminal)
    said = ""
    while (found := re.search(r"Watch at (http://\S+)/watch", said)) is None:
        said += os.read(screen, 4096).decode()
    yield found[1]
    process.send_signal(signal.SIGINT)
    assert process.wait(30) == 0
    os.close(screen)


def test_it_ends_on_the_result_with_the_replay(demo: str, open_page: OpenPage) -> None:
    """After the demo the page shows the result without an alarm, and a link to the replay."""
    show = Show(open_page(), demo, "/watch?q=low")
    show.sees(".result h1")
    show.sees(".banner.calm", "The match is over, and its court has closed.")
    show.misses(".scene.stale")
    show.find(".result a", has_text="Watch the replay").click()
    show.sees(".replay .score-bug .team", "planner")
