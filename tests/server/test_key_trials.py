"""Tests of what keys do: each key of a seated robot is tried beside the beats of its court."""

import time
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import replace

import pytest
from every_third import every_third
from sample_walks import ROBOTS
from stage import entry, join

from lacoc_server.court.key_trials import KeyTrials
from lacoc_server.match.seat import Seat
from lacoc_server.trial.figures import Figures
from lacoc_server.trial.moves import move_of
from lacoc_shared.words.table import table


def seat(robot: str) -> Seat:
    """Return a seat that is taken with a sample robot."""
    return Seat(0, "left", "#0072b2", "plain", join=join(0, robot=robot), entry=entry(robot))


@pytest.mark.slow
@pytest.mark.parametrize("robot", every_third(ROBOTS))
def test_keys_of_the_samples(robot: str) -> None:
    """Every sample robot stands, turns left, goes forward and turns right, as its gait means."""
    with ThreadPoolExecutor(1) as aside:
        trials = KeyTrials(aside.submit)
        until_s = time.monotonic() + 60
        while len(found := trials(seat(robot), True)) < 4:
            assert time.monotonic() < until_s
            time.sleep(0.01)
    assert found == ("stand", "turn-left", "forward", "turn-right")


def test_while_two_robots_play_nothing_is_tried() -> None:
    """Between matches one key after another is tried, in play none; what is known stays known."""
    asked: list[Future[str]] = []

    def aside(_: Callable[[], str]) -> Future[str]:
        asked.append(Future())
        return asked[-1]

    trials, hexapod = KeyTrials(aside), seat("hexapod")
    assert trials(hexapod, False) == ()
    assert not asked
    assert trials(hexapod, True) == ()
    assert trials(hexapod, True) == ()
    assert len(asked) == 1
    asked[0].set_result("stand")
    assert trials(hexapod, False) == ("stand",)
    assert len(asked) == 1
    assert trials(hexapod, True) == ("stand",)
    assert len(asked) == 2
    assert trials(Seat(1, "right", "#e69f00", "stripes"), True) == ()


def test_a_trial_that_fails_gives_no_name(monkeypatch: pytest.MonkeyPatch) -> None:
    """An error in a trial costs the key its name, and nothing else."""

    def broken(*_: object) -> None:
        raise ArithmeticError

    monkeypatch.setattr("lacoc_server.court.key_trials.make_course", broken)
    with ThreadPoolExecutor(1) as aside:
        trials = KeyTrials(aside.submit)
        trials(seat("hexapod"), True)
    assert trials(seat("hexapod"), False) == ("",)


STANDS = Figures(
    seconds=1.0,
    cycles=1,
    cycle_s=1.0,
    speed_mm_s=0.0,
    lateral_mm_s=0.0,
    drift_deg_s=0.0,
    drift_deg_m=None,
    straightness=None,
    duty=[],
    phase=[],
    changes_hz=[],
    few_feet_share=0.0,
    margin_mm=None,
    margin_low_mm=None,
    stable_share=1.0,
    slip_mm_s=0.0,
    slip_legs_mm_s=[],
    slip_ratio=None,
    cost_of_transport=None,
    clearance_mm=0.0,
    clearance_legs_mm=[],
    belly_share=0.0,
    upright=1.0,
)


@pytest.mark.parametrize(
    ("forward", "left", "turn", "upright", "move"),
    [
        (0, 0, 0, 1, "stand"),
        (60, 7, 0, 1, "forward"),
        (-60, 7, 5, 1, "back"),
        (7, 60, 0, 1, "left"),
        (7, -60, 0, 1, "right"),
        (-3, 0, 21, 1, "turn-left"),
        (-7, 0, -22, 1, "turn-right"),
        (60, 0, 0, 0.3, "tip-over"),
    ],
)
def test_a_walk_has_one_word(
    forward: float, left: float, turn: float, upright: float, move: str
) -> None:
    """A key is named by what the robot mostly does with it."""
    figures = replace(
        STANDS, speed_mm_s=forward, lateral_mm_s=left, drift_deg_s=turn, upright=upright
    )
    assert move_of(figures) == move
    assert f"move.{move}" in table()
