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
from lacoc_server.match.entry import Entry
from lacoc_server.match.physics import Fault
from lacoc_server.world.scene import make_scene
from lacoc_shared.codec import encode, message_hash
from lacoc_shared.gait.tables import Posture
from lacoc_shared.seat import NOBODY

SUBSTEPS = 10
"""Physics steps of 2 ms in a tick of 20 ms."""

MUJOCO_VERSION = mujoco.mj_versionString()
"""A replay is exact only with the same."""

_STATE = int(mujoco.mjtState.mjSTATE_INTEGRATION)
"""Everything the next step depends on; less (FULLPHYSICS) is not exact (physics.md 1)."""

_TOUCH_M = 1e-3
"""Distances between geoms are worked out up to here; farther apart is no touch."""

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
        self.scene_hash = message_hash(encode(self.scene))
        buffer = np.empty(mujoco.mj_sizeModel(self.model), np.uint8)
        mujoco.mj_saveModel(self.model, None, buffer)
        self.model_hash = hashlib.blake2b(buffer.data, digest_size=8).hexdigest()
        self.digest = bytes(8)
        self._robots = [self._find(entry, seats[i]) for i, entry in enumerate(entries)]
        qpos = [
            index
            for robot in self._robots
            for index in (*range(robot.root_qpos, robot.root_qpos + 7), *robot.joint_qpos)
        ]
        self._pose_qpos = np.array(qpos, np.intp)
        probes = {
            marker: mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_GEOM, f"probe:{info.name}")
            for marker, info in enumerate(arena.game.markers)
        }
        self._probes = [(marker, probe) for marker, probe in probes.items() if probe >= 0]
        self._touch = _TouchTest(self.model, self.data, self._robots, self._probes)
        # Views into MuJoCo's own arrays: they always show what is there now.
        self._control = self.data.ctrl
        self._warned = self.data.warning.number
        self._state = np.empty(mujoco.mj_stateSize(self.model, _STATE))
        self._weights = _weights(self.model)
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
        self._control[:] = [angle for posture in angles for angle in posture]
        mujoco.mj_step(self.model, self.data, nstep=SUBSTEPS)
        if any(self._warned.tobytes()):
            return self._undo()
        mujoco.mj_getState(self.model, self.data, self._state, _STATE)
        self.digest = _chained(self.digest, self._state.data)
        return None

    def poses(self) -> bytes:
        """The robots as `Frame.poses`."""
        poses: npt.NDArray[np.float32] = self.data.qpos[self._pose_qpos].astype("<f4")
        return poses.tobytes()

    def touched(self, gap_m: float = 0.0) -> Sequence[tuple[int, ...]]:
        """For each seat the markers whose probes it touches now, in ascending order.

        A probe is a geom that exerts no force. Touch is MuJoCo's own distance between geoms being
        at most 0; the order of the contact list plays no part.

        Args:
            gap_m: the largest distance that counts as a touch; below 0: only deeper ones count.
        """
        return self._touch(gap_m)

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

    def apart(self, saved: bytes) -> float:
        """Measure how far this state is from a saved one.

        Returns:
            The largest difference of a position [m] or an angle [rad], now or, by the difference
            of velocities and accelerations, within the next tick. Infinite if anything else
            differs: the time, the commanded angles, or what is always 0.
        """
        if len(saved) != 8 + self._state.nbytes:
            return math.inf
        gaps = np.abs(self._state - np.frombuffer(saved[8:]))
        if not np.isfinite(gaps).all() or (gaps[self._weights == 0] != 0).any():
            return math.inf
        return float((gaps * self._weights).max(initial=0.0))

    @staticmethod
    def follows(saved: bytes, digest: bytes) -> bool:
        """Say whether a saved state's digest is chained to that of the tick before it."""
        return _chained(digest, saved[8:]) == saved[:8]

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
        )

    def _put(self, robot: _Robot, place: Place) -> None:
        data, spec = self.data, robot.entry.robot
        at = robot.root_qpos
        data.qpos[at : at + 3] = place.x_m, place.y_m, spec.start_z_m
        half_yaw = (place.heading_rad - math.pi / 2) / 2  # the body's forward is its +y
        # Not NumPy's, which pick their code by processor in a way of their own.
        data.qpos[at + 3 : at + 7] = math.cos(half_yaw), 0, 0, math.sin(half_yaw)
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


class _TouchTest:
    """Which markers each robot touches.

    Args:
        model: the compiled model.
        data: its data.
        robots: the robots, seat by seat.
        probes: marker and geom of each probe; probes stand upright and never move.
    """

    def __init__(
        self,
        model: Any,
        data: Any,
        robots: Sequence[_Robot],
        probes: Sequence[tuple[int, int]],
    ) -> None:
        self._model, self._data = model, data
        self._probes = probes
        self._none: list[tuple[int, ...]] = [()] * len(robots)
        self._seats = [seat for seat, robot in enumerate(robots) for _ in robot.geoms]
        self._geoms = np.concatenate([robot.geoms for robot in robots] or [np.empty(0, np.intp)])
        geoms = [geom for _, geom in probes]
        mujoco.mj_kinematics(model, data)
        self._x_m, self._y_m = data.geom_xpos[geoms, 0], data.geom_xpos[geoms, 1]
        reach_m = model.geom_rbound[self._geoms, None] + model.geom_size[geoms, 0]
        self._reach_m, self._reach_m2 = reach_m, reach_m**2
        self._at = data.geom_xpos

    def __call__(self, gap_m: float) -> Sequence[tuple[int, ...]]:
        """For each seat the markers it touches, or that are this near, in ascending order."""
        if not (self._probes and self._seats):
            return self._none
        # After mj_step the geoms still stand where the last step began.
        mujoco.mj_kinematics(self._model, self._data)
        at = self._at[self._geoms]
        apart_m2 = (at[:, 0, None] - self._x_m) ** 2 + (at[:, 1, None] - self._y_m) ** 2
        close = apart_m2 <= (self._reach_m2 if gap_m <= 0 else (self._reach_m + gap_m) ** 2)
        if not close.any():
            return self._none
        touched: list[set[int]] = [set() for _ in self._none]
        for geom, probe in zip(*(places.tolist() for places in close.nonzero()), strict=True):
            marker, pole = self._probes[probe]
            distance_m = mujoco.mj_geomDistance(
                self._model, self._data, int(self._geoms[geom]), pole, _TOUCH_M + abs(gap_m), None
            )
            if distance_m <= gap_m:
                touched[self._seats[geom]].add(marker)
        return [tuple(sorted(markers)) for markers in touched]


def _chained(digest: bytes, state: bytes | memoryview) -> bytes:
    """Chain a state to the digest of the tick before it."""
    chain = hashlib.sha256(digest)
    chain.update(state)
    return chain.digest()[:8]


def _weights(model: Any) -> npt.NDArray[np.float64]:
    """What a difference of each number of the state makes of a position or angle in a tick.

    0: no arithmetic may change this number.
    """
    tick_s = SUBSTEPS * model.opt.timestep
    weight = {
        int(mujoco.mjtState.mjSTATE_QPOS): 1.0,
        int(mujoco.mjtState.mjSTATE_QVEL): tick_s,
        int(mujoco.mjtState.mjSTATE_WARMSTART): tick_s**2,
    }
    parts = [1 << bit for bit in range(_STATE.bit_length()) if _STATE & 1 << bit]
    return np.concatenate(
        [np.full(mujoco.mj_stateSize(model, part), weight.get(part, 0.0)) for part in parts]
    )


def _rgba(colour: str) -> tuple[float, float, float, float]:
    red, green, blue = (int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5))
    return red, green, blue, 1.0
