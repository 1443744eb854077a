"""Makes the helper modules of these tests and `benchmarks` importable, and gives fixtures."""

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
    """Make the log take lines of level INFO during the test, as a running court does."""
    before = structlog.get_config()
    structlog.configure(wrapper_class=structlog.make_filtering_bound_logger(logging.INFO))
    yield
    structlog.configure(**before)


@pytest.fixture(scope="session")
def has_other_arithmetic() -> None:
    """Skip the test if this machine has no second arithmetic (glibc for older processors)."""
    there = json.loads(elsewhere("benchmarks.proof", ["fingerprint"]))
    if arithmetic.same(arithmetic.here(), there):
        pytest.skip("the second arithmetic of this machine is the first")
