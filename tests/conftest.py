"""What holds for all tests."""

import os

import pytest
from hypothesis import settings

# How long an example takes says more about the machine than about the code.
settings.register_profile("lacoc", deadline=None)
settings.load_profile("lacoc")

# Also a developer whose machine speaks Japanese runs the commands of these tests in English.
os.environ["LACOC_LANGUAGE"] = "en"


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Workers who share the tests begin with the longest, so that none ends up alone with it."""
    if hasattr(config, "workerinput"):
        items.sort(key=lambda item: "soak" not in item.path.parts)
