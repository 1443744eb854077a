"""Tests of the time that a bot may take: whoever never answers is ended and named."""

import sys
import threading
from collections.abc import Callable
from pathlib import Path

import pytest
from every_third import every_third

from lacoc_arenas import arena as arenas
from lacoc_arenas import brains, time_limit
from lacoc_shared.mistakes import UserError

pytestmark = pytest.mark.slow
OTHELLO = arenas.load("othello")


@pytest.fixture(autouse=True)
def impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the limits of processor time be short, so that a test need not wait for long."""
    monkeypatch.setattr(time_limit, "MOST", time_limit.Most(0.3, 0.3))
    monkeypatch.setattr(time_limit, "LOOK_S", 0.02)


def brain(lines: str) -> str:
    body = "".join(f"        {line}\n" for line in lines.splitlines())
    return f"import time\ndef bot(sheet, seat):\n    def brain(frame):\n{body}    return brain\n"


def ask(folder: Path, source: str, times: int = 1) -> None:
    path = folder / "my_bot.py"
    path.write_text(source, encoding="utf-8")
    see = brains.find(OTHELLO, str(path))(None, 0)  # type: ignore[arg-type]
    for _ in range(times):
        see(None)  # type: ignore[arg-type]


def in_thread(run: Callable[[], None]) -> UserError | None:
    """Run in another thread, where no signal comes; return what it raised."""
    raised: list[UserError] = []

    def work() -> None:
        try:
            run()
        except UserError as error:
            raised.append(error)

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    return raised[0] if raised else None


ENDLESS = {
    "computes": (brain("while True: pass"), r"my_bot\.py:4\): it computed .* on one frame\.$"),
    "catches": (
        brain("while True:\n    try:\n        while True: pass\n    except Exception: pass"),
        r"my_bot\.py:6\): it computed .* on one frame\.$",
    ),
    "loads": ("while True: pass\n", r"my_bot\.py:1\): it computed .* before the first frame\.$"),
    "begins": (
        "def bot(sheet, seat):\n    while True: pass\n",
        r"my_bot\.py:2\): it computed .* before the first frame\.$",
    ),
}


@pytest.mark.parametrize("how", every_third(ENDLESS))
def test_an_endless_bot_ends_in_any_thread(tmp_path: Path, how: str) -> None:
    """A bot that never answers ends with an error that names its line."""
    source, says = ENDLESS[how]
    with pytest.raises(UserError, match=rf"^The bot .*my_bot\.py did not answer .*{says}"):
        ask(tmp_path, source)
    error = in_thread(lambda: ask(tmp_path, source))
    assert error is not None
    assert "did not answer" in str(error)


@pytest.mark.skipif(sys.platform == "win32", reason="no signals to threads")
@pytest.mark.parametrize("waits", ["time.sleep(3600)", "while True: time.sleep(0.01)"])
def test_a_bot_that_sleeps_is_woken(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, waits: str
) -> None:
    """A bot that sleeps in the main thread, as in each worker process, ends as well."""
    monkeypatch.setattr(time_limit, "MOST", time_limit.Most(wait_s=0.5))
    with pytest.raises(UserError, match=r"my_bot\.py:4\): it waited for more than 0\.5 s; a bot"):
        ask(tmp_path, brain(waits))


def test_a_bot_has_a_limit_for_a_match(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A bot that stays below the limit of a frame again and again is ended too."""
    monkeypatch.setattr(time_limit, "MOST", time_limit.Most(match_s=0.9))
    source = brain(
        "end = time.thread_time() + 0.2\nwhile time.thread_time() < end: pass\nreturn None"
    )
    with pytest.raises(UserError, match=r"it took more than 0\.9 s for all frames of the match"):
        ask(tmp_path, source, times=20)


def test_a_new_match_has_the_whole_time(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What a bot has used counts for its match alone, and an honest bot is never interrupted."""
    monkeypatch.setattr(time_limit, "MOST", time_limit.Most(match_s=0.9))
    monkeypatch.setattr(time_limit, "LOOK_S", 0.15)  # seldom twice in a call: nothing counts twice
    source = brain(
        "end = time.thread_time() + 0.1\nwhile time.thread_time() < end: pass\nreturn None"
    )
    for _ in range(3):
        ask(tmp_path, source, times=4)


def test_who_answers_after_the_interruption_has_not_answered(tmp_path: Path) -> None:
    """A bot that catches the interruption and then answers is named all the same."""
    source = brain("try:\n    while True: pass\nexcept BaseException:\n    return None")
    with pytest.raises(UserError, match="did not answer"):
        ask(tmp_path, source)


def test_a_bot_that_can_not_be_interrupted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A bot that goes on after all interruptions is told with its line; the process would end."""
    told = []
    ends = threading.Event()
    monkeypatch.setattr(time_limit, "when_stuck", lambda said: (told.append(said), ends.set()))
    monkeypatch.setattr(time_limit, "ends", ends, raising=False)
    source = brain(
        "from lacoc_arenas import time_limit\n"
        "while not time_limit.ends.is_set():\n"
        "    try:\n        while not time_limit.ends.is_set(): pass\n"
        "    except BaseException: pass"
    )
    with pytest.raises(UserError, match="did not answer"):
        ask(tmp_path, source)
    assert "my_bot.py:" in str(UserError(told[0]))


@pytest.mark.parametrize("call", ["exit()", "raise SystemExit"])
def test_a_bot_that_exits_stops_with_an_error(tmp_path: Path, call: str) -> None:
    """A bot that ends the program ends only itself."""
    with pytest.raises(UserError, match=r"stopped with an error \(.*my_bot\.py:4\): SystemExit"):
        ask(tmp_path, brain(call))
