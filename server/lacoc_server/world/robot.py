"""Finds a robot's numbers in the arrays of a compiled model."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from lacoc_arenas.game import Place
from lacoc_server.match.entry import Entry


@dataclass(frozen=True, repr=False)  # that of a dataclass prints whole arrays
class Robot:
    """The indices of one robot in MuJoCo's arrays."""

    entry: Entry
    root_qpos: int
    """Index in `qpos` of the first of the 7 numbers of its position and quaternion."""
    root_dof: int
    """Index in `qvel` of the first of the 6 numbers of its linear and angular velocity."""
    joint_qpos: npt.NDArray[np.intp]
    """(joints,) indices in `qpos` of its angles, by joint id."""
    joint_dofs: npt.NDArray[np.intp]
    """(joints,) indices in `qvel` of its joint velocities, by joint id."""
    actuators: slice
    """Indices in `ctrl` of its commanded angles, by joint id."""
    geoms: npt.NDArray[np.intp]
    """Ids of the robot's geoms in the model."""

    @classmethod
    def find(cls, model: Any, entry: Entry, seat: str) -> "Robot":
        """Find a robot in a compiled model.

        Args:
            model: the `MjModel`.
            entry: entry that the robot was built from.
            seat: id of the robot's seat; names of the robot's parts begin with this id and a slash.
        """
        joints = [model.joint(f"{seat}/j{joint}") for joint in range(entry.robot.joints)]
        root = model.joint(f"{seat}/root")
        first = model.actuator(f"{seat}/a0").id
        body = int(model.body(f"{seat}/body").id)
        return cls(
            entry,
            int(root.qposadr[0]),
            int(root.dofadr[0]),
            np.array([joint.qposadr[0] for joint in joints], np.intp),
            np.array([joint.dofadr[0] for joint in joints], np.intp),
            slice(first, first + len(joints)),
            np.flatnonzero(model.body_rootid[model.geom_bodyid] == body),
        )

    @property
    def pose_qpos(self) -> list[int]:
        """Indices in `qpos` of the numbers that `Frame.poses` has of this robot, in that order."""
        return [*range(self.root_qpos, self.root_qpos + 7), *self.joint_qpos.tolist()]

    def put(self, data: Any, place: Place) -> None:
        """Put the robot at a start place, in its start posture and with all velocities zero.

        The commanded angles become those of the start posture.
        """
        spec = self.entry.robot
        at = self.root_qpos
        half_yaw = (place.heading_rad - math.pi / 2) / 2  # the body's forward is its +y
        data.qpos[at : at + 3] = place.x_m, place.y_m, spec.start_z_m
        data.qpos[at + 3 : at + 7] = math.cos(half_yaw), 0, 0, math.sin(half_yaw)
        data.qpos[self.joint_qpos] = spec.start_posture
        data.ctrl[self.actuators] = spec.start_posture
        dofs = np.concatenate([np.arange(self.root_dof, self.root_dof + 6), self.joint_dofs])
        data.qvel[dofs] = 0
        data.qacc_warmstart[dofs] = 0


def reach_m(model: Any, geom: int, base: int) -> float:
    """Return an upper bound [m] of the distance of a geom's points from the origin of `base`.

    The bound holds at all joint angles, because each hinge goes through the origin of its own body.
    """
    middle_m = np.linalg.norm(model.geom_pos[geom])
    bound_m = float(middle_m) + float(model.geom_rbound[geom])
    body = model.geom_bodyid[geom]
    while body != base:
        bound_m += float(np.linalg.norm(model.body_pos[body]))
        body = model.body_parentid[body]
    return bound_m
