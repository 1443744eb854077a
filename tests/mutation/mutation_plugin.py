"""A pytest plugin for mutmut: fair to what is imported, and quick.

mutmut notes which functions each test calls, to run for a mutant only the tests that reach it.
What a test module calls while it is imported would count for the first test alone; here it
counts for every test of that module.
"""

import functools
import importlib.metadata
import sys
from collections.abc import Generator

import hypothesis
import pytest
from mutmut.state import state

_entry_points = importlib.metadata.entry_points


@functools.cache
def _entries(group: str, path: tuple[str, ...]) -> importlib.metadata.EntryPoints:
    return _entry_points(group=group)


# Most of what a test of a match takes is reading who is installed.
importlib.metadata.entry_points = lambda group: _entries(group, tuple(sys.path))

_CALLED = pytest.StashKey[frozenset[str]]()


def pytest_configure(config: pytest.Config) -> None:
    """Let an example that fails do: no shrinking, no memory, and the same examples each time."""
    phases = (hypothesis.Phase.explicit, hypothesis.Phase.generate)
    hypothesis.settings.register_profile(
        "mutants", deadline=None, database=None, derandomize=True, phases=phases
    )
    hypothesis.settings.load_profile("mutants")


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(
    collector: pytest.Collector,
) -> Generator[None, pytest.CollectReport, pytest.CollectReport]:
    """Note what a test module calls while it is imported."""
    state()._stats.clear()
    report = yield
    collector.stash[_CALLED] = frozenset(state()._stats)
    return report


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """The quick tests first: most mutants fall before the long ones."""
    items.sort(key=lambda item: state().duration_by_test.get(item.nodeid, 0.0))


def pytest_runtest_setup(item: pytest.Item) -> None:
    """Count it for each of the module's tests."""
    for collector in item.listchain()[:-1]:
        state()._stats.update(collector.stash.get(_CALLED, ()))
