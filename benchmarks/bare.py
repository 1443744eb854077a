"""Matches to measure, and the same movements in MuJoCo alone, without a court."""

import time
from collections.abc import Sequence
from pathlib import Path

import mujoco
import numpy as np
import numpy.typing as npt
from bot_matches import setup_of

from lacoc_robots.library import find_robot, sample_gait_files
from lacoc_server.journal.journal import Journal
from lacoc_server.match.match import Match
from lacoc_server.world.world import STATE, SUBSTEPS, World
from lacoc_shared.decisions import Start
from lacoc_shared.inputs import Decide, Input, JoinSeat, KeySeat, ReadySeat
from lacoc_shared.messages import SentFile
from lacoc_shared.seat import Phase

KEYS = (2, 2, 1, 2, 3, 2)
"""The keys of both robots, a new one every `KEY_TICKS`: the robots walk, turn and meet."""
KEY_TICKS = 97


def started(arena: str, folder: Path | None) -> Journal:
    """Start a match of two sample hexapods; return its journal when play begins."""
    match = Match(setup_of(arena), World)
    journal = Journal(match, folder)
    files = (SentFile(*find_robot("hexapod")), *sample_gait_files("hexapod"))
    seats = range(len(match.seats))
    journal.beat([JoinSeat(seat, f"Team {seat}", *files, token_hash="") for seat in seats])
    journal.beat([ReadySeat(seat, True) for seat in seats])
    journal.beat([Decide("benchmark", "", Start())])
    while match.phase is not Phase.PLAYING:
        journal.beat()
    return journal


def keys_at(tick: int) -> list[Input]:
    """Return the keys that both seats press in a tick."""
    if tick % KEY_TICKS:
        return []
    number = tick // KEY_TICKS
    return [KeySeat(seat, number + 1, 1, KEYS[number % len(KEYS)]) for seat in (0, 1)]


class BarePath:
    """The whole model of a match, stepped by MuJoCo alone with the controls of the match."""

    def __init__(self, world: World) -> None:
        self._model = world.whole
        self._data = mujoco.MjData(self._model)
        state = np.frombuffer(world.save()[8:])
        mujoco.mj_setState(self._model, self._data, state, STATE)

    def run(self, controls: Sequence[npt.NDArray[np.float64]]) -> float:
        """Step one tick for each control; return the time that this took [s]."""
        model, data = self._model, self._data
        begin = time.perf_counter()
        for control in controls:
            data.ctrl[:] = control
            mujoco.mj_step(model, data, nstep=SUBSTEPS)
        return time.perf_counter() - begin

    def is_where(self, world: World) -> bool:
        """Return whether positions and velocities are exactly as in the match's world."""
        return bool(
            np.array_equal(self._data.qpos, world.data.qpos)
            and np.array_equal(self._data.qvel, world.data.qvel)
        )
