from collections.abc import Callable

import mujoco as mj
import pytest

from lacoc_robots.library import find_robot
from lacoc_robots.model import FLOOR_CONAFFINITY, FLOOR_CONTYPE, add_robot, set_options
from lacoc_robots.robot import RobotSpec
from lacoc_robots.robot_file import read_robot

Compile = Callable[..., mj.MjModel]


@pytest.fixture
def hexapod_text() -> str:
    """Give the text of the workshop's robot file."""
    return find_robot("hexapod")[1].decode()


@pytest.fixture
def hexapod(hexapod_text: str) -> RobotSpec:
    """Give the workshop's robot."""
    return read_robot(hexapod_text, "robot.toml")


@pytest.fixture
def compile_world() -> Compile:
    """Give a function that compiles a model of a floor and robots, one robot for each seat."""

    def compile_world(*robots: RobotSpec, degree: bool = True) -> mj.MjModel:
        world = mj.MjSpec()
        world.compiler.degree = degree
        set_options(world)
        world.worldbody.add_geom(
            name="floor",
            type=mj.mjtGeom.mjGEOM_PLANE,
            size=[0, 0, 0.05],
            contype=FLOOR_CONTYPE,
            conaffinity=FLOOR_CONAFFINITY,
        )
        for seat, robot in enumerate(robots):
            add_robot(world, robot, f"r{seat}_", seat, len(robots), (0.2, 0.4, 0.9, 1.0))
        return world.compile()

    return compile_world
