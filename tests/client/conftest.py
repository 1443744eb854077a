"""Gives courts to the tests of commands."""

from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from court_process import CourtProcess, OpenCourt


@pytest.fixture
def open_court(tmp_path: Path) -> Iterator[OpenCourt]:
    """Give a function that opens a court: `open_court("--arena", "othello", "--seconds", "6")`."""
    with ExitStack() as stack:

        def opened(*words: str) -> CourtProcess:
            court = CourtProcess(tmp_path, *words)
            stack.callback(court.close)
            return court

        yield opened
