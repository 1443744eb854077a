"""The files of the repository are as CONTRIBUTING.md and docs/architecture.md describe them."""

import re
import socket
import subprocess
import tomllib
from pathlib import Path

import pytest
from benchmarks import measured

import lacoc_shared

ROOT = Path(__file__).parents[2]
PACKAGES = sorted(path.parent for path in ROOT.glob("*/lacoc_*/__init__.py"))
ARENAS = sorted(path.parent for path in ROOT.glob("arenas/lacoc_arenas/*/arena.toml"))
ROBOTS = sorted(path.parent for path in ROOT.glob("robots/lacoc_robots/samples/*/robot.toml"))

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def tracked() -> list[Path]:
    """Return all files that git tracks."""
    listed = subprocess.run(
        ["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=False
    )
    if listed.returncode:
        pytest.skip("not a git checkout")
    return [ROOT / name for name in listed.stdout.split("\0") if name and (ROOT / name).is_file()]


def test_the_version_is_said_once() -> None:
    """pyproject.toml and lacoc_shared have the same version."""
    assert PROJECT["version"] == lacoc_shared.__version__


@pytest.mark.parametrize("package", PACKAGES, ids=lambda path: path.name)
def test_a_package_is_typed(package: Path) -> None:
    """Each package has an empty py.typed file, so that type checkers use its types."""
    assert (package / "py.typed").read_bytes() == b""


def test_there_are_five_rooms() -> None:
    """The repository has the five packages of docs/architecture.md."""
    names = [package.name for package in PACKAGES]
    rooms = ["arenas", "client", "robots", "server", "shared"]
    assert sorted(names) == [f"lacoc_{room}" for room in rooms]


@pytest.mark.parametrize("arena", ARENAS, ids=lambda path: path.name)
def test_an_arena_is_complete_and_installed(arena: Path) -> None:
    """An arena's folder has its settings, rules, field and bots, and is an entry point."""
    files = {path.name for path in arena.iterdir()}
    assert {"__init__.py", "arena.toml", "rules.py", "field.py", "bots.py"} <= files
    assert f"lacoc_arenas.{arena.name}" in PROJECT["entry-points"]["lacoc.arenas"].values()


@pytest.mark.parametrize("robot", ROBOTS, ids=lambda path: path.name)
def test_a_sample_robot_is_complete_and_installed(robot: Path) -> None:
    """A sample robot's folder has the robot and a gait for each level, and is an entry point."""
    files = {path.name for path in robot.iterdir()}
    assert {"__init__.py", "robot.toml", "Loco-data.txt", "LocoTra-data.txt"} <= files
    assert f"lacoc_robots.samples.{robot.name}" in PROJECT["entry-points"]["lacoc.robots"].values()


def test_every_entry_point_is_there() -> None:
    """Every entry point names a module that exists."""
    entries = [
        entry.partition(":")[0]
        for group in PROJECT["entry-points"].values()
        for entry in group.values()
    ]
    missing = [
        entry
        for entry in entries
        if not any(
            (ROOT / room / Path(*entry.split("."))).with_suffix(".py").is_file()
            or (ROOT / room / Path(*entry.split("."))).is_dir()
            for room in ("shared", "robots", "arenas", "server", "client")
        )
    ]
    assert missing == []


def test_nothing_of_the_machine_it_was_made_on_is_in_it() -> None:
    """No tracked text has the path of this checkout or home folder, or this machine's name."""
    host = socket.gethostname()
    own = [re.escape(f"{path}/") for path in (ROOT, Path.home()) if len(path.parts) > 1]
    if len(host) > 3 and host != "localhost":  # a very short name would match ordinary text
        own.append(rf"\b{re.escape(host)}\b")
    pattern = re.compile("|".join(own).encode())
    found = [
        f"{path.relative_to(ROOT)}: {hit.decode()}"
        for path in tracked()
        if b"\0" not in (data := path.read_bytes())
        for hit in pattern.findall(data)
    ]
    assert found == []


def test_no_library_is_copied_in() -> None:
    """The repository contains no copied libraries, binaries or bundles."""
    folders = {"vendor", "third_party", "node_modules", "site-packages", "_vendor"}
    suffixes = {".whl", ".so", ".dll", ".dylib", ".jar", ".exe", ".egg"}
    found = [
        path.relative_to(ROOT)
        for path in tracked()
        if folders & set(path.parts) or path.suffix in suffixes or path.name.endswith(".min.js")
    ]
    assert found == []


def test_the_page_of_figures_is_made_from_the_data() -> None:
    """docs/measured.md is what `python -m benchmarks.measured` writes."""
    assert measured.PAGE.read_text(encoding="utf-8") == measured.page()


def test_links_in_the_documents_lead_somewhere() -> None:
    """Every Markdown link to a file or folder of the project leads to one that exists."""
    link = re.compile(r"\]\((?!https?://|mailto:|#)([^)#\s]+)")
    broken = [
        f"{path.relative_to(ROOT)}: {target}"
        for path in tracked()
        if path.suffix == ".md"
        for target in link.findall(path.read_text(encoding="utf-8"))
        if not (path.parent / target).exists()
    ]
    assert broken == []
