"""A short run of `benchmarks.desk_forging`: hostile clients at the desk of an office."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("attempts", [500, pytest.param(10_000, marks=pytest.mark.long)])
def test_no_role_does_what_is_anothers(attempts: int) -> None:
    """No forgery is accepted, no client overhears another, and the organiser still gets answers."""
    command = [sys.executable, "-m", "benchmarks.desk_forging", "--attempts", str(attempts)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stdout + done.stderr
    found = json.loads(done.stdout)
    assert found["right"]
    assert sum(found["attempts"].values()) == attempts
    assert not found["accepted"]
    asked = {"desk.not-organiser", "desk.no-such-team", "desk.name-taken", "desk.bad-request"}
    assert asked <= set(found["refused"]), "the forgeries did arrive"
