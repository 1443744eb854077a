"""Tests of how fast the workshop's gait walks and turns, measured in matches of practice."""

import math
from functools import cache
from itertools import cycle
from typing import NamedTuple

import numpy as np
import pytest
from stage import FORWARD, A, B, Stage, join, key

from lacoc_robots.library import find_robot
from lacoc_shared.inputs import JoinSeat

pytestmark = pytest.mark.slow

SETTLE_TICKS = 50
RUN_S = 24.0


class Walk(NamedTuple):
    """The measured speeds of a walk."""

    forward_mm_s: float
    turn_deg_s: float
    """Positive: the robot turns to the left."""
    upright: float
    """Smallest z component of the body's upward unit vector; 1 is upright."""


def practice(heading_deg: float, joins: JoinSeat | None = None) -> Stage:
    field = {"game": {"size_m": [8.0, 8.0], "heading_deg": heading_deg}}
    stage = Stage.real("practice", field).to_playing(joins or join(0))
    stage.run(SETTLE_TICKS)
    return stage


def measure(stage: Stage, frames: list[np.ndarray]) -> Walk:
    """Return the speeds of a walk; `frames` has the body's pose in each tick."""
    poses = np.array(frames, dtype=float)
    w, x, y, z = poses[:, 3:7].T
    yaw = np.unwrap(np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)))
    seconds = (len(poses) - 1) * 0.02
    gone = poses[-1, :2] - poses[0, :2]
    ahead = np.array([-math.sin(yaw[0]), math.cos(yaw[0])])  # the body's +y
    return Walk(
        1000 * float(gone @ ahead) / seconds,
        math.degrees(yaw[-1] - yaw[0]) / seconds,
        float((1 - 2 * (x * x + y * y)).min()),
    )


def pose(stage: Stage) -> np.ndarray:
    return np.frombuffer(stage.frame.poses, "<f4")[:7]


@cache
def by_hand(digits: tuple[int, ...], heading_deg: float = 90.0) -> Walk:
    """Press these keys of level A in turn, one every 0.5 s for 24 s, and return the speeds."""
    stage = practice(heading_deg)
    frames = [pose(stage)]
    for number, digit in zip(range(int(RUN_S / 0.5)), cycle(digits)):
        stage.beat(key(0, digit, seq=number + 1, level=A))
        frames.append(pose(stage))
        for _ in range(24):
            stage.beat()
            frames.append(pose(stage))
    return measure(stage, frames)


def by_sequence(joins: JoinSeat | None = None) -> Walk:
    """Press key 2 of level B (forward) once, and return the speeds over 24 s."""
    stage = practice(90.0, joins)
    frames = [pose(stage)]
    stage.beat(key(0, FORWARD, level=B))
    for _ in range(int(RUN_S / 0.02)):
        frames.append(pose(stage))
        stage.beat()
    return measure(stage, frames)


def test_1234_walks_forward() -> None:
    """Keys 1, 2, 3, 4 (workshop 4-2) walk forward at 42 ± 3 mm/s, upright, nearly straight."""
    walk = by_hand((1, 2, 3, 4))
    assert walk.forward_mm_s == pytest.approx(42.0, abs=3.0)
    assert abs(walk.turn_deg_s) < 1.0
    assert walk.upright > 0.99


def test_4321_walks_back() -> None:
    """Keys 4, 3, 2, 1 (workshop 4-2) walk back at 42 ± 3 mm/s, nearly straight."""
    walk = by_hand((4, 3, 2, 1))
    assert walk.forward_mm_s == pytest.approx(-42.0, abs=3.0)
    assert abs(walk.turn_deg_s) < 1.0


def test_5678_turns_right_and_8765_left() -> None:
    """Keys 5 to 8 (workshop 4-2) turn right at 15 ± 2 degrees/s, and 8 to 5 turn left as fast."""
    right, left = by_hand((5, 6, 7, 8)), by_hand((8, 7, 6, 5))
    assert right.turn_deg_s == pytest.approx(-15.0, abs=2.0)
    assert left.turn_deg_s == pytest.approx(15.0, abs=2.0)
    assert abs(right.forward_mm_s) < 10
    assert abs(left.forward_mm_s) < 10


def test_0_stands() -> None:
    """With key 0 of level A the robot stays where it is."""
    walk = by_hand((0,))
    assert abs(walk.forward_mm_s) < 0.5
    assert abs(walk.turn_deg_s) < 0.1


def test_every_heading_is_as_fast() -> None:
    """With elliptic friction cones, speed does not depend on the heading (docs/facts.md 2)."""
    speeds = [by_hand((1, 2, 3, 4), heading).forward_mm_s for heading in (90.0, 27.0)]
    assert speeds[0] == pytest.approx(speeds[1], abs=0.3)


def test_reached() -> None:
    """At level B, with `advance = "reached"`, the sample gait walks at 57 ± 4 mm/s."""
    walk = by_sequence()
    assert walk.forward_mm_s == pytest.approx(57.0, abs=4.0)
    assert abs(walk.turn_deg_s) < 1.0


def test_time() -> None:
    """At level B with "time" and 0.2 s a posture, the sample gait walks at 98 ± 5 mm/s."""
    text = find_robot("hexapod")[1].decode()
    assert 'advance = "reached"' in text
    text = text.replace('advance = "reached"', 'advance = "time"').replace(
        "hold_s = 0.0 ", "hold_s = 0.2 "
    )
    walk = by_sequence(join(0, robot_file=text.encode()))
    assert walk.forward_mm_s == pytest.approx(98.0, abs=5.0)
    assert abs(walk.turn_deg_s) < 1.0
