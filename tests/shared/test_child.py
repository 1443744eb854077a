"""Processes that a command starts and ends for itself."""

import os
import subprocess
import threading
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import psutil
import pytest
from waiting import until

from lacoc_shared.command.child import kept_child
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import Phrase, say

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(os.name != "posix", reason="kill -9"),
]

Kept = Callable[[], list[psutil.Process]]


def _children() -> list[psutil.Process]:
    """Return the running `lacoc` processes that this process started."""
    found = []
    for one in psutil.Process().children():
        with suppress(psutil.NoSuchProcess):  # it was killed, and ends at this moment
            if "lacoc_shared" in " ".join(one.cmdline()):
                found.append(one)
    return found


@pytest.fixture
def kept() -> Kept:
    """Give a function that returns the processes of this test; other tests may keep some too."""
    before = _children()
    return lambda: [one for one in _children() if one not in before]


def test_a_process_that_is_killed_while_it_starts_is_started_again(
    tmp_path: Path, kept: Kept
) -> None:
    """A studio that something kills before it is ready does not end the command that wants it."""
    killed: list[int] = []

    def kill_first() -> None:
        until(kept)
        first = kept()[0]
        first.kill()
        killed.append(first.pid)

    killer = threading.Thread(target=kill_first)
    killer.start()
    words = ["studio", "--listen", "127.0.0.1:0", "--json", "--jobs", "1"]
    with kept_child(words, tmp_path, say("child.studio"), lambda _: words) as opened:
        killer.join()
        assert opened
        assert killed[0] not in [one.pid for one in kept()]


def test_a_process_that_says_why_it_can_not_start_is_not_tried_again(tmp_path: Path) -> None:
    """An error of the process is the error of the command."""
    with (
        pytest.raises(UserError, match="--nonsense"),
        kept_child(["studio", "--nonsense"], tmp_path, say("child.studio"), lambda _: []),
    ):
        pass


def test_a_process_that_can_not_be_started_again_is_tried_again(
    tmp_path: Path, kept: Kept, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A machine that has no room for a process for a moment does not end the keeping."""
    words = ["studio", "--listen", "127.0.0.1:0", "--json", "--jobs", "1"]
    told: list[Phrase] = []
    with kept_child(words, tmp_path, say("child.studio"), lambda _: words, told.append):
        (first,) = kept()
        start = subprocess.Popen
        failed: list[int] = []

        def full(*arguments: Any, **options: Any) -> Any:
            if not failed:
                failed.append(1)
                raise BlockingIOError("Resource temporarily unavailable")
            return start(*arguments, **options)

        monkeypatch.setattr(subprocess, "Popen", full)
        first.kill()
        until(lambda: [one for one in kept() if one.pid != first.pid])
        assert failed
    assert told == [say("child.again", what=say("child.studio"), why=None)]
