"""Five minutes of matches with visitors that come and go; `make soak` runs an hour."""

import sys

import pytest

from tests.campaigns.long.soak import MOST_GROWTH, VISITORS, Figures, Look, soak

MINUTES = 5.0
WARM_MINUTES = 2.0
MOST_GROWTH_HERE = 0.03
"""Largest share by which memory may grow in three minutes. Heaps grow by up to 0.017 in this time;
a leak of 0.1 MB in each match gives more than this limit.
"""


@pytest.mark.long(minutes=6)
@pytest.mark.skipif(sys.platform != "linux", reason="the kernel's own counts are read")
def test_nothing_grows_and_nothing_is_left_over() -> None:
    """No process gains threads, files, sockets or children after the warm-up; all records verify.

    Except in visitors, the memory of each process grows by less than 3 %.
    """
    figures = soak(MINUTES, match_s=10.0, speed=2.0, warm_minutes=WARM_MINUTES, visitors_most=5)
    assert figures.same == figures.matches > 0
    assert figures.frames > 0
    assert {name: figures.left_over(name) for name in figures.looks} == {
        name: {} for name in figures.looks
    }
    grown = {name: figures.growth(name) for name in figures.looks if not name.startswith(VISITORS)}
    assert all(growth < MOST_GROWTH_HERE for growth in grown.values()), grown


def _figures(looks: list[Look]) -> Figures:
    return Figures(
        minutes=1,
        matches=1,
        visits=1,
        frames=1,
        unanswered=0,
        same=1,
        looks={"it": looks},
        warm_s=5,
    )


def test_a_leak_would_be_seen() -> None:
    """Memory that grows by 0.5 % at each measurement is a leak; one high measurement is not."""
    steady = [Look(at_s, 100_000_000, 9, 20, 3, 0) for at_s in range(20)]
    growing = [look._replace(memory_bytes=round(1e8 * 1.005**look.at_s)) for look in steady]
    off = [*steady[:9], steady[9]._replace(memory_bytes=150_000_000), *steady[10:]]
    assert _figures(growing).growth("it") > MOST_GROWTH
    assert not _figures(growing).held
    assert _figures(off).growth("it") == 0
    assert _figures(off).held


@pytest.mark.parametrize("what", ["threads", "files", "sockets", "children"])
def test_what_is_left_over_would_be_seen(what: str) -> None:
    """`left_over` finds one thread, file, socket or child process more than during the warm-up."""
    steady = [Look(at_s, 100_000_000, 9, 20, 3, 0) for at_s in range(20)]
    last = steady[-1]._replace(**{what: getattr(steady[-1], what) + 1})
    figures = _figures([*steady[:-1], last])
    assert figures.left_over("it") == {what: 1}
    assert not figures.held
