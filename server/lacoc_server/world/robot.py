"""Where a robot lies in the arrays of a compiled model."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from lacoc_arenas.game import Place
from lacoc_server.match.entry import Entry


@dataclass(frozen=True)
class Robot:
    """One robot in the arrays of MuJoCo."""

    entry: Entry
    root_qpos: int
    """Where its position and quaternion begin in `qpos`: 7 numbers."""
    root_dof: int
    """Where its linear and angular velocity begin in `qvel`: 6 numbers."""
    joint_qpos: npt.NDArray[np.intp]
    """(joints,) places of its angles in `qpos`, by joint id."""
    joint_dofs: npt.NDArray[np.intp]
    """(joints,) places of their velocities in `qvel`, by joint id."""
    actuators: slice
    """Its commanded angles in `ctrl`, by joint id."""
    geoms: npt.NDArray[np.intp]
    """Ids of its geoms."""

    @classmethod
    def find(cls, model: Any, entry: Entry, seat: str) -> "Robot":
        """Find a robot in a compiled model.

        Args:
            model: the `MjModel`.
            entry: what the robot was built of.
            seat: id of its seat; with a slash it begins all its names.
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
        """Places in `qpos` of its numbers in `Frame.poses`, in their order."""
        return [*range(self.root_qpos, self.root_qpos + 7), *self.joint_qpos.tolist()]

    def put(self, data: Any, place: Place) -> None:
        """Put it at a start place: start posture, all velocities zero."""
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
