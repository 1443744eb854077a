"""Test of a court that is killed at random moments from LOBBY to FINISHED (benchmarks/kills.py)."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.mark.long
def test_a_court_may_be_killed_in_any_phase() -> None:
    """A killed court comes back in the right phase, and loses nothing that it had shown."""
    command = [sys.executable, "-m", "benchmarks.kills", "--kills", "24"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=900)
    assert done.returncode == 0, done.stdout + done.stderr
