"""A short run of `benchmarks.contest_kills`: processes of a live contest are killed."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.mark.long
@pytest.mark.slow
def test_killed_processes_lose_no_result() -> None:
    """After kills of office, courts and gateway, the standings are the same as without kills."""
    words = ["--teams", "4", "--courts", "2", "--kills", "6"]
    command = [sys.executable, "-m", "benchmarks.contest_kills", *words]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=900)
    assert done.returncode == 0, done.stdout + done.stderr
