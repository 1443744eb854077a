"""Each class has a name of its own: who searches for a name finds one thing."""

import ast
from collections import defaultdict
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[2]
PACKAGES = sorted(path.parent for path in ROOT.glob("*/lacoc*/__init__.py"))

EXCEPTIONS = {
    "Settings": "the settings of a game; a game is a plug-in, and its folder says which",
    "State": "the state of a game, as for its settings",
}
"""Names that more than one class may have, with the reason."""


@cache
def classes() -> dict[str, list[str]]:
    """Return where each name of a class is defined: files and lines, relative to the repository.

    A leading underscore is left out: `_Frame` beside `Frame` would be a second meaning too.
    """
    found = defaultdict(list)
    for package in PACKAGES:
        for path in sorted(package.rglob("*.py")):
            if "pages" in path.relative_to(package).parts[:1]:
                continue  # they are built
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                if isinstance(node, ast.ClassDef):
                    place = f"{path.relative_to(ROOT)}:{node.lineno}"
                    found[node.name.lstrip("_")].append(place)
    return found


def test_each_class_has_a_name_of_its_own() -> None:
    """No two classes of the product have the same name, except those that say why."""
    found = classes()

    assert len(found) > 500  # the packages were found
    assert {
        name: places for name, places in found.items() if len(places) > 1 and name not in EXCEPTIONS
    } == {}


def test_each_exception_is_needed_and_stays_with_the_games() -> None:
    """An exception is for classes of games; there are at least two of them, each in its folder."""
    found = classes()
    for name in EXCEPTIONS:
        folders = [Path(place).parent for place in found[name]]
        assert len({*folders}) == len(folders) > 1
        assert all((ROOT / folder / "arena.toml").is_file() for folder in folders)
