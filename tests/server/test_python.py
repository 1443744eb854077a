"""`import lacoc`: the page of docs as printed, in a new interpreter."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

import lacoc
from lacoc_robots.library import robot_folder
from lacoc_shared.gait.tables import Level
from lacoc_shared.mistakes import UserError

pytestmark = pytest.mark.slow

PAGE = (Path(__file__).parents[2] / "docs" / "python.md").read_text(encoding="utf-8")
SAMPLE = robot_folder("hexapod") / "Loco-data.xlsx"


def run(code: str, folder: Path) -> str:
    """Run code in a new interpreter; return what it printed."""
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=folder, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_the_page_is_right(tmp_path: Path) -> None:
    """The code of docs/python.md runs as printed, and leaves nothing behind."""
    (code,) = re.findall(r"^```python\n(.*?)^```", PAGE, re.M | re.S)
    (tmp_path / SAMPLE.name).write_bytes(SAMPLE.read_bytes())
    said = run(code.replace("seconds=20", "seconds=2"), tmp_path)
    assert re.search(r"^speed forward +\d+\.\d mm/s$", said, re.M)
    assert re.search(r"^(left|right|draw) \[\d+ \d+\]$", said, re.M)
    assert [path.name for path in tmp_path.iterdir()] == [SAMPLE.name]


@pytest.mark.parametrize(
    "words",
    [
        "import lacoc, gymnasium; env = gymnasium.make('lacoc/Walk-v0')",
        "import gymnasium; env = gymnasium.make('lacoc:lacoc/Walk-v0')",
        "import lacoc; env = lacoc.make('FlagStrike-v0', opponent='straight')",
    ],
)
def test_an_environment_is_made(tmp_path: Path, words: str) -> None:
    """Gymnasium knows the environments as soon as `lacoc` is imported."""
    assert (
        run(f"{words}; seen, _ = env.reset(seed=1); print(seen in env.observation_space)", tmp_path)
        == "True\n"
    )


def test_nothing_heavy_is_imported_before_it_is_needed(tmp_path: Path) -> None:
    """`import lacoc` imports no physics."""
    told = run("import lacoc, sys; print(*sys.modules)", tmp_path).split()
    assert "lacoc" in told
    assert "mujoco" not in told


def test_a_table_is_read_once_and_walked_often() -> None:
    """A gait that was read walks as its file does."""
    gait = lacoc.load_table(SAMPLE)
    assert gait.keys(Level.LOCOMOTION) == (0, 1, 2, 3)
    assert lacoc.walk(gait, keys="2", seconds=1.0).figures == (
        lacoc.walk(str(SAMPLE), keys="2", seconds=1.0).figures
    )


def test_a_record_is_kept_where_it_is_wanted(tmp_path: Path) -> None:
    """With `record`, each match keeps its record, and none is overwritten."""
    for _ in range(2):
        match = lacoc.simulate("straight", "nearest", seconds=0.5, record=tmp_path)
    names = sorted(path.name for path in tmp_path.iterdir())
    assert names == ["simulated-001.mcap", "simulated-002.mcap"]
    again = lacoc.read_record(tmp_path / names[1])
    assert (again.match_id, again.winner) == (match.match_id, match.winner)


def test_a_match_of_no_length_is_refused() -> None:
    """A match of 0 s is not taken for one of the arena's length."""
    with pytest.raises(UserError, match="has no time limit"):
        lacoc.simulate("straight", "straight", seconds=0)


def test_what_is_missing_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without the packages of a court, an error says what to install."""
    monkeypatch.setattr(lacoc, "find_spec", lambda _: None)
    with pytest.raises(UserError, match="needs mujoco, which is not installed"):
        lacoc.walk(SAMPLE)
    with pytest.raises(UserError, match="Cannot read nothing"):
        lacoc.load_table("nothing.txt")
