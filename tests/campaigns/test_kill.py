"""Short runs of the campaigns of `kill`: what is killed or broken goes on, and loses nothing."""

import os
import random
import subprocess
import sys
from pathlib import Path

import pytest
from aside import aside

from tests.campaigns.kill import anything, court, leftovers, online

ROOT = Path(__file__).parents[2]


@pytest.mark.long(minutes=1)
@pytest.mark.slow
def test_a_killed_court_loses_nothing() -> None:
    """A killed court comes back in the right phase, and loses nothing that it had shown.

    It is killed twice in each phase, as the plan of the campaign has them.
    """
    found = aside(lambda: court.killed(2 * len(court.PLAN), seed=1, fresh=False))
    assert found.wrong == 0, found
    assert found.verified == 2


@pytest.mark.long(minutes=2)
@pytest.mark.slow
def test_a_contest_loses_nothing_by_kills() -> None:
    """After kills of office, courts and gateway, the standings are the same as without kills."""
    command = [sys.executable, "-m", "tests.campaigns.kill.contest"]
    command += ["--teams", "4", "--courts", "2", "--kills", "6"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=900)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.long
def test_whatever_is_killed_all_goes_on(tmp_path: Path) -> None:
    """While processes are killed at random, none ends by itself, and every record verifies."""
    found = anything.run(tmp_path, 15.0, random.Random(3))
    assert (found["ended"], found["not_same"]) == ([], [])
    assert found["same"]


@pytest.mark.long(minutes=2)
@pytest.mark.skipif(os.name != "posix", reason="kill -9")
def test_what_killed_commands_leave_is_removed() -> None:
    """After kill -9 at random moments, the next start removes what was left."""
    found, left = leftovers.killed(16, fresh=False)
    assert found > 0
    assert not left


@pytest.mark.long(minutes=1)
@pytest.mark.slow
def test_a_match_goes_on_through_what_breaks(tmp_path: Path) -> None:
    """Proxy, certificate, connections and gateway break once each; the record verifies."""
    found = aside(lambda: online.played_through(tmp_path, 1))
    assert set(found) == {"renew", "cut", "restart", "kill"}
