"""The world: the one place where physics is stepped (design.md, "Robot and world")."""

import hashlib
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt

from lacoc_arenas.arena import Arena
from lacoc_arenas.game import Place
from lacoc_robots.model import add_robot, set_options
from lacoc_server.entry import Entry
from lacoc_server.physics import Fault
from lacoc_server.scene import make_scene
from lacoc_shared.codec import encode
from lacoc_shared.gait import Posture
from lacoc_shared.seat import NOBODY

SUBSTEPS = 10
"""Physics steps of 2 ms in a tick of 20 ms."""

_STATE = int(mujoco.mjtState.mjSTATE_INTEGRATION)
"""Everything the next step depends on; less (FULLPHYSICS) is not exact (physics.md 1)."""

_WARNINGS = {
    mujoco.mjtWarning.mjWARN_BADQPOS: "a position became not a number or too large",
    mujoco.mjtWarning.mjWARN_BADQVEL: "a velocity became not a number or too large",
    mujoco.mjtWarning.mjWARN_BADQACC: "an acceleration became not a number or too large",
    mujoco.mjtWarning.mjWARN_BADCTRL: "a commanded angle was not a number",
    mujoco.mjtWarning.mjWARN_CONTACTFULL: "too many contacts",
    mujoco.mjtWarning.mjWARN_CNSTRFULL: "too many constraints",
    mujoco.mjtWarning.mjWARN_INERTIA: "the inertia matrix is singular",
}


@dataclass(frozen=True)
class _Robot:
    """Where a robot lies in the model's arrays."""

    entry: Entry
    root_qpos: int
    root_dof: int
    joint_qpos: npt.NDArray[np.intp]
    joint_dofs: npt.NDArray[np.intp]
    actuators: slice
    geoms: npt.NDArray[np.intp]
    reach_m: float
    """No part is ever farther from the body's origin."""


class World:
    """Robots on a field, stepped tick by tick; implements `physics.Physics`.

    The model is compiled here, once. A tick is exact: the same state and angles give the same
    bits on one version of MuJoCo and one kind of machine.

    Args:
        arena: the field and its game.
        entries: one for each seat; none for the empty field.
    """

    def __init__(self, arena: Arena, entries: Sequence[Entry]) -> None:
        spec = mujoco.MjSpec()
        set_options(spec)
        arena.build_field(spec)
        seats = [seat.id for seat in arena.seats]
        for index, entry in enumerate(entries):
            add_robot(
                spec,
                entry.robot,
                prefix=f"{seats[index]}/",
                seat=index,
                seats=len(seats),
                rgba=_rgba(arena.seats[index].colour),
            )
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        self.scene = make_scene(self.model, arena.game, seats)
        self.scene_hash = _hash(encode(self.scene)).digest()
        buffer = np.empty(mujoco.mj_sizeModel(self.model), np.uint8)
        mujoco.mj_saveModel(self.model, None, buffer)
        self.model_hash = _hash(buffer).hexdigest()
        self.digest = bytes(8)
        self._robots = [self._find(entry, seats[i]) for i, entry in enumerate(entries)]
        qpos = [
            index
            for robot in self._robots
            for index in (*range(robot.root_qpos, robot.root_qpos + 7), *robot.joint_qpos)
        ]
        self._pose_qpos = np.array(qpos, np.intp)
        self._probes = [
            (index, self.model.geom(f"probe:{marker.name}").id, marker.x_m, marker.y_m)
            for index, marker in enumerate(arena.game.markers)
            if mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_GEOM, f"probe:{marker.name}") >= 0
        ]
        probe_radius_m = max((float(self.model.geom_rbound[p[1]]) for p in self._probes), default=0)
        self._near_m2 = [(robot.reach_m + probe_radius_m) ** 2 for robot in self._robots]
        self._state = np.empty(mujoco.mj_stateSize(self.model, _STATE))
        for seat, robot in enumerate(self._robots):
            self._put(robot, arena.game.starts[seat][0])
        self._keep()

    # Physics

    def place(self, seat: int, place: Place) -> None:
        """Put a robot at a start place: start posture, all velocities zero."""
        self._put(self._robots[seat], place)
        self._keep()

    def step(self, angles: Sequence[Posture]) -> Fault | None:
        """Let one tick pass.

        Args:
            angles: for each seat the commanded angles [rad], by joint id.

        Returns:
            None, or what went wrong; then the state before the tick stands.
        """
        control = self.data.ctrl
        for robot, commanded in zip(self._robots, angles, strict=True):
            control[robot.actuators] = commanded
        mujoco.mj_step(self.model, self.data, nstep=SUBSTEPS)
        if self.data.warning.number.any():
            return self._undo()
        mujoco.mj_getState(self.model, self.data, self._state, _STATE)
        self.digest = hashlib.blake2b(self._state.data, key=self.digest, digest_size=8).digest()
        return None

    def poses(self) -> bytes:
        """The robots as `Frame.poses`."""
        poses: npt.NDArray[np.float32] = self.data.qpos[self._pose_qpos].astype("<f4")
        return poses.tobytes()

    def touched(self) -> Sequence[tuple[int, ...]]:
        """For each seat the markers whose probes it touches now, in ascending order.

        A probe is a geom that exerts no force. Touch is MuJoCo's own distance between geoms being
        at most 0; the order of the contact list plays no part.
        """
        near = [self._near(seat) for seat in range(len(self._robots))]
        if any(near):
            # After mj_step, the geoms still stand where the last step began.
            mujoco.mj_kinematics(self.model, self.data)
        return [
            tuple(marker for marker, probe in probes if self._touches(robot, probe))
            for robot, probes in zip(self._robots, near, strict=True)
        ]

    # Snapshots

    def save(self) -> bytes:
        """The state; with `load` a world of the same model goes on bit for bit."""
        return self.digest + self._state.tobytes()

    def load(self, saved: bytes) -> None:
        """Go on from a saved state.

        Raises:
            ValueError: if it is not of this model.
        """
        state = np.frombuffer(saved[8:])
        if state.size != self._state.size:
            raise ValueError(f"a state of {state.size} numbers; this model has {self._state.size}")
        self.digest = saved[:8]
        self._state[:] = state
        mujoco.mj_setState(self.model, self.data, self._state, _STATE)

    # Private

    def _find(self, entry: Entry, seat: str) -> _Robot:
        model = self.model
        joints = [model.joint(f"{seat}/j{joint}") for joint in range(entry.robot.joints)]
        root = model.joint(f"{seat}/root")
        first = model.actuator(f"{seat}/a0").id
        body_root = int(model.body(f"{seat}/body").id)
        return _Robot(
            entry,
            int(root.qposadr[0]),
            int(root.dofadr[0]),
            np.array([joint.qposadr[0] for joint in joints], np.intp),
            np.array([joint.dofadr[0] for joint in joints], np.intp),
            slice(first, first + len(joints)),
            np.flatnonzero(model.body_rootid[model.geom_bodyid] == body_root),
            _reach_m(entry),
        )

    def _put(self, robot: _Robot, place: Place) -> None:
        data, spec = self.data, robot.entry.robot
        at = robot.root_qpos
        data.qpos[at : at + 3] = place.x_m, place.y_m, spec.start_z_m
        half_yaw = (place.heading_rad - np.pi / 2) / 2  # the body's forward is its +y
        data.qpos[at + 3 : at + 7] = np.cos(half_yaw), 0, 0, np.sin(half_yaw)
        data.qpos[robot.joint_qpos] = spec.start_posture
        data.ctrl[robot.actuators] = spec.start_posture
        dofs = np.concatenate([np.arange(robot.root_dof, robot.root_dof + 6), robot.joint_dofs])
        data.qvel[dofs] = 0
        data.qacc_warmstart[dofs] = 0

    def _keep(self) -> None:
        mujoco.mj_getState(self.model, self.data, self._state, _STATE)

    def _undo(self) -> Fault:
        """Go back to before the tick; MuJoCo may have reset everything (physics.md 6.1)."""
        numbers = self.data.warning.number
        kind = int(np.flatnonzero(numbers)[0])
        where = int(self.data.warning[kind].lastinfo)
        words = _WARNINGS.get(mujoco.mjtWarning(kind), f"MuJoCo's warning {kind}")
        numbers[:] = 0
        mujoco.mj_setState(self.model, self.data, self._state, _STATE)
        return Fault(self._seat_of(mujoco.mjtWarning(kind), where), words)

    def _seat_of(self, kind: mujoco.mjtWarning, where: int) -> int:
        """The robot that a warning is about; `where` is the index that MuJoCo gives."""
        for seat, robot in enumerate(self._robots):
            match kind:
                case mujoco.mjtWarning.mjWARN_BADQPOS:
                    first, count = robot.root_qpos, 7 + len(robot.joint_qpos)
                case mujoco.mjtWarning.mjWARN_BADQVEL | mujoco.mjtWarning.mjWARN_BADQACC:
                    first, count = robot.root_dof, 6 + len(robot.joint_dofs)
                case mujoco.mjtWarning.mjWARN_BADCTRL:
                    first, count = robot.actuators.start, len(robot.joint_qpos)
                case _:
                    return NOBODY
            if first <= where < first + count:
                return seat
        return NOBODY

    def _near(self, seat: int) -> list[tuple[int, int]]:
        """Markers (with their probes) that some part of a robot may reach."""
        if not self._probes:
            return []
        at, near_m2 = self._robots[seat].root_qpos, self._near_m2[seat]
        x_m, y_m = self.data.qpos[at : at + 2].tolist()
        return [
            (marker, probe)
            for marker, probe, probe_x_m, probe_y_m in self._probes
            if (probe_x_m - x_m) ** 2 + (probe_y_m - y_m) ** 2 <= near_m2
        ]

    def _touches(self, robot: _Robot, probe: int) -> bool:
        model, data = self.model, self.data
        gaps = data.geom_xpos[robot.geoms, :2] - data.geom_xpos[probe, :2]
        reach = model.geom_rbound[robot.geoms] + model.geom_size[probe, 0]
        candidates = robot.geoms[np.einsum("ij,ij->i", gaps, gaps) <= reach * reach]
        return any(
            mujoco.mj_geomDistance(model, data, geom, probe, _TOUCH_M, None) <= 0
            for geom in candidates.tolist()
        )


_TOUCH_M = 1e-3
"""Distances are worked out up to here; farther apart is no touch."""


def _reach_m(entry: Entry) -> float:
    robot = entry.robot
    legs = (math.hypot(*leg.position_m) + sum(leg.lengths_m) + leg.radius_m for leg in robot.legs)
    return max(math.hypot(*robot.size_m) / 2, *legs)


def _hash(data: Any) -> Any:
    return hashlib.blake2b(data, digest_size=8)


def _rgba(colour: str) -> tuple[float, float, float, float]:
    red, green, blue = (int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5))
    return red, green, blue, 1.0
