"""Two controllers answer the same frames at a real court; one of them has a slow link."""

from pathlib import Path

import pytest
from mirrored_pair import play
from verdicts import verdict

from lacoc_server.journal.verdict import VerdictKind

FAR = (0.1, 0.025)
"""Delay and jitter of the slow link, one way [s]: 200 ± 50 ms there and back."""


@pytest.mark.long
def test_equal_links_let_both_keys_take_effect_in_the_same_beat(tmp_path: Path) -> None:
    """With equal links, keys that answer one frame take effect in one beat, unless one is late."""
    played = play(tmp_path, "equal", *FAR, warm_s=6, seconds=10)
    fast, slow = played.health.seats
    assert fast.round_trip_p50_ms is not None
    assert slow.round_trip_p50_ms is not None
    assert fast.round_trip_p50_ms < 200 <= slow.round_trip_p50_ms
    assert 200 <= played.health.input_delay_ms <= 400
    pairs = played.pairs
    assert len(pairs) > 10
    same = [pair for pair in pairs if pair.beats[0] == pair.beats[1]]
    assert len(same) > 0.5 * len(pairs)
    assert all(any(pair.late) for pair in pairs if pair not in same)
    assert sum(map(any, (pair.late for pair in pairs))) <= fast.late + slow.late
    assert verdict(played.record).kind is VerdictKind.SAME


@pytest.mark.slow
@pytest.mark.long
def test_without_the_setting_the_near_one_is_first(tmp_path: Path) -> None:
    """With `input_delay = "none"` no key is held, so the fast link's key takes effect first."""
    played = play(tmp_path, "none", *FAR, warm_s=3, seconds=4)
    fast, slow = played.health.seats
    assert played.health.input_delay_ms == 0
    assert slow.round_trip_p50_ms is not None
    assert slow.round_trip_p50_ms >= 200
    assert played.pairs
    assert all(pair.beats[0] < pair.beats[1] and pair.late == (0, 0) for pair in played.pairs)
    assert (fast.late, slow.late) == (0, 0)
