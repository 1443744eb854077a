"""`make mutants`: change the code in one place at a time, and see if a test fails.

mutmut makes the mutants in a copy of the tree under build/mutants, and runs for each mutant the
tests that reach it. It does not mutate code that it can't reach: class bodies, tables, properties.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

from mutmut.stats import status_by_exit_code
from rich.console import Console
from rich.table import Table

ROOT = Path(__file__).parents[3]
ROOMS = ("shared", "robots", "arenas", "server", "client")
CAUGHT = frozenset({"killed", "timeout", "segfault"})


@dataclass(frozen=True)
class Area:
    """Modules that belong together, and the fast tests that check these modules."""

    name: str
    modules: tuple[str, ...]
    tests: tuple[str, ...]


AREAS = (
    Area(
        "rules",
        (
            "lacoc_arenas/game.py",
            "lacoc_arenas/layout.py",
            "lacoc_arenas/othello/rules.py",
            "lacoc_arenas/flag_strike/rules.py",
            "lacoc_arenas/flag_strike/settings.py",
            "lacoc_arenas/practice/rules.py",
        ),
        (
            "tests/arenas/test_othello_rules.py",
            "tests/arenas/test_flag_strike_rules.py",
            "tests/arenas/test_practice.py",
            "tests/arenas/test_turned.py",
            "tests/arenas/test_arena_files.py",
        ),
    ),
    Area("drive", ("lacoc_server/match/drive.py",), ("tests/server/test_drive.py",)),
    Area(
        "codec",
        ("lacoc_shared/codec.py", "lacoc_shared/seal.py"),
        ("tests/shared/test_codec.py", "tests/network/test_seal.py"),
    ),
    Area(
        "match",
        (
            "lacoc_server/match/match.py",
            "lacoc_server/match/state.py",
            "lacoc_server/match/contestant.py",
            "lacoc_server/match/referee.py",
            "lacoc_server/match/kept/history.py",
            "lacoc_server/match/seat.py",
            "lacoc_server/match/staging.py",
        ),
        (
            "tests/server/test_match.py",
            "tests/server/test_phases.py",
            "tests/server/test_referee.py",
            "tests/server/test_take_back.py",
            "tests/server/test_log.py",
        ),
    ),
)

SETTINGS = """\
[tool.pytest]
strict = true
pythonpath = ["src", "."]
addopts = ["--import-mode=importlib", "-m", "not slow"]
markers = ["slow: not run here"]

[tool.mutmut]
source_paths = ["src"]
only_mutate = {modules}
pytest_add_cli_args_test_selection = {tests}
pytest_add_cli_args = [
  "--assert=plain", "-p", "no:cacheprovider", "-p", "no:unraisableexception",
  "-p", "hypothesispytest", "-p", "mutation_plugin",
]
# Every mutant imports its modules anew: what runs when they are imported is mutated too.
process_isolation = "forkserver"
forkserver_warmup = "import"
preload_modules_file = "preload.txt"
timeout_constant = 8.0 # two minutes at least: a busy machine kills no mutant
track_dependencies = false
use_git_change_detection = false
"""
PRELOAD = ("hypothesis", "mutation_plugin", "msgspec", "mujoco", "numpy", "pytest", "rich", "zenoh")


def main() -> None:
    """Make the mutants, run the tests, and print which mutants survived."""
    parser = argparse.ArgumentParser(prog="python -m tests.campaigns.mutation", description=__doc__)
    parser.add_argument("names", nargs="*", help="areas or modules (rules, referee.py); else all")
    parser.add_argument("--jobs", type=int, default=1, help="mutants tested at the same time")
    parser.add_argument("--keep", type=Path, default=ROOT / "build/mutants", help="where to work")
    options = parser.parse_args()
    chosen = [area for area in (_chosen(area, options.names) for area in AREAS) if area.modules]
    if not chosen:
        parser.error(f"nothing is called {' or '.join(options.names)}")
    for area in chosen:
        _run(area, options.keep / area.name, options.jobs)
    _print({area.name: _outcomes(area, options.keep / area.name) for area in chosen})


def _chosen(area: Area, names: list[str]) -> Area:
    if not names or area.name in names:
        return area
    modules = (module for module in area.modules if any(name in module for name in names))
    return Area(area.name, tuple(modules), area.tests)


def _run(area: Area, folder: Path, jobs: int) -> None:
    shutil.rmtree(folder, ignore_errors=True)
    skip = shutil.ignore_patterns("__pycache__", "pages")
    for package in (next((ROOT / room).glob("lacoc_*")) for room in ROOMS):
        shutil.copytree(package, folder / "src" / package.name, ignore=skip)
    shutil.copytree(ROOT / "tests", folder / "tests", ignore=skip)
    modules = [f"src/{module}" for module in area.modules]
    settings = SETTINGS.format(modules=json.dumps(modules), tests=json.dumps(area.tests))
    (folder / "pyproject.toml").write_text(settings, encoding="utf-8")
    (folder / "preload.txt").write_text("\n".join(PRELOAD), encoding="utf-8")
    mutmut = Path(sys.executable).with_name("mutmut")
    extra = {
        "PYTHONPATH": str(Path(__file__).parent),
        "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1",
        "PYTHONDONTWRITEBYTECODE": "",  # compiled files save time
    }
    subprocess.run(
        [mutmut, "run", "--max-children", str(jobs)], cwd=folder, env=os.environ | extra, check=True
    )


def _outcomes(area: Area, folder: Path) -> dict[str, dict[str, str]]:
    """Return, for each module, a dict from the names of its mutants to their outcomes."""
    return {
        module: {
            mutant: status_by_exit_code[code]
            for mutant, code in json.loads(
                (folder / "mutants/src" / f"{module}.meta").read_text(encoding="utf-8")
            )["exit_code_by_key"].items()
        }
        for module in area.modules
    }


def _print(areas: dict[str, dict[str, dict[str, str]]]) -> None:
    table = Table("module", *(["mutants", "killed", "survived", "share"]))
    for name, modules in areas.items():
        total: Counter[str] = Counter()
        for module, mutants in modules.items():
            counts = Counter(mutants.values())
            total += counts
            table.add_row(module, *_figures(counts))
        table.add_row(f"[bold]{name}", *_figures(total), end_section=True)
    for modules in areas.values():
        for mutants in modules.values():
            for mutant, outcome in mutants.items():
                if outcome not in CAUGHT:
                    print(f"{outcome}: {mutant}")
    Console().print(table)


def _figures(counts: Counter[str]) -> tuple[str, ...]:
    all_, killed = counts.total(), sum(counts[name] for name in CAUGHT)
    share = f"{killed / all_:.1%}" if all_ else ""
    return str(all_), str(killed), str(all_ - killed), share


if __name__ == "__main__":
    main()
