"""Commands that are killed leave nothing in the folder for temporary files for long."""

import os

import pytest
from benchmarks.leftovers import killed


@pytest.mark.long(minutes=2)
@pytest.mark.skipif(os.name != "posix", reason="kill -9")
def test_what_killed_commands_leave_is_removed() -> None:
    """After kill -9 at random moments, the next start removes what was left."""
    found, left = killed(16)
    assert found > 0
    assert not left
