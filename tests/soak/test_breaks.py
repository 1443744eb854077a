"""A short run of `benchmarks.breaks`: a match on the internet goes on through what breaks."""

from pathlib import Path

import pytest
from benchmarks.breaks import played_through


@pytest.mark.long(minutes=1)
@pytest.mark.slow
def test_a_match_goes_on_through_what_breaks(tmp_path: Path) -> None:
    """Proxy, certificate, connections and gateway break once each; the record verifies."""
    found = played_through(tmp_path, 1)
    assert set(found) == {"renew", "cut", "restart", "kill"}
