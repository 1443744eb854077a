"""A pytest plugin that lets mutmut count calls at import correctly, and makes its runs quick.

mutmut notes which functions each test calls, so that a mutant runs only the tests that reach it.
Functions that a test module calls at import would count for its first test only. This plugin counts
them for every test of that module.
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


# Reading the installed packages takes most of the time of a match's test, so keep the result.
importlib.metadata.entry_points = lambda group: _entries(group, tuple(sys.path))

_CALLED = pytest.StashKey[frozenset[str]]()


def pytest_configure(config: pytest.Config) -> None:
    """Make Hypothesis use the same examples each time, and not shrink or store failing ones."""
    phases = (hypothesis.Phase.explicit, hypothesis.Phase.generate)
    hypothesis.settings.register_profile(
        "mutants", deadline=None, database=None, derandomize=True, phases=phases
    )
    hypothesis.settings.load_profile("mutants")


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(
    collector: pytest.Collector,
) -> Generator[None, pytest.CollectReport, pytest.CollectReport]:
    """Note which functions a test module calls while it is imported."""
    state()._stats.clear()
    report = yield
    collector.stash[_CALLED] = frozenset(state()._stats)
    return report


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Put the quick tests first, since most mutants fail one of them."""
    items.sort(key=lambda item: state().duration_by_test.get(item.nodeid, 0.0))


def pytest_runtest_setup(item: pytest.Item) -> None:
    """Count the functions that a module called at import as called by each of its tests."""
    for collector in item.listchain()[:-1]:
        state()._stats.update(collector.stash.get(_CALLED, ()))
