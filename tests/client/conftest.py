"""Courts for the tests of commands; makes `court_process` importable."""

import sys
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

sys.path.append(str(Path(__file__).parent))

from court_process import CourtProcess, OpenCourt


@pytest.fixture
def open_court(tmp_path: Path) -> Iterator[OpenCourt]:
    """Opens courts: `open_court("--arena", "othello", "--seconds", "6")`."""
    with ExitStack() as stack:

        def opened(*words: str) -> CourtProcess:
            court = CourtProcess(tmp_path, *words)
            stack.callback(court.close)
            return court

        yield opened
