"""An allowance limits the size of a burst and the rate in the long run."""

from hypothesis import given
from hypothesis import strategies as st

from lacoc_shared.network.allowance import Allowance


def test_all_or_none() -> None:
    """What may not pass whole takes nothing from what is left."""
    allowance = Allowance(10, 5)
    assert allowance.take_all(4, 1.0)
    assert not allowance.take_all(2, 1.0)
    assert allowance.take_all(1, 1.0)
    assert not allowance.take_all(1, 1.0)
    assert allowance.take_all(5, 1.5)


def test_a_burst_then_the_rate() -> None:
    """A burst passes at once, then messages at the rate. A long pause saves up only one burst."""
    allowance = Allowance(2.0, 5)
    assert allowance.take(7, 1000.0) == 5
    assert allowance.take(1, 1000.4) == 0
    assert allowance.take(1, 1000.5) == 1
    assert allowance.take(9, 1001.6) == 2
    assert allowance.left(2000.0) == 5


@given(
    st.floats(0.1, 100),
    st.integers(1, 20),
    st.lists(st.tuples(st.floats(0, 1), st.integers(0, 30)), max_size=50),
)
def test_never_more_than_promised(
    rate_hz: float, burst: int, asked: list[tuple[float, int]]
) -> None:
    """In total, at most the burst plus the rate times the elapsed time passes."""
    allowance, now_s, passed = Allowance(rate_hz, burst), 50.0, 0
    for wait_s, wanted in asked:
        now_s += wait_s
        got = allowance.take(wanted, now_s)
        assert 0 <= got <= wanted
        passed += got
        assert passed <= burst + (now_s - 50.0) * rate_hz + 1e-6
