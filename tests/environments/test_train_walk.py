"""examples/train_walk.py, if Stable-Baselines3 is installed; it is no package of the tests."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLE = Path(__file__).parents[2] / "examples" / "train_walk.py"


@pytest.mark.long(2)
def test_the_example_trains_a_policy(tmp_path: Path) -> None:
    """The example prints how far the sample table and the policy come, and writes the policy."""
    pytest.importorskip(
        "stable_baselines3", reason="the example needs: pip install stable-baselines3"
    )
    run = [sys.executable, str(EXAMPLE), "--steps", "6000", "--out", "walk.zip"]
    shown = subprocess.run(run, cwd=tmp_path, capture_output=True, text=True, check=True).stdout
    table, trained, _ = shown.splitlines()
    came = re.search(r"sample table.*: ([\d.]+) m in 20 s .*, 0 of 5 falls", table)
    assert came is not None, table
    assert 0.8 < float(came[1]) < 2.0
    assert re.fullmatch(r"6144 steps, \d+ s: -?[\d.]+ m in 20 s .* falls", trained)
    assert (tmp_path / "walk.zip").exists()
    assert (tmp_path / "walk.normalize").exists()
