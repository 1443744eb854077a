"""What holds for all tests: which ones run, and how many examples a property meets."""

import os

import pytest
from hypothesis import settings

# How long an example takes says more about the machine than about the code.
settings.register_profile("quick", deadline=None, max_examples=40)
settings.register_profile("thorough", deadline=None, max_examples=400)

# Also a developer whose machine speaks Japanese runs the commands of these tests in English.
os.environ["LACOC_LANGUAGE"] = "en"


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the option that `make test-all` gives in its second run."""
    parser.addoption(
        "--long",
        action="store_true",
        help="run what a usual run leaves out: tests marked long, and properties of ten times as "
        "many examples",
    )


def pytest_configure(config: pytest.Config) -> None:
    """Choose how many examples a property meets."""
    settings.load_profile("thorough" if config.getoption("long") else "quick")


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Choose the tests of this run; the longest begin, so that no worker ends up alone with one."""
    wanted, others = [], []
    for item in items:
        long = item.get_closest_marker("long") is not None
        again = config.getoption("long") and item.get_closest_marker("hypothesis") is not None
        (wanted if long is config.getoption("long") or again else others).append(item)
    config.hook.pytest_deselected(items=others)
    items[:] = sorted(wanted, key=lambda item: "soak" not in item.path.parts)
