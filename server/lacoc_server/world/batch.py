"""Many worlds of one model, stepped at once on all cores; each gives the bits of a single world."""

from collections.abc import Sequence
from itertools import chain
from types import SimpleNamespace
from typing import Any

import mujoco
import numpy as np
from mujoco.batch import Batch

from lacoc_arenas.game import Place
from lacoc_server.match.physics import Fault
from lacoc_server.world.world import STATE, SUBSTEPS, World, chained
from lacoc_shared.gait.tables import Posture
from lacoc_shared.messages import Scene

_BOUND = ("qpos", "qvel", "ctrl", "qacc_warmstart")
"""Arrays of the state that a row reads or writes."""


class WorldBatch:
    """Worlds of models that differ at most in what can't be touched, such as painted lines.

    Args:
        world: a world of the model; it stays as it is.
        rows: number of worlds.
        threads: number of threads that step them; 0: one for each core.
    """

    def __init__(self, world: World, rows: int, threads: int = 0) -> None:
        self._batch = Batch(world.model, rows, threads)
        assert self._batch.nstate == mujoco.mj_stateSize(world.model, STATE)
        self._models = [world.model] * rows
        self.state = self._batch.state
        """(rows, numbers) the state of each world."""
        self._warned = self._batch.warning
        self._arrays = {name: self._batch.bind(name) for name in _BOUND}
        self._rows: dict[int, Row] = {}
        start = world.save()
        for index in range(rows):
            self.row(index, world, start)

    def row(self, index: int, world: World, saved: bytes) -> "Row":
        """Make a row for a world of the batch, in a saved state; from now on `step` uses this row.

        Args:
            index: index of the world in the batch.
            world: a single world of the row's model. The row tests touches in the single world and
                thereby changes its state. Several rows can share a single world.
            saved: the saved state (`World.save`).

        Raises:
            ValueError: if the saved state has another length than the states of the batch.
        """
        data = SimpleNamespace(**{name: array[index] for name, array in self._arrays.items()})
        row = Row(self, index, world, data)
        row.load(saved)
        return row

    def take(self, row: "Row") -> None:
        """Let `step` use a row from now on, in place of an earlier row with the same index."""
        if self._models[row.index] is not row.model:
            self._models[row.index] = row.model
            self._batch.set_models(self._models)
        self._rows[row.index] = row

    def step(self, rows: Sequence[int], angles: Sequence[Sequence[Posture]]) -> list[Fault | None]:
        """Let one tick pass in some of the worlds.

        Args:
            rows: indices of the worlds.
            angles: for each of them, and for each seat, the commanded angles [rad], by joint id.

        Returns:
            For each of them what `World.step` returns.
        """
        before = self.state[rows]
        for row, commanded in zip(rows, angles, strict=True):
            self._rows[row].command(commanded)
        self._batch.step(np.asarray(rows, np.int32), SUBSTEPS)
        return [
            self._after(self._rows[row], commanded, was)
            for row, commanded, was in zip(rows, angles, before, strict=True)
        ]

    def _after(self, row: "Row", commanded: Sequence[Posture], before: Any) -> Fault | None:
        if any(self._warned[row.index].tobytes()):
            # MuJoCo has reset this world. The single world does the tick again and says why.
            self._warned[row.index] = 0
            row.load(row.digest + before.tobytes())
            return row.repeat(commanded)
        row.digest = chained(row.digest, row.state.data)
        return None


class Row:
    """One world of a batch; implements `match.physics.Physics`.

    Args:
        batch: the batch.
        index: index of the world.
        world: a single world of the same model.
        data: its arrays, as attributes with the names that MuJoCo gives them.
    """

    def __init__(self, batch: WorldBatch, index: int, world: World, data: SimpleNamespace) -> None:
        self.index = index
        self.state = batch.state[index]
        self.digest = bytes(8)
        self._batch = batch
        self._data = data
        self._single = world

    @property
    def model(self) -> Any:
        """The compiled model."""
        return self._single.model

    @property
    def scene(self) -> Scene:
        """The model for drawing."""
        return self._single.scene

    @property
    def scene_hash(self) -> bytes:
        """Hash of the scene, 8 bytes."""
        return self._single.scene_hash

    @property
    def model_hash(self) -> str:
        """Hash of the compiled model, hexadecimal."""
        return self._single.model_hash

    def command(self, angles: Sequence[Posture]) -> None:
        """Write the commanded angles [rad] of each seat, for the next tick."""
        self._data.ctrl[:] = list(chain.from_iterable(angles))

    def place(self, seat: int, place: Place) -> None:
        """Put a robot at a start place; see `World.place`."""
        self._single.robots[seat].put(self._data, place)

    def step(self, angles: Sequence[Posture]) -> Fault | None:
        """Let one tick pass in this world alone; see `World.step`."""
        return self._batch.step([self.index], [angles])[0]

    def repeat(self, angles: Sequence[Posture]) -> Fault | None:
        """Do the row's next tick in the single world instead; return the fault of this tick."""
        self._single.load(self.save())
        return self._single.step(angles)

    def save(self) -> bytes:
        """Return digest and state, as `World.save`."""
        state: bytes = self.state.tobytes()
        return self.digest + state

    def load(self, saved: bytes) -> None:
        """Go on from a saved state; see `World.load`."""
        state = np.frombuffer(saved[8:])
        if state.size != self.state.size:
            raise ValueError(f"a state of {state.size} numbers; this model has {self.state.size}")
        self._batch.take(self)
        self.digest = saved[:8]
        self.state[:] = state

    def poses(self) -> bytes:
        """Return the poses of the robots, in the form of `Frame.poses`."""
        return self._single.poses_of(self._data.qpos)

    def touched(self) -> Sequence[tuple[int, ...]]:
        """Return for each seat the markers that its robot touches; see `World.touched`."""
        return self._single.touched_in(self.state)
