"""The world: the robots of a match and their field in MuJoCo, stepped tick by tick."""

import hashlib
import math
import struct
from collections.abc import Sequence
from itertools import chain
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt

from lacoc_arenas.arena import Arena
from lacoc_arenas.game import Place
from lacoc_robots.model import add_robot, set_options
from lacoc_server.match.entry import Entry
from lacoc_server.match.physics import Fault
from lacoc_server.world.models import compile_models
from lacoc_server.world.nearness import Nearness
from lacoc_server.world.robot import Robot
from lacoc_server.world.scene import make_scene
from lacoc_server.world.touch import TouchTest
from lacoc_shared.codec import encode, message_hash
from lacoc_shared.gait.tables import Posture
from lacoc_shared.seat import NOBODY
from lacoc_shared.words import say

SUBSTEPS = 10
"""Physics steps in a tick: 10 steps of 2 ms make 20 ms."""

MUJOCO_VERSION = mujoco.mj_versionString()
"""MuJoCo's version; a replay is exact only with the same one."""

STATE = int(mujoco.mjtState.mjSTATE_INTEGRATION)
"""All state that the next step depends on; mjSTATE_FULLPHYSICS lacks some (docs/facts.md 1)."""

_FLOAT32 = np.dtype("<f4")

_WARNINGS = {
    mujoco.mjtWarning.mjWARN_BADQPOS: say("fault.position"),
    mujoco.mjtWarning.mjWARN_BADQVEL: say("fault.velocity"),
    mujoco.mjtWarning.mjWARN_BADQACC: say("fault.acceleration"),
    mujoco.mjtWarning.mjWARN_BADCTRL: say("fault.control"),
    mujoco.mjtWarning.mjWARN_CONTACTFULL: say("fault.contacts"),
    mujoco.mjtWarning.mjWARN_CNSTRFULL: say("fault.constraints"),
    mujoco.mjtWarning.mjWARN_INERTIA: say("fault.inertia"),
}


class World:
    """Robots on a field, stepped tick by tick; implements `match.physics.Physics`.

    The model is compiled when the world is made. MuJoCo steps a model without what only pictures
    show, and gets the same bits (`models`). The same state and angles give the same bits after a
    tick, on one version of MuJoCo and one kind of machine.

    Args:
        arena: the field and its game.
        entries: an entry for each seat; none for the empty field.
        first: seat of the first entry; a robot that tries its keys stands alone in its own seat.

    Raises:
        UserError: if pages can't draw the field (`scene.make_scene`).
    """

    def __init__(self, arena: Arena, entries: Sequence[Entry], first: int = 0) -> None:
        spec = mujoco.MjSpec()
        set_options(spec)
        arena.build_field(spec)
        seats = [seat.id for seat in arena.seats]
        for index, entry in enumerate(entries, first):
            add_robot(
                spec,
                entry.robot,
                prefix=f"{seats[index]}/",
                seat=index,
                seats=len(seats),
                rgba=_rgba(arena.seats[index].colour),
            )
        self._extend(spec)
        models = compile_models(spec, len(entries))
        self.whole = models.whole
        """The model with all that is drawn; its hash is `model_hash`."""
        self.model = models.stepped
        """The model that MuJoCo steps; its geoms have other ids than those of `whole`."""
        self.data = mujoco.MjData(self.model)
        self.scene = make_scene(self.whole, arena.game, seats)
        self.scene_hash = message_hash(encode(self.scene))
        buffer = np.empty(mujoco.mj_sizeModel(self.whole), np.uint8)
        mujoco.mj_saveModel(self.whole, None, buffer)
        self.model_hash = hashlib.blake2b(buffer.data, digest_size=8).hexdigest()
        self._made_of: tuple[Any, ...] = (arena, tuple(entries), first)
        """The arguments, for a copy."""
        self.digest = bytes(8)
        self.robots = _robots(self.model, entries, seats[first:])
        pose_qpos = [index for robot in self.robots for index in robot.pose_qpos]
        self._pose_qpos = np.array(pose_qpos, np.intp)
        # Views into MuJoCo's own arrays: they always show the present values.
        self._qpos: npt.NDArray[np.float64] = self.data.qpos
        self._control = self.data.ctrl
        self._write_control = struct.Struct(f"{self.model.nu}d").pack_into
        self._warned = self.data.warning.number
        self._no_warning = bytes(self._warned.nbytes)
        self._state = np.empty(mujoco.mj_stateSize(self.model, STATE))
        self._weights = _weights(self.model)
        for seat, robot in enumerate(self.robots):
            robot.put(self.data, arena.game.starts[first + seat][0])
        self._nearness = Nearness(models, self._qpos, self.robots)
        self._keep()
        self._touch: TouchTest | None = None
        self._untouched: list[tuple[int, ...]] = [()] * len(self.robots)
        if models.touching is not None and entries:
            robots = _robots(models.touching, entries, seats[first:])
            self._touch = TouchTest(models.touching, self._qpos, robots, arena.game.markers)

    # Physics

    def place(self, seat: int, place: Place) -> None:
        """Put a robot at a start place, in its start posture and with all velocities zero.

        `digest` changes only with the next tick.
        """
        self.robots[seat].put(self.data, place)
        self._keep()

    def step(self, angles: Sequence[Posture]) -> Fault | None:
        """Let one tick pass.

        Args:
            angles: for each seat the commanded angles [rad], by joint id.

        Returns:
            None if the tick passed. Else the fault, with the state as it was before the tick.
        """
        self._write_control(self._control, 0, *chain.from_iterable(angles))
        self._advance()
        if self._warned.tobytes() != self._no_warning:
            return self._undo()
        mujoco.mj_getState(self.model, self.data, self._state, STATE)
        self.digest = chained(self.digest, self._state.data)
        return None

    def poses(self) -> bytes:
        """Return the poses of the robots, in the form of `Frame.poses`."""
        return self._qpos[self._pose_qpos].astype(_FLOAT32).tobytes()

    def pose(self) -> npt.NDArray[np.float64]:
        """Return for all robots position [m], quaternion and joint angles [rad], one after another.

        These are the numbers of `poses`, but not rounded.
        """
        return self._qpos[self._pose_qpos]

    def velocity(self, seat: int) -> npt.NDArray[np.float64]:
        """Return the velocity of a robot's origin in the world frame [m/s]: (3,)."""
        first = self.robots[seat].root_dof
        velocity: npt.NDArray[np.float64] = self.data.qvel[first : first + 3].copy()
        return velocity

    def touched(self, gap_m: float = 0.0) -> Sequence[tuple[int, ...]]:
        """Return for each seat the indices of the markers that its robot touches, ascending.

        A marker's probe is a geom that exerts no force. A robot touches a marker if MuJoCo's
        distance between one of the robot's geoms and the probe is at most `gap_m`. MuJoCo's contact
        list is not used.

        Args:
            gap_m: the largest distance that counts as a touch; negative: only deeper touches count.
        """
        return self._untouched if self._touch is None else self._touch(gap_m)

    # Snapshots

    def save(self) -> bytes:
        """Return digest and state; a world of this model that loads them goes on bit for bit."""
        return self.digest + self._state.tobytes()

    def load(self, saved: bytes) -> None:
        """Continue from a saved state.

        Raises:
            ValueError: if the state has another length than this model's.
        """
        state = np.frombuffer(saved[8:])
        if state.size != self._state.size:
            raise ValueError(f"a state of {state.size} numbers; this model has {self._state.size}")
        self.digest = saved[:8]
        self._state[:] = state
        mujoco.mj_setState(self.model, self.data, self._state, STATE)

    def __reduce__(self) -> tuple[Any, ...]:
        """Let `copy` and `pickle` compile the world again and load its state.

        A copy field by field would keep views of this world's arrays in MuJoCo.
        """
        return type(self), self._made_of, self.save()

    def __setstate__(self, saved: bytes) -> None:
        self.load(saved)

    def apart(self, saved: bytes) -> float:
        """Measure how far this state is from a saved one.

        Returns:
            The largest difference of a position [m] or an angle [rad], either now or within the
            next tick because velocities or accelerations differ. Infinite if anything else differs,
            such as the time or the commanded angles, if the saved state has another length, or if a
            number is not finite.
        """
        if len(saved) != 8 + self._state.nbytes:
            return math.inf
        gaps = np.abs(self._state - np.frombuffer(saved[8:]))
        if not np.isfinite(gaps).all() or (gaps[self._weights == 0] != 0).any():
            return math.inf
        return float((gaps * self._weights).max(initial=0.0))

    @staticmethod
    def follows(saved: bytes, digest: bytes) -> bool:
        """Return whether a save's digest follows from its state and from the `digest` before it."""
        return chained(digest, saved[8:]) == saved[:8]

    # Private

    def _extend(self, spec: mujoco.MjSpec) -> None:
        """Let a subclass change the model before it is compiled; this class changes nothing."""

    def _advance(self) -> None:
        """Let the physics of one tick pass."""
        mujoco.mj_step(self._nearness.model(), self.data, nstep=SUBSTEPS)

    def _keep(self) -> None:
        mujoco.mj_getState(self.model, self.data, self._state, STATE)

    def _undo(self) -> Fault:
        """Restore the state before the tick, and return the fault that MuJoCo warned of.

        MuJoCo may have reset everything (docs/facts.md 3).
        """
        numbers = self.data.warning.number
        kind = int(np.flatnonzero(numbers)[0])
        where = int(self.data.warning[kind].lastinfo)
        why = _WARNINGS.get(mujoco.mjtWarning(kind), say("fault.other", number=kind))
        numbers[:] = 0
        mujoco.mj_setState(self.model, self.data, self._state, STATE)
        return Fault(self._seat_of(mujoco.mjtWarning(kind), where), why)

    def _seat_of(self, kind: mujoco.mjtWarning, where: int) -> int:
        """Return the index of the seat whose robot a warning is about; `NOBODY` if none is known.

        Args:
            kind: the warning.
            where: index that MuJoCo gives with it.
        """
        for seat, robot in enumerate(self.robots):
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


def chained(digest: bytes, state: bytes | memoryview) -> bytes:
    """Return the digest of a state, chained to the digest of the tick before it."""
    return hashlib.sha256(digest + state).digest()[:8]


def _robots(model: Any, entries: Sequence[Entry], seats: Sequence[str]) -> list[Robot]:
    """Find the robots in one of the world's models."""
    return [Robot.find(model, entry, seats[seat]) for seat, entry in enumerate(entries)]


def _weights(model: Any) -> npt.NDArray[np.float64]:
    """Return a weight for each number of the state: how far a change of 1 moves a robot in a tick.

    The weight is 0 for numbers that must be equal, whatever the machine's arithmetic is.
    """
    tick_s = SUBSTEPS * model.opt.timestep
    weight = {
        int(mujoco.mjtState.mjSTATE_QPOS): 1.0,
        int(mujoco.mjtState.mjSTATE_QVEL): tick_s,
        int(mujoco.mjtState.mjSTATE_WARMSTART): tick_s**2,
    }
    parts = [1 << bit for bit in range(STATE.bit_length()) if STATE & 1 << bit]
    return np.concatenate(
        [np.full(mujoco.mj_stateSize(model, part), weight.get(part, 0.0)) for part in parts]
    )


def _rgba(colour: str) -> tuple[float, float, float, float]:
    red, green, blue = (int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5))
    return red, green, blue, 1.0
