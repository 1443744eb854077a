"""A short run of `python -m benchmarks.random_kills`."""

import random
import sys
from pathlib import Path

import pytest

sys.path.append(str(Path(__file__).parents[2]))
from benchmarks.random_kills import run


@pytest.mark.long
def test_whatever_is_killed_all_goes_on(tmp_path: Path) -> None:
    """While processes are killed at random, none ends by itself, and every record verifies."""
    found = run(tmp_path, 15.0, random.Random(3))
    assert (found["ended"], found["not_same"]) == ([], [])
    assert found["same"]
