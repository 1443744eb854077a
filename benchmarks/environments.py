"""What environments cost: a step against bare physics, rows on two cores, loads, proven records.

python -m benchmarks.environments steps      # a step against mj_step along the same path
python -m benchmarks.environments rows       # rows on two cores against one
python -m benchmarks.environments loads      # episodes that go on from a save, equal to the end
python -m benchmarks.environments records    # random episodes written as records and proven
"""

import argparse
import os
import statistics
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from lacoc_server.journal.replay import verify
from lacoc_server.journal.verdict import Kind, Verdict
from lacoc_server.simulate.environments import LacocParallelEnv, LacocVectorEnv
from lacoc_server.world.world import SUBSTEPS
from lacoc_shared.record.reader import Record

GAMES = ("othello", "flag-strike")
_BLOCK = 100
"""Steps of a block; environment and bare physics take turns block by block."""


def main() -> None:
    """Run one benchmark and print its figures."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=_Raw)
    parser.add_argument("what", choices=list(_ALL))
    parser.add_argument("--count", type=int, help="rounds, forks or episodes")
    options = parser.parse_args()
    run, count = _ALL[options.what]
    for game in GAMES:
        print(game, run(game, options.count or count), flush=True)


def steps(game: str, rounds: int) -> dict[str, Any]:
    """Time steps against `mj_step` alone, which takes the same path with the same controls."""
    env = LacocParallelEnv(game)
    env.reset(seed=1)
    chance = np.random.default_rng(1)
    world: Any = env._episode.match.physics
    bare = mujoco.MjData(world.model)
    ratios, step_us, bare_us = [], [], []
    clock = time.thread_time  # a busy machine stops the thread, but that does not count
    key = {"left": 2, "right": 2}
    for _ in range(rounds):
        if not env.agents:
            env.reset()
            world = env._episode.match.physics
            bare = mujoco.MjData(world.model)
        state = np.frombuffer(world.save()[8:]).copy()
        controls = []
        took_s = 0.0
        for number in range(_BLOCK):
            if number % 25 == 0:
                key = {agent: int(chance.integers(1, 4)) for agent in env.possible_agents}
            begin = clock()
            env.step(key)
            took_s += clock() - begin
            controls.append(world.data.ctrl.copy())
        mujoco.mj_setState(world.model, bare, state, int(mujoco.mjtState.mjSTATE_INTEGRATION))
        alone_s = 0.0
        for control in controls:
            bare.ctrl[:] = control
            begin = clock()
            mujoco.mj_step(world.model, bare, nstep=SUBSTEPS)
            alone_s += clock() - begin
        if env.agents:
            assert (bare.qpos == world.data.qpos).all(), "bare physics took another path"
        ratios.append(took_s / alone_s)
        step_us.append(took_s / _BLOCK * 1e6)
        bare_us.append(alone_s / _BLOCK * 1e6)
    return {
        "ratio": round(statistics.median(ratios), 3),
        "step_us": round(min(step_us), 1),
        "bare_us": round(min(bare_us), 1),
    }


def rows(game: str, rounds: int) -> dict[str, Any]:
    """Time the steps of 16 environments on one core and on two, in turns."""
    cores = sorted(os.sched_getaffinity(0))
    if len(cores) < 2:
        return {"cores": len(cores)}
    rates: dict[int, list[float]] = {1: [], 2: []}
    environments = {}
    for used in (1, 2):
        many = LacocVectorEnv(16, game, threads=used)
        many.reset(seed=1)
        environments[used] = many
    for _ in range(rounds):
        for used, many in environments.items():
            for task in os.listdir("/proc/self/task"):
                os.sched_setaffinity(int(task), cores[:used])
            begin = time.perf_counter()
            for _ in range(_BLOCK):
                many.step(np.full(16, 2))
            rates[used].append(16 * _BLOCK / (time.perf_counter() - begin))
    ratios = [two / one for one, two in zip(rates[1], rates[2], strict=True)]
    return {
        "ratio": round(statistics.median(ratios), 2),
        "best": round(max(rates[2]) / max(rates[1]), 2),
        "steps_per_s": {used: round(max(found)) for used, found in rates.items()},
    }


def loads(game: str, forks: int) -> dict[str, Any]:
    """Save at random moments, load and go on to the end several times; count ends that differ."""
    env = LacocParallelEnv(game, settings={"match": {"duration_s": 4.0}})
    chance = np.random.default_rng(2)
    load_ms, save_ms, differ, done = [], [], 0, 0
    while done < forks:
        env.reset(seed=done)
        _play(env, chance, int(chance.integers(0, 195)))
        begin = time.perf_counter()
        saved = env.save()
        save_ms.append(1000 * (time.perf_counter() - begin))
        ends = []
        for _ in range(min(6, forks - done) + 1):
            begin = time.perf_counter()
            env.load(saved)
            load_ms.append(1000 * (time.perf_counter() - begin))
            _play(env, np.random.default_rng(done), 10_000)
            ends.append(env.save())
        differ += sum(end != ends[0] for end in ends[1:])
        done += len(ends) - 1
    return {
        "forks": done,
        "differ": differ,
        "load_p50_ms": round(statistics.median(load_ms), 3),
        "save_p50_ms": round(statistics.median(save_ms), 3),
        "bytes": len(saved),
    }


def records(game: str, episodes: int) -> dict[str, Any]:
    """Write random episodes as records, and prove each of them."""
    env = LacocParallelEnv(game, settings={"match": {"duration_s": 1.0}}, restart=True)
    chance = np.random.default_rng(3)
    kinds: dict[str, int] = {}
    with tempfile.TemporaryDirectory() as folder:
        for number in range(episodes):
            env.reset(seed=number)
            _play(env, chance, 10_000)
            file = Path(folder) / f"episode-{number}.mcap"
            env.write_record(file)
            *_, verdict = verify(Record.read(file), processes=1)
            assert isinstance(verdict, Verdict)
            kinds[verdict.kind.name] = kinds.get(verdict.kind.name, 0) + 1
            file.unlink()
    return {"episodes": episodes, **kinds, "all proven": kinds == {Kind.SAME.name: episodes}}


def _play(env: LacocParallelEnv, chance: np.random.Generator, most: int) -> None:
    """Play with random actions, to the end or for some steps."""
    for _ in range(most):
        if not env.agents:
            return
        env.step({one: int(chance.integers(env.action_space(one).n)) for one in env.agents})


class _Raw(argparse.RawDescriptionHelpFormatter):
    pass


_ALL: dict[str, tuple[Callable[[str, int], dict[str, Any]], int]] = {
    "steps": (steps, 60),
    "rows": (rows, 10),
    "loads": (loads, 10_000),
    "records": (records, 500),
}

if __name__ == "__main__":
    main()
