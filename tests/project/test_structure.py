"""Imports form no circle, and the server and shared packages have few parts at their top level."""

from graphlib import TopologicalSorter
from pathlib import Path

import grimp
import pytest

ROOT = Path(__file__).parents[2]
PACKAGES = ("lacoc_shared", "lacoc_robots", "lacoc_arenas", "lacoc_server", "lacoc_client")


@pytest.fixture(scope="module")
def imports() -> grimp.ImportGraph:
    """Give the graph of imports between modules, including imports for types only."""
    return grimp.build_graph(*PACKAGES, exclude_type_checking_imports=False, cache_dir=None)


def test_no_imports_form_a_circle(imports: grimp.ImportGraph) -> None:
    """No imports form a circle, so each file can be understood after the files it imports."""
    before = {name: imports.find_modules_directly_imported_by(name) for name in imports.modules}

    TopologicalSorter(before).prepare()  # raises CycleError with the files of a circle


@pytest.mark.parametrize(("package", "most"), [("lacoc_server", 10), ("lacoc_shared", 16)])
def test_a_newcomer_sees_few_rooms(imports: grimp.ImportGraph, package: str, most: int) -> None:
    """The server and shared packages have few modules and folders at their top level."""
    assert len(imports.find_children(package)) <= most
