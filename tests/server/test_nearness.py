"""Tests of the choice of a model: what it leaves out is not there, wherever the robots are."""

import math
from collections.abc import Callable

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from stage import entry

from lacoc_arenas import field
from lacoc_arenas.game import Place
from lacoc_robots.model import add_robot, set_options
from lacoc_server.world.models import Models, compile_models
from lacoc_server.world.nearness import Nearness
from lacoc_server.world.robot import Robot

SIZE_M = (2.4, 2.0)
KINDS = ("hexapod", "long-legs")


def described(robots: int) -> mujoco.MjSpec:
    """Describe a field with a box, and robots of different kinds."""
    spec = mujoco.MjSpec()
    set_options(spec)
    field.ground(spec, SIZE_M)
    spec.worldbody.add_geom(
        name="box", type=mujoco.mjtGeom.mjGEOM_BOX, size=[0.1, 0.05, 0.04], pos=[0.8, 0.6, 0.04]
    )
    for seat, kind in enumerate(KINDS[:robots]):
        add_robot(spec, entry(kind).robot, f"{seat}/", seat, 2, (1.0, 1.0, 1.0, 1.0))
    return spec


def kind_of(models: Models, model: object) -> str:
    return next(kind for kind, one in models._asdict().items() if one is model)


MODELS = compile_models(described(2), 2)
ROBOTS = [Robot.find(MODELS.stepped, entry(kind), str(seat)) for seat, kind in enumerate(KINDS)]
PLACES = st.builds(
    Place,
    st.floats(-SIZE_M[0] / 2, SIZE_M[0] / 2),
    st.floats(-SIZE_M[1] / 2, SIZE_M[1] / 2),
    st.floats(-math.pi, math.pi),
)


@given(st.lists(st.floats(-math.pi, math.pi), min_size=3, max_size=3))
def test_a_robot_is_inside_its_ball(angles: list[float]) -> None:
    """No part of a robot is farther from the origin of its body than the reach that is used."""
    data = mujoco.MjData(MODELS.stepped)
    nearness = Nearness(MODELS, data.qpos, ROBOTS)
    for robot in ROBOTS:
        data.qpos[robot.joint_qpos] = np.repeat(angles, len(robot.joint_qpos) // 3)
    mujoco.mj_kinematics(MODELS.stepped, data)
    for robot, reach_m in zip(ROBOTS, nearness._reaches_m, strict=True):
        origin_w = data.qpos[robot.root_qpos : robot.root_qpos + 3]
        for geom in robot.geoms:
            if MODELS.stepped.geom_type[geom] != mujoco.mjtGeom.mjGEOM_CAPSULE:
                continue
            radius_m, half_m, _ = MODELS.stepped.geom_size[geom]
            for end in (-half_m, half_m):
                end_w = data.geom_xpos[geom] + end * data.geom_xmat[geom][2::3]
                assert math.dist(end_w, origin_w) + radius_m <= reach_m


@given(
    PLACES,
    st.floats(0.0, 0.8),
    st.floats(-math.pi, math.pi),
    st.lists(st.floats(-math.pi, math.pi), min_size=3, max_size=3),
)
def test_what_a_model_leaves_out_is_not_there(
    left: Place, apart_m: float, towards_rad: float, angles: list[float]
) -> None:
    """No contact is there that the chosen model lacks, with all legs in one posture, any one."""
    x_m, y_m = math.cos(towards_rad) * apart_m, math.sin(towards_rad) * apart_m
    right = Place(left.x_m + x_m, left.y_m + y_m, towards_rad)
    data = mujoco.MjData(MODELS.stepped)
    for robot, place in zip(ROBOTS, (left, right), strict=True):
        robot.put(data, place)
        data.qpos[robot.root_qpos + 2] = 0.1  # legs at one height
        data.qpos[robot.joint_qpos] = np.repeat(angles, len(robot.joint_qpos) // 3)
    chosen = kind_of(MODELS, Nearness(MODELS, data.qpos, ROBOTS).model())
    mujoco.mj_forward(MODELS.stepped, data)
    model = MODELS.stepped
    for one, other in data.contact.geom.tolist():
        moves = [model.geom(geom).bodyid[0] > 0 for geom in (one, other)]
        if chosen == "apart":
            assert moves != [True, True]
        elif chosen == "clear":
            assert model.geom(one).name == "floor" or moves == [True, True]


@pytest.mark.parametrize(
    ("left", "right", "kind"),
    [
        (Place(-0.6, 0.0, 0.0), Place(0.6, 0.0, 0.0), "apart"),
        (Place(-0.2, -0.2, 0.0), Place(0.2, -0.2, 0.0), "clear"),
        (Place(-0.2, -0.9, 0.0), Place(0.2, -0.9, 0.0), "stepped"),
        (Place(0.8, 0.6, 0.0), Place(0.4, 0.3, 0.0), "stepped"),
    ],
)
def test_the_least_model_is_chosen(left: Place, right: Place, kind: str) -> None:
    """Far from each other, near each other, near a wall too, and near the box."""
    data = mujoco.MjData(MODELS.stepped)
    nearness = Nearness(MODELS, data.qpos, ROBOTS)
    for robot, place in zip(ROBOTS, (left, right), strict=True):
        robot.put(data, place)
    assert kind_of(MODELS, nearness.model()) == kind
    robot = ROBOTS[0]
    data.qpos[robot.root_qpos : robot.root_qpos + 3] = right.x_m, right.y_m, 0.1
    assert kind_of(MODELS, nearness.model()) in {"stepped", "clear"}


def _ball(spec: mujoco.MjSpec) -> None:
    body = spec.worldbody.add_body(name="ball", pos=[0.0, 0.5, 0.1])
    body.add_freejoint()
    body.add_geom(size=[0.05, 0.0, 0.0])


def _crowd(spec: mujoco.MjSpec) -> None:
    for number in range(20):
        spec.worldbody.add_geom(size=[0.01, 0.0, 0.0], pos=[number / 10, 0.0, 0.0])


def _rough(spec: mujoco.MjSpec) -> None:
    spec.geom("floor").priority = 2


@pytest.mark.parametrize(
    ("change", "clear", "apart"),
    [(_ball, False, False), (_crowd, True, False), (_rough, True, False)],
)
def test_a_model_that_could_differ_is_not_made(
    change: Callable[[mujoco.MjSpec], None], clear: bool, apart: bool
) -> None:
    """Not if a ball of the field moves, too many geoms stand there, or a floor decides contacts."""
    spec = described(2)
    change(spec)
    models = compile_models(spec, 2)
    assert (models.clear is not None, models.apart is not None) == (clear, apart)
