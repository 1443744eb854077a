"""The import contracts hold, and each one notices an import that is planted to break it."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
ROOMS = ("shared", "robots", "arenas", "server", "client")

pytestmark = pytest.mark.slow


def broken_walls(tree: Path) -> list[str]:
    """Check the import contracts of a source tree; return the names of the broken ones.

    The tree's own folders come first on the path, so that the tree is checked and not the
    installed checkout.
    """
    paths = [str(tree / room) for room in ROOMS]
    code = f"import sys; sys.path[:0] = {paths!r}; from importlinter.cli import lint_imports; "
    done = subprocess.run(
        [sys.executable, "-c", code + "sys.exit(lint_imports(no_cache=True))"],
        cwd=tree,
        capture_output=True,
        text=True,
        check=False,
    )
    lines = done.stdout.splitlines()
    broken = [
        name for line in lines for name, is_broken, _ in [line.partition(" BROKEN")] if is_broken
    ]
    assert any(" KEPT" in line for line in lines), done.stdout + done.stderr
    assert bool(broken) == bool(done.returncode)
    return broken


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """Give a copy of all packages and of pyproject.toml."""
    for room in ROOMS:
        shutil.copytree(
            ROOT / room,
            tmp_path / room,
            ignore=shutil.ignore_patterns("__pycache__", "node_modules"),
        )
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    return tmp_path


def test_the_walls_stand(tree: Path) -> None:
    """No import in the project breaks one of the walls (the contracts in pyproject.toml)."""
    assert broken_walls(tree) == []


ONE_WAY = "Imports go one way"
BEAT = "A court's packages stand above one another"
CONTEST = "A contest's packages stand above one another"
PAGES = "A client's packages stand above one another"
CONTRACT = "What all share has the contract below everything else"
PURE = "What decides is pure: time and chance come in as arguments"
MUJOCO = "Only models, fields and the world know MuJoCo"
ZENOH = "Only the session knows Zenoh"
LEAGUE = "A league knows facts, not robots"
CLIENT = "A client needs nothing of a court's"


PLANTED = [
    ("shared/lacoc_shared/gait/tables.py", "import lacoc_robots", {ONE_WAY}),
    ("arenas/lacoc_arenas/othello/rules.py", "import time", {PURE}),
    ("server/lacoc_server/match/staging.py", "import lacoc_server.world.world", {BEAT, PURE}),
    ("server/lacoc_server/journal/journal.py", "import lacoc_server.court.health", {BEAT}),
    (
        "server/lacoc_server/contest/league/facts.py",
        "import lacoc_server.match.match",
        {LEAGUE},
    ),
    ("server/lacoc_server/contest/kept/store.py", "import lacoc_server.contest.acts", {CONTEST}),
    ("client/lacoc_client/play/asking.py", "import lacoc_client.web.gateway.wire", {PAGES}),
    ("shared/lacoc_shared/messages/__init__.py", "import lacoc_shared.gait.tables", {CONTRACT}),
    ("shared/lacoc_shared/codec.py", "import zenoh", {ZENOH, PURE}),
    ("server/lacoc_server/journal/replay.py", "from mujoco import mj_step", {MUJOCO}),
    ("server/lacoc_server/journal/replay.py", "import zenoh.ext", {ZENOH}),
    ("client/lacoc_client/__init__.py", "import lacoc_robots.model", {CLIENT}),
    ("client/lacoc_client/__init__.py", "import mujoco", {CLIENT, MUJOCO}),
    ("client/lacoc_client/__init__.py", "import lacoc_server", {CLIENT, ONE_WAY}),
]
"""Module, planted import, and the walls that it breaks: one for each set of walls."""
MORE = [
    ("arenas/lacoc_arenas/othello/field.py", "import lacoc_server.match.drive", {ONE_WAY}),
    ("robots/lacoc_robots/robot_file.py", "import lacoc_arenas.game", {ONE_WAY}),
    ("arenas/lacoc_arenas/arena.py", "import lacoc_robots.robot_file", {ONE_WAY}),
    ("server/lacoc_server/match/drive.py", "import lacoc_client", {ONE_WAY}),
    ("arenas/lacoc_arenas/flag_strike/rules.py", "from random import random", {PURE}),
    ("arenas/lacoc_arenas/practice/rules.py", "import threading", {PURE}),
    ("arenas/lacoc_arenas/othello/bots.py", "import asyncio", {PURE}),
    ("robots/lacoc_robots/robot_file.py", "from datetime import datetime", {PURE}),
    ("server/lacoc_server/match/drive.py", "import secrets", {PURE}),
    ("server/lacoc_server/match/referee.py", "import subprocess", {PURE}),
    ("server/lacoc_server/doors/inbox.py", "import lacoc_server.match.match", {BEAT}),
    ("server/lacoc_server/doors/inbox.py", "import secrets", {PURE}),
    ("server/lacoc_server/court/health.py", "import time", {PURE}),
    ("server/lacoc_server/contest/league/timetable/schedule.py", "import time", {PURE}),
    ("shared/lacoc_shared/gait/tables.py", "import time", {PURE}),  # the rules depend on it
    ("client/lacoc_client/workshop/phases/predicates.py", "import time", {PURE}),
    ("client/lacoc_client/__init__.py", "import lacoc_arenas.othello.field", {CLIENT}),
    ("client/lacoc_client/film/site.py", "import lacoc_client.workshop.phases", {PAGES}),
    ("server/lacoc_server/contest/standby/door.py", "import lacoc_server.contest.live", {CONTEST}),
]


def plant(tree: Path, module: str, line: str) -> None:
    """Add an import to a module of a source tree."""
    with (tree / module).open("a", encoding="utf-8") as file:
        file.write(f"\n{line}\n")


def test_all_broken_walls_are_found(tree: Path) -> None:
    """Planted imports break all contracts that forbid one of them."""
    for module, line, _ in PLANTED:
        plant(tree, module, line)
    assert set(broken_walls(tree)) == set().union(*(walls for *_, walls in PLANTED))


@pytest.mark.long
@pytest.mark.parametrize(("module", "line", "walls"), [*PLANTED, *MORE])
def test_a_broken_wall_is_found(tree: Path, module: str, line: str, walls: set[str]) -> None:
    """A planted import breaks exactly the contracts that forbid it."""
    plant(tree, module, line)
    assert set(broken_walls(tree)) == walls
