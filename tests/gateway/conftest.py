"""Gives venues to the tests of the gateway."""

from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from venue import Venue


@pytest.fixture
def venue(tmp_path: Path) -> Iterator[Venue]:
    """Give a contest whose court and gateway do not run yet."""
    with ExitStack() as stack:
        yield Venue(tmp_path, stack)


@pytest.fixture(scope="module")
def open_venue(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Venue]:
    """Give a court in the lobby and its gateway, shared by tests that change nothing."""
    with ExitStack() as stack:
        venue = Venue(tmp_path_factory.mktemp("venue"), stack)
        venue.court()
        venue.web("--pages", "https://Pages.Example")
        yield venue
