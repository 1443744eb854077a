"""Gives fixtures to the tests of courts."""

import logging
from collections.abc import Iterator

import pytest
import structlog
from other_arithmetic import elsewhere
from verdicts import fingerprint

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
    there = elsewhere(fingerprint)
    if arithmetic.same(arithmetic.here(), there):
        pytest.skip("the second arithmetic of this machine is the first")
