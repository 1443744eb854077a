"""Which work goes first: real-time priority for a thread, where the system allows it."""

import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from running import served, until, write_contest

from lacoc_client.play.spectator import Spectator
from lacoc_shared.command.priority import go_first, take_turns
from lacoc_shared.contest.file import load
from lacoc_shared.network.session import open_client
from lacoc_shared.seat import BEATS_PER_S

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="only Linux has this priority")


def policy() -> int:
    return os.sched_getscheduler(0) & ~os.SCHED_RESET_ON_FORK


def test_a_thread_goes_first() -> None:
    """The thread alone gets the priority, not the threads and programs that it starts."""
    before = policy()
    with ThreadPoolExecutor(1) as thread:
        if not thread.submit(go_first).result():
            pytest.skip("this system does not allow it")
        assert thread.submit(policy).result() == os.SCHED_FIFO
        started = thread.submit(_policies_of_started).result()
        thread.submit(take_turns).result()
        assert thread.submit(policy).result() == os.SCHED_OTHER
    assert policy() == before
    assert started == [os.SCHED_OTHER, os.SCHED_OTHER]


def _policies_of_started() -> list[int]:
    with ThreadPoolExecutor(1) as inner:
        thread = inner.submit(policy).result()
    said = subprocess.check_output([sys.executable, "-c", _SAY_POLICY], text=True)
    return [thread, int(said)]


_SAY_POLICY = "import os; print(os.sched_getscheduler(0))"


@pytest.mark.skipif(not hasattr(os, "getuid") or os.getuid(), reason="only root can forbid it")
def test_a_user_may_always_give_it_back() -> None:
    """Without the right to the priority a thread can't take it, but it can give it back."""
    with ThreadPoolExecutor(1) as thread:
        is_allowed = thread.submit(go_first).result()
    said = subprocess.check_output([sys.executable, "-c", _AS_USER], text=True)
    first = os.SCHED_FIFO if is_allowed else os.SCHED_OTHER
    assert said.split() == [str(first), str(os.SCHED_OTHER), "False", str(os.SCHED_OTHER)]


_AS_USER = """
import os, resource
from lacoc_shared.command.priority import go_first, take_turns
policy = lambda: os.sched_getscheduler(0) & ~os.SCHED_RESET_ON_FORK
resource.setrlimit(resource.RLIMIT_RTPRIO, (0, 0))
go_first()
os.setuid(65534)
print(policy())
take_turns()
print(policy(), go_first(), policy())
"""


@pytest.mark.slow
@pytest.mark.parametrize("speed", [1, 2])
def test_a_courts_beats_go_first(tmp_path: Path, speed: int) -> None:
    """In real time they do; at twice the speed they would take too much from other programs."""
    with ThreadPoolExecutor(1) as thread:
        is_allowed = thread.submit(go_first).result()
    contest = write_contest(tmp_path / "contest.toml")
    with (
        served(contest, tmp_path, "--speed", str(speed)) as court,
        open_client([load(contest).court()[1].address()]) as session,
    ):
        view = Spectator(session, "main")
        until([view], lambda: view.health is not None and view.health.beat > BEATS_PER_S)
        if is_allowed and speed == 1:  # on a busy machine the court may have to catch up first
            until([view], lambda: bool(os.sched_getscheduler(court.pid) & os.SCHED_FIFO))
        else:
            assert not os.sched_getscheduler(court.pid) & os.SCHED_FIFO
