"""The signs of joints (rules 1) and the lengths of links, checked by pure forward kinematics."""

import math
from itertools import pairwise

import numpy as np
import pytest
from every_third import every_third
from hypothesis import given
from hypothesis import strategies as st
from leg_feet import SAMPLES, random_feet, sample

from lacoc_robots.library import find_robot
from lacoc_robots.robot import RobotSpec
from lacoc_robots.robot_file import read_robot

RIGHT, LEFT = (0, 1, 2), (3, 4, 5)
ZERO = (0.0,) * 18


def turned(*joints: int, by_deg: float = 30.0) -> tuple[float, ...]:
    return tuple(math.radians(by_deg) if j in joints else 0.0 for j in range(18))


def test_feet_on_the_floor_at_angle_zero(hexapod: RobotSpec) -> None:
    """With every angle 0 the feet are on the floor, 135 mm to the side of the body's middle."""
    for index, (*_, foot) in enumerate(hexapod.points(ZERO)):
        assert foot.z + hexapod.start_z_m == pytest.approx(0.0, abs=1e-12)
        assert foot.x == pytest.approx(0.135 if index in RIGHT else -0.135)


def test_lengths_between_hinges(hexapod: RobotSpec) -> None:
    """From one hinge to the next, or to the foot, the links are 15, 70 and 70 mm long."""
    posture = tuple(math.radians(7 * j - 60) for j in range(18))
    for points in hexapod.points(posture):
        lengths = [math.dist(a, b) for a, b in pairwise(points)]
        assert lengths == pytest.approx([0.015, 0.070, 0.070])


def test_capsules_are_the_workshops(hexapod: RobotSpec) -> None:
    """A link is a cylinder of 0.04 m with two caps of radius 0.015 m; the root link is a sphere."""
    for index, capsule in enumerate(hexapod.capsules(turned(*range(18)))):
        cylinder_m = math.dist(capsule.start, capsule.end)
        assert cylinder_m == pytest.approx(0.0 if index % 3 == 0 else 0.04, abs=1e-12)
        assert capsule.radius_m == 0.015


def test_legs_go_clockwise_from_the_right_front(hexapod: RobotSpec) -> None:
    """Legs are numbered clockwise from the right front: R,F R,C R,B L,B L,C L,F (rules 1)."""
    for index, label in enumerate(hexapod.labels):
        side, place = label.split(",")
        foot = hexapod.points(ZERO)[index][3]
        assert (foot.x > 0) == (side == "R") == (index in RIGHT)
        assert {"F": 1, "C": 0, "B": -1}[place] == (foot.y > 0.01) - (foot.y < -0.01)


@pytest.mark.parametrize("leg", range(6))
def test_root_swings_forward_on_both_sides(hexapod: RobotSpec, leg: int) -> None:
    """A positive angle of joints 0-5 swings the leg forward (+y), on both sides (rules 1)."""
    before, after = (hexapod.points(posture)[leg][3] for posture in (ZERO, turned(leg)))
    assert after.y - before.y == pytest.approx((0.135 - 0.05) * math.sin(math.radians(30)))
    assert after.z == pytest.approx(before.z)
    assert abs(after.x) < abs(before.x)


@pytest.mark.parametrize("leg", range(6))
def test_first_lifts_the_link(hexapod: RobotSpec, leg: int) -> None:
    """A positive angle of joints 6-11 lifts the leg (rules 1)."""
    before, after = (hexapod.points(posture)[leg] for posture in (ZERO, turned(leg + 6)))
    assert after[2].z - before[2].z == pytest.approx(0.070 * math.sin(math.radians(30)))
    assert after[1] == before[1]


@pytest.mark.parametrize("leg", range(6))
def test_second_swings_the_shank_outward_and_up(hexapod: RobotSpec, leg: int) -> None:
    """A positive angle of joints 12-17 swings the shank outward and up (rules 1)."""
    before, after = (hexapod.points(posture)[leg] for posture in (ZERO, turned(leg + 12)))
    assert before[3].x == before[2].x
    assert abs(after[3].x) - abs(before[3].x) == pytest.approx(0.070 * math.sin(math.radians(30)))
    assert after[3].z > before[3].z
    assert after[2] == before[2]


def test_joint_ids_go_level_by_level(hexapod: RobotSpec) -> None:
    """Joint ids count all Roots, then all 1st, then all 2nd: joint 13 of six legs is of leg R,C."""
    moved = [a != b for a, b in zip(hexapod.points(ZERO), hexapod.points(turned(13)), strict=True)]
    assert moved == [False, True, False, False, False, False]


def test_fig_1_3_posture(hexapod: RobotSpec) -> None:
    """With 1st and 2nd joint at 30 degrees, a shank leans 60 degrees outward (workshop 3-1)."""
    _, _, knee, foot = hexapod.points(turned(6, 12))[0]
    assert (foot.x - knee.x, foot.z - knee.z) == pytest.approx(
        (0.070 * math.sin(math.radians(60)), -0.070 * math.cos(math.radians(60)))
    )


@given(st.lists(st.floats(-2.6, 2.6), min_size=18, max_size=18))
def test_bounds_hold_every_part(angles: list[float]) -> None:
    """The bounds contain every hinge and foot in any posture."""
    robot = read_robot(find_robot("hexapod")[1], "robot.toml")
    low, high = robot.bounds(tuple(angles))
    for points in robot.points(tuple(angles)):
        for point in points:
            assert all(a - 1e-9 <= x <= b + 1e-9 for a, x, b in zip(low, point, high, strict=True))


def test_radius_in_the_start_posture(hexapod: RobotSpec) -> None:
    """The robot's radius reaches beyond the feet at the start, by less than a link's radius."""
    _, _, knee, foot = hexapod.points(hexapod.start_posture)[0]
    assert math.hypot(foot.x, foot.y) < hexapod.radius_m < math.hypot(foot.x, foot.y) + 0.015
    assert hexapod.radius_m > math.hypot(knee.x, knee.y)


@pytest.mark.parametrize("name", every_third(SAMPLES))
def test_feet_are_where_mujoco_has_them(name: str) -> None:
    """In 10,000 random postures each foot is within 0.01 mm of the model's foot."""
    robot = sample(name)
    angles, feet = random_feet(robot)
    found = np.array(
        [[leg[3] for leg in robot.points(tuple(posture))] for posture in np.radians(angles)]
    )
    assert np.abs(1000.0 * found - feet).max() < 0.01
