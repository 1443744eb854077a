"""Two pages at one gateway answer the same frames; one of them is far away."""

from pathlib import Path

import pytest
from mirrored_pair import play_on_pages, trips

LINKS_S = ((0.01, 0.0), (0.1, 0.025))
"""Delay and jitter of the near and of the far page's link, one way [s]."""


@pytest.mark.long
@pytest.mark.parametrize("arena", ["othello", "flag-strike"])
def test_equal_links_include_the_way_to_the_page(tmp_path: Path, arena: str) -> None:
    """With equal links, keys of a near and of a far page that answer one frame act in one beat."""
    played = play_on_pages(tmp_path, arena, "equal", LINKS_S, warm_s=6, seconds=10)
    pairs, delay_ms = played.pairs, played.health.input_delay_ms
    assert len(pairs) > 10
    assert 200 <= delay_ms <= 400
    same = [pair for pair in pairs if pair.beats[0] == pair.beats[1]]
    assert len(same) > 0.5 * len(pairs)  # on a busy machine some are late, and are called so
    assert all(any(pair.late) for pair in pairs if pair not in same)


@pytest.mark.slow
@pytest.mark.long
def test_the_difference_is_measured_where_links_are_not_equal(tmp_path: Path) -> None:
    """Without equal links the far page's key is later, and everybody reads by how much."""
    played = play_on_pages(tmp_path, "othello", "none", LINKS_S, warm_s=6, seconds=6)
    near, far = trips(played.health)
    assert near.p50_ms < 200 <= far.p50_ms
    assert played.shown[1].p50_ms >= 200
    assert played.pairs
    assert all(pair.beats[0] < pair.beats[1] for pair in played.pairs)
