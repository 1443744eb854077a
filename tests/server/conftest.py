"""Put `stage` (the builders of the court's tests) on the import path, and give fixtures."""

import json
import logging
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
import structlog

sys.path.append(str(Path(__file__).parent))
sys.path.append(str(Path(__file__).parents[2]))
from benchmarks.played import elsewhere

from lacoc_server.world import arithmetic


@pytest.fixture
def loud() -> Iterator[None]:
    """Set the level of the log to INFO, as `start` does."""
    before = structlog.get_config()
    structlog.configure(wrapper_class=structlog.make_filtering_bound_logger(logging.INFO))
    yield
    structlog.configure(**before)


@pytest.fixture(scope="session")
def has_other_arithmetic() -> None:
    """Skip the test if a second process can't be given another arithmetic on this machine."""
    there = json.loads(elsewhere("benchmarks.proof", ["fingerprint"]))
    if arithmetic.same(arithmetic.here(), there):
        pytest.skip("the second arithmetic of this machine is the first")
