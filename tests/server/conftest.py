"""Makes `stage`, the builders that the tests of the court share, importable; and the log."""

import logging
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
import structlog

sys.path.append(str(Path(__file__).parent))


@pytest.fixture
def loud() -> Iterator[None]:
    """The log, as `start` switches it on."""
    before = structlog.get_config()
    structlog.configure(wrapper_class=structlog.make_filtering_bound_logger(logging.INFO))
    yield
    structlog.configure(**before)
