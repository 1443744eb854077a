"""Measures how fast environments step, on one core and on two, and tests their saves and records.

python -m benchmarks.environments steps      # a step against mj_step along the same path
python -m benchmarks.environments rows       # rows on two cores against one, and bare physics
python -m benchmarks.environments loads      # episodes that go on from a save, equal to the end
python -m benchmarks.environments records    # random episodes written as records and proven
"""

import os
import statistics
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from arguments import arguments
from bot_matches import ARENAS
from verdicts import verdict

from benchmarks.figures import finish
from lacoc_server.journal.verdict import VerdictKind
from lacoc_server.simulate.environments import LacocParallelEnv, LacocVectorEnv
from lacoc_server.world.world import STATE, SUBSTEPS
from lacoc_shared.record.reader import Record

BEATS = (1, 10, 50)
"""Beats in a step."""
_BLOCK = 200
"""Beats of a block; environment and bare physics take turns block by block."""
_KEPT = 50
"""Beats for which a key is held at least."""


def main() -> None:
    """Run one benchmark and print its figures."""
    options = arguments(__doc__, _ALL, count=(int, "rounds, forks or episodes"))
    run, count = _ALL[options.what]
    finish({game: run(game, options.count or count) for game in ARENAS})


def steps(game: str, rounds: int) -> dict[str, Any]:
    """Time steps of some beats against `mj_step` alone, along the same path."""
    return {f"{beats} beats": _steps(game, rounds, beats) for beats in BEATS}


def _steps(game: str, rounds: int, beats: int) -> dict[str, float]:
    """Return how many times as long as bare physics a step takes: the median of some rounds.

    Bare physics is `mj_step`, of two models: of the whole model, whose hash is in records, and of
    the smaller model that worlds step.
    """
    env = LacocParallelEnv(game, beats=beats)
    env.reset(seed=1)
    chance = np.random.default_rng(1)
    ratios: dict[str, list[float]] = {"whole": [], "stepped": []}
    clock = time.thread_time  # a busy machine stops the thread, but that does not count
    while len(ratios["whole"]) < rounds:
        saved = env.save()
        actions = [
            {agent: int(key) for agent, key in zip(env.possible_agents, keys, strict=True)}
            for keys in chance.integers(1, 4, (_BLOCK // _KEPT, 2))
            for _ in range(_KEPT // min(beats, _KEPT))
        ]
        took_s = 0.0
        for action in actions:
            begin = clock()
            env.step(action)
            took_s += clock() - begin
        if not env.agents:
            env.reset()
            continue
        after = env.save()
        env.load(saved)
        for model, bare_s in _bare_s(env, actions).items():
            ratios[model].append(took_s / bare_s)
        assert env.save() == after
    return {model: round(statistics.median(found), 3) for model, found in ratios.items()}


def _bare_s(env: LacocParallelEnv, actions: list[dict[str, int]]) -> dict[str, float]:
    """Take some steps, then time bare physics along their path [s]; it must end in the same bits.

    After this the environment has taken these steps.
    """
    world: Any = env._episode.match.physics
    state = np.frombuffer(world.save()[8:]).copy()
    advance, controls = world._advance, []

    def noting() -> None:
        controls.append(world.data.ctrl.copy())
        advance()

    world._advance = noting
    for action in actions:
        env.step(action)
    del world._advance
    took_s = {}
    for name, model in (("whole", world.whole), ("stepped", world.model)):
        bare = mujoco.MjData(model)
        mujoco.mj_setState(model, bare, state, STATE)
        alone_s = 0.0
        for control in controls:
            bare.ctrl[:] = control
            begin = time.thread_time()
            mujoco.mj_step(model, bare, nstep=SUBSTEPS)
            alone_s += time.thread_time() - begin
        assert (bare.qpos == world.data.qpos).all(), "bare physics took another path"
        took_s[name] = alone_s
    return took_s


def rows(game: str, rounds: int) -> dict[str, Any]:
    """Time the steps of 16 environments on one core and on two, in turns, and bare physics too."""
    cores = sorted(os.sched_getaffinity(0))
    if len(cores) < 2:
        return {"cores": len(cores)}
    environments = {}
    for used in (1, 2):
        many = LacocVectorEnv(16, game, threads=used)
        many.reset(seed=1)
        environments[used] = many
    ratios: list[float] = []
    bare: list[float] = []
    with ThreadPoolExecutor(2) as threads:
        for _ in range(rounds):
            rates, bare_rates = {}, {}
            for used, many in environments.items():
                for task in os.listdir("/proc/self/task"):
                    os.sched_setaffinity(int(task), cores[:used])
                begin = time.perf_counter()
                for _ in range(_BLOCK):
                    many.step(np.full(16, 2))
                rates[used] = 16 * _BLOCK / (time.perf_counter() - begin)
                worlds = [row.episode.match.physics for row in many.rows[:used]]
                begin = time.perf_counter()
                list(threads.map(_physics_alone, worlds))
                bare_rates[used] = used / (time.perf_counter() - begin)
            ratios.append(rates[2] / rates[1])
            bare.append(bare_rates[2] / bare_rates[1])
    return {
        "ratio": round(statistics.median(ratios), 2),
        "best": round(max(ratios), 2),
        "bare_ratio": round(statistics.median(bare), 2),
    }


def _physics_alone(world: Any) -> None:
    """Step a copy of a world's state through ten blocks of ticks, in MuJoCo alone."""
    data = mujoco.MjData(world.model)
    mujoco.mj_copyData(data, world.model, world.data)
    for _ in range(10 * _BLOCK):
        mujoco.mj_step(world.model, data, nstep=SUBSTEPS)


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
    kinds: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as folder:
        for number in range(episodes):
            env.reset(seed=number)
            _play(env, chance, 10_000)
            file = Path(folder) / f"episode-{number}.mcap"
            env.write_record(file)
            kinds[verdict(Record.read(file), processes=1).kind.name] += 1
            file.unlink()
    return {"episodes": episodes, **kinds, "all proven": kinds == {VerdictKind.SAME.name: episodes}}


def _play(env: LacocParallelEnv, chance: np.random.Generator, most: int) -> None:
    """Play with random actions, to the end or for some steps."""
    for _ in range(most):
        if not env.agents:
            return
        env.step({one: int(chance.integers(env.action_space(one).n)) for one in env.agents})


_ALL: dict[str, tuple[Callable[[str, int], dict[str, Any]], int]] = {
    "steps": (steps, 60),
    "rows": (rows, 10),
    "loads": (loads, 10_000),
    "records": (records, 500),
}

if __name__ == "__main__":
    main()
