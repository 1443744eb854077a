"""Runs the core's tests in a copy of this checkout that has no satellites.

    python tests/project/core_alone.py

A satellite is something that the core does not need: films, training, what-if, classes, the
director, the studio (docs/architecture.md). Whoever carries the core on need not know them.
"""

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[2]
SATELLITES = (
    "arenas/lacoc_arenas/learned",
    "client/lacoc_client/film",
    "client/lacoc_client/web/director",
    "client/lacoc_client/workshop",
    "server/lacoc_server/simulate/environments",
    "server/lacoc_server/simulate/forks",
    "server/lacoc_server/studio",
)
CORE_TESTS = (
    *("arenas", "client", "contest", "gait", "gateway", "league", "network", "record"),
    *("robots", "server", "shared"),
)
TESTS_OF_SATELLITES = (
    "arenas/test_learned.py",
    "server/test_coach.py",
    "server/test_forks.py",
    "server/test_mistakes.py",
    "server/test_odds.py",
    "server/test_studio.py",
    "server/test_styles.py",
    "server/test_trial.py::test_the_command",
)
"""Tests beside the core's that need a satellite."""


def main() -> int:
    """Copy what git knows, delete the satellites, and return the exit code of the tests."""
    listed = subprocess.run(
        ["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True
    )
    with tempfile.TemporaryDirectory(prefix="lacoc-core-") as name:
        folder = Path(name)
        for file in filter(None, listed.stdout.split("\0")):
            if (ROOT / file).is_file():
                (folder / file).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(ROOT / file, folder / file)
        pages = ROOT / "client" / "lacoc_client" / "pages"
        if pages.is_dir():
            shutil.copytree(pages, folder / pages.relative_to(ROOT))
        for satellite in SATELLITES:
            shutil.rmtree(folder / satellite)
        rooms = [str(folder / room) for room in ("server", "client", "arenas", "robots", "shared")]
        tests = [f"tests/{one}" for one in CORE_TESTS]
        left_out = [f"--deselect=tests/{one}" for one in TESTS_OF_SATELLITES if "::" in one]
        left_out += [f"--ignore=tests/{one}" for one in TESTS_OF_SATELLITES if "::" not in one]
        words = [sys.executable, "-m", "pytest", "-q", "-m", "not slow", *left_out, *sys.argv[1:]]
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(rooms)}
        return subprocess.run([*words, *tests], cwd=folder, env=environment, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
