"""Train a policy that walks, with PPO of Stable-Baselines3, on one core; write it as a ZIP file.

    pip install ".[server,rl]" stable-baselines3
    python examples/train_walk.py --steps 200000 --seed 0

Stable-Baselines3 brings PyTorch. On a machine without a GPU, install the smaller PyTorch before:

    pip install torch --index-url https://download.pytorch.org/whl/cpu

Each 40,000 steps the program prints how far the policy walks in 20 s, without exploring, from
first postures that it has not trained with. It begins with the sample table, for comparison.
"""

import argparse
import statistics
import time
from collections.abc import Callable
from itertools import count
from pathlib import Path

import gymnasium
import numpy as np
import numpy.typing as npt
import torch
from stable_baselines3 import PPO
from stable_baselines3.common.env_util import make_vec_env
from stable_baselines3.common.vec_env import VecNormalize

from lacoc_robots.library import find_robot, sample_gait_files
from lacoc_server.match.entry import weigh_in
from lacoc_shared.messages import SentFile

Numbers = npt.NDArray[np.float32]

WALK = "lacoc:lacoc/Walk-v0"
BEATS = 5
"""Beats in a step: a joint moves by at most 12 degrees in it."""
ENVIRONMENTS = 4
EXAM = 100_000
"""Seed of the first posture of the test, far from those of the training."""
EPISODES = 5
"""Episodes of a test."""
REPORT = 40_000


def main() -> None:
    """Train, and print how far the policy walks."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--steps", type=int, default=200_000, help="steps of the training")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--out", type=Path, default=Path("walk.zip"), help="the policy")
    options = parser.parse_args()
    torch.set_num_threads(1)  # the network is small
    table = sample_table()
    print(f"sample table: {told(exam(lambda _, step: table[step // 3 % len(table)]))}", flush=True)
    rows = VecNormalize(make_vec_env(WALK, ENVIRONMENTS, env_kwargs={"beats": BEATS}))
    model = PPO(
        "MlpPolicy",
        rows,
        learning_rate=1e-3,
        n_steps=512,
        batch_size=128,
        # With the usual 1 each joint would be thrown from end to end of its range.
        policy_kwargs={"log_std_init": -1.0},
        seed=options.seed,
        device="cpu",
    )
    began = time.monotonic()
    while model.num_timesteps < options.steps:
        more = min(REPORT, options.steps - model.num_timesteps)
        model.learn(more, reset_num_timesteps=False)
        came = told(exam(lambda seen, _: chosen(model, rows, seen)))
        took_s = time.monotonic() - began
        print(f"{model.num_timesteps} steps, {took_s:.0f} s: {came}", flush=True)
    model.save(options.out)
    rows.save(str(options.out.with_suffix(".normalize")))
    print(f"{options.out} has the policy, and {options.out.stem}.normalize what it sees divided by")


def sample_table() -> Numbers:
    """Return the sample table of key 2 as actions: a row for each posture."""
    robot = weigh_in(SentFile(*find_robot("hexapod")), *sample_gait_files("hexapod"))
    assert robot.gait.locomotion is not None
    low, high = np.radians(np.array(robot.robot.ranges_deg)).T
    postures = np.array(robot.gait.locomotion.sequences[2])
    return ((2 * postures - low - high) / (high - low)).astype(np.float32)


def chosen(model: PPO, rows: VecNormalize, seen: Numbers) -> Numbers:
    """Return the action of the policy, without exploring."""
    action, _ = model.predict(rows.normalize_obs(seen), deterministic=True)
    return action


def exam(act: Callable[[Numbers, int], Numbers]) -> list[tuple[float, bool]]:
    """Return for each episode of a test how far the robot came [m], and whether it fell."""
    env = gymnasium.make(WALK, beats=BEATS)
    ahead = env.unwrapped.names.index("ahead_m")
    walks = []
    for episode in range(EPISODES):
        seen, _ = env.reset(seed=EXAM + episode)
        for step in count():
            seen, _, fell, cut, _ = env.step(act(seen, step))
            if fell or cut:
                break
        walks.append((float(seen[ahead]), fell))
    return walks


def told(walks: list[tuple[float, bool]]) -> str:
    """Say how far the robot came."""
    came = [metres for metres, _ in walks]
    falls = sum(fell for _, fell in walks)
    return (
        f"{statistics.mean(came):.2f} m in 20 s "
        f"({min(came):.2f} to {max(came):.2f}), {falls} of {len(walks)} falls"
    )


if __name__ == "__main__":
    main()
