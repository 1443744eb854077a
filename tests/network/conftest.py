"""Gives tests a stub of a court, and network sessions that are connected to it."""

from collections.abc import Iterator

import pytest
from court_stub import CourtStub

from lacoc_shared.network.session import Session, open_client


@pytest.fixture
def court() -> Iterator[CourtStub]:
    with CourtStub() as stub:
        yield stub


@pytest.fixture
def session(court: CourtStub) -> Iterator[Session]:
    with open_client([court.address]) as session:
        yield session


@pytest.fixture
def other_session(court: CourtStub) -> Iterator[Session]:
    with open_client([court.address]) as session:
        yield session
