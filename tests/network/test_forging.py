"""A short run of `benchmarks.forging`, in which hostile clients forge messages."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.mark.slow
@pytest.mark.long(minutes=3)
def test_nothing_forged_is_accepted() -> None:
    """A court accepts no forgery.

    This holds with all protection, and with tokens and seals alone.
    """
    command = [sys.executable, "-m", "benchmarks.forging", "--attempts", "2000"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=600)
    decoder, found, text = json.JSONDecoder(), [], done.stdout.strip()
    while text:
        one, end = decoder.raw_decode(text)
        found.append(one)
        text = text[end:].strip()

    assert done.returncode == 0, done.stdout + done.stderr
    assert [one["right"] for one in found] == [True] * 2
    assert {sum(one["accepted"].values()) for one in found} == {0}
    refused = found[1]["refused by the court"]["commands"]
    assert {"bad-seal", "old", "not-your-seat"} <= set(refused)  # so the forgeries did arrive
