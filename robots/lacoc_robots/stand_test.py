"""Try in physics whether a robot stays in place when it is told to stand."""

import math
from collections.abc import Collection

import mujoco as mj
import numpy as np

from lacoc_robots.model import STEPS_PER_TICK, on_floor
from lacoc_robots.robot import RobotSpec
from lacoc_robots.standing import STAND_TEST_S, Stood, mistakes_of, standing_postures
from lacoc_shared.gait.motion import toward
from lacoc_shared.gait.tables import Gait, Level, Posture
from lacoc_shared.mistakes import Mistake
from lacoc_shared.seat import BEAT_S


def try_standing(
    robot: RobotSpec, gait: Gait, levels: Collection[Level], file: str
) -> list[Mistake]:
    """Let a robot stand with key 0 of each level, and list the mistakes; try equal postures once.

    Args:
        robot: the robot.
        gait: the robot's gait.
        levels: levels of control that are open.
        file: name of the robot file, for error messages.

    Returns:
        The mistakes that keep the robot from standing; empty if the robot stays in place.
    """
    postures = standing_postures(gait, levels, robot.start_posture)
    return [
        mistake
        for posture, where in postures.items()
        for mistake in mistakes_of(stand(robot, posture), file, where)
    ]


def stand(robot: RobotSpec, posture: Posture) -> Stood:
    """Put a robot on an empty floor, let it take a posture, and measure how it moves and tilts.

    Args:
        robot: the robot.
        posture: (joints,) angles to stand with [rad].
    """
    model = on_floor(robot).compile()
    data = mj.MjData(model)
    joints = [model.joint(f"j{joint}") for joint in range(robot.joints)]
    data.qpos[[joint.qposadr[0] for joint in joints]] = robot.start_posture
    angles, step_rad = robot.start_posture, robot.ang_min_rad_s * BEAT_S
    moved_m, up = 0.0, 1.0
    for _ in range(round(STAND_TEST_S / BEAT_S)):
        angles = toward(angles, posture, step_rad)
        data.ctrl[:] = angles
        mj.mj_step(model, data, nstep=STEPS_PER_TICK)
        if data.warning.number.any():
            return Stood(moved_m, 0.0, 0.0, 0.0, fault=True)
        at_x_m, at_y_m, _, _, x, y, _ = data.qpos[:7].tolist()
        moved_m = max(moved_m, math.hypot(at_x_m, at_y_m))
        up = min(up, 1 - 2 * (x * x + y * y))
    dofs = [joint.dofadr[0] for joint in joints]
    return Stood(
        moved_m,
        math.acos(max(-1.0, up)),
        float(np.abs(data.qvel[dofs]).max()),
        math.hypot(*data.qvel[:3]),
    )
