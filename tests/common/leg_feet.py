"""Random postures of a robot, and where MuJoCo has its feet.

As a program it writes them for the sample robots as msgpack: {name: [angles, feet]}, as
little-endian float64. The cases of tests/pages/core/leg.test.mjs read it.
"""

import sys
from typing import Any

import mujoco as mj
import numpy as np
import numpy.typing as npt

from lacoc_robots.library import find_robot
from lacoc_robots.model import on_floor
from lacoc_robots.robot import RobotSpec
from lacoc_robots.robot_file import read_robot
from lacoc_shared.codec import encode

SAMPLES = ("hexapod", "long-legs", "quadruped", "octopod")
POSTURES = 10_000

Numbers = npt.NDArray[np.float64]


def sample(name: str) -> RobotSpec:
    """Read a sample robot."""
    file, content = find_robot(name)
    return read_robot(content, file)


def random_feet(robot: RobotSpec, postures: int = POSTURES) -> tuple[Numbers, Numbers]:
    """Return (postures, joints) random angles [deg] and MuJoCo's (postures, legs, 3) feet.

    The angles are in the joints' ranges, the feet in the body frame [mm].
    """
    model = on_floor(robot).compile()
    data: Any = mj.MjData(model)
    low, high = np.array(robot.ranges_rad).T
    angles = np.random.default_rng(6).uniform(low, high, (postures, len(low)))
    places = [model.joint(f"j{joint}").qposadr[0] for joint in range(len(low))]
    shanks = [model.body(f"leg{leg}_2").id for leg in range(len(robot.legs))]
    lengths_m = np.array([leg.lengths_m[2] for leg in robot.legs])
    data.qpos[:7] = (0, 0, 0, 1, 0, 0, 0)
    feet = np.empty((postures, len(shanks), 3))
    for posture, now in enumerate(angles):
        data.qpos[places] = now
        mj.mj_kinematics(model, data)
        # A shank hangs along -z of its own frame.
        down = -data.xmat[shanks].reshape(-1, 3, 3)[:, :, 2]
        feet[posture] = data.xpos[shanks] + lengths_m[:, None] * down
    return np.degrees(angles), 1000.0 * feet


if __name__ == "__main__":
    written = {
        name: [part.astype("<f8").tobytes() for part in random_feet(sample(name))]
        for name in SAMPLES
    }
    sys.stdout.buffer.write(encode(written))
