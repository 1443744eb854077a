"""Tests of a court's pace: when beats are due, how it catches up, and which beats are slow."""

import pytest

from lacoc_server.court.pace import CATCH_UP_BEATS, Pace


def test_a_beat_every_20_ms_of_the_clock() -> None:
    """Beats are due 20 ms apart, and a beat that begins late does not shift the next ones."""
    pace = Pace(100.0)
    for beat in range(50):
        now_s = 100.0 + 0.02 * beat
        assert pace.wait_s(now_s - 0.005) == pytest.approx(0.005)
        assert pace.wait_s(now_s + 0.001) == 0.0
        pace.begin(now_s + 0.003)
    assert pace.slow_beats == 0
    assert pace.worst_late_s == pytest.approx(0.003)


def test_speed() -> None:
    """At speed 2, two beats pass in 20 ms."""
    pace = Pace(0.0, speed=2.0)
    for _ in range(10):
        pace.begin(pace._due_s)
    assert pace.wait_s(0.0) == pytest.approx(0.1)
    assert pace.real_time_factor == pytest.approx(1.0)


def test_offset_shifts_the_phase_by_less_than_a_beat() -> None:
    """Modulo 20 ms, every beat comes at the offset, whenever the court was started."""
    for now_s in (0.0, 7.0, 7.011):
        phases = [
            (now_s + Pace(now_s, offset_s=offset_s).wait_s(now_s)) % 0.02
            for offset_s in (0.001, 0.013, 0.055)
        ]
        assert phases == pytest.approx([0.001, 0.013, 0.015])


def test_after_a_stall_at_most_five_beats_come_without_a_pause() -> None:
    """After a stall, five beats come without a pause; beats beyond these are not made up."""
    pace = Pace(0.0)
    pace.begin(0.0)
    now_s = 1.0  # stalled: 49 beats are overdue
    pace.begin(now_s)
    without_pause = 0
    while pace.wait_s(now_s) == 0.0:
        pace.begin(now_s)
        without_pause += 1
    assert without_pause == CATCH_UP_BEATS == 5
    assert pace.wait_s(now_s) == pytest.approx(0.02)


def test_slow_beats() -> None:
    """A beat is slow if it starts more than 20 ms late."""
    pace = Pace(0.0)
    pace.begin(0.019)
    assert pace.slow_beats == 0
    pace.begin(0.02 + 0.021)
    assert pace.slow_beats == 1
    assert pace.worst_late_s == pytest.approx(0.021)


def test_real_time_factor() -> None:
    """The real-time factor is measured over the last 250 beats, so an old delay is forgotten."""
    pace = Pace(0.0)
    assert pace.real_time_factor == 1.0
    for beat in range(300):
        pace.begin(0.04 * beat)
    assert pace.real_time_factor == pytest.approx(0.5)
    start_s = 0.04 * 299
    for beat in range(1, 300):
        pace.begin(start_s + 0.02 * beat)
    assert pace.real_time_factor == pytest.approx(1.0)
