"""Train a bot for Robot-Othello against the bot straight, without a GPU, and write its file.

    pip install "lacoc[server,rl]"
    python examples/train_othello.py --minutes 30
    lacoc simulate my_bot.py straight --both-sides

The policy sees where its robot is and where it looks, and chooses every two seconds between turning
left, walking and turning right: 4 numbers in, 4 hidden ones, 3 keys out. CMA-ES changes its 35
numbers; the best ones are those with which it leads by the most points at the end.
"""

import argparse
import multiprocessing
import statistics
import time
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import cache
from pathlib import Path

import numpy as np
from cmaes import CMA

from lacoc_arenas.learned.network import Layer, Network, export
from lacoc_server.simulate.environments import LacocEnv

SEES = ("own x_m", "own y_m", "own forward_x", "own forward_y")
KEYS = (1, 2, 3)  # turn left, walk, turn right
HIDDEN = 4
BEATS = 100  # two seconds: about as long as a sequence of the sample gait
NUMBERS = HIDDEN * (len(SEES) + 1) + len(KEYS) * (HIDDEN + 1)


@cache
def environment(seconds: float) -> LacocEnv:
    """Return this process's environment."""
    return LacocEnv("othello", "straight", settings={"match": {"duration_s": seconds}}, beats=BEATS)


def network(numbers: Sequence[float], names: Sequence[str]) -> Network:
    """Make a policy of its numbers.

    Args:
        numbers: (NUMBERS,) weights and biases.
        names: what each number is that the policy sees.
    """
    rest = np.asarray(numbers)
    first = np.zeros((HIDDEN, len(names)))
    size = HIDDEN * len(SEES)
    first[:, [names.index(name) for name in SEES]] = rest[:size].reshape(HIDDEN, len(SEES))
    rest = rest[size:]
    biases, rest = rest[:HIDDEN], rest[HIDDEN:]
    size = len(KEYS) * HIDDEN
    last = Layer(rest[:size].reshape(len(KEYS), HIDDEN), rest[size:])
    return Network([Layer(first, biases), last], KEYS, every_ticks=BEATS)


def pair(job: tuple[Sequence[float], int, float]) -> int:
    """Play an opening twice, once in each seat; return by how many points the policy leads in all.

    Args:
        job: the policy's numbers, the seed of the opening, and the length of a match [s].
    """
    numbers, seed, seconds = job
    env = environment(seconds)
    policy = network(numbers, env.names)
    leads = 0
    for seat in ("left", "right"):
        seen, _ = env.reset(seed=seed, options={"seat": seat})
        over = False
        while not over:
            digit = KEYS[policy.choose(seen)]
            action = env.digits.index(digit)
            seen, _, ended, stopped, info = env.step(action)
            over = ended or stopped
        own = env.seat
        leads += info["scores"][own] - info["scores"][1 - own]
    return int(leads)


def main() -> None:
    """Train until the time is over, write the best policy, and play it against straight."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=_Raw)
    options.add_argument("--minutes", type=float, default=30, help="how long it trains")
    options.add_argument("--jobs", type=int, default=2, help="number of processes")
    options.add_argument("--seconds", type=float, default=60, help="length of a match")
    options.add_argument(
        "--pairs",
        type=int,
        default=100,
        help="pairs of matches, one in each seat, that test the best policy at the end",
    )
    options.add_argument("--population", type=int, default=16, help="policies of a generation")
    options.add_argument("--goal", type=float, default=None, help="stop early at this mean lead")
    options.add_argument("--out", type=Path, default=Path("my_bot.py"), help="the bot file")
    told = options.parse_args()
    until = time.monotonic() + 60 * told.minutes
    search = CMA(mean=np.zeros(NUMBERS), sigma=1.5, seed=1, population_size=told.population)
    best: tuple[float, np.ndarray] = (-np.inf, np.zeros(NUMBERS))
    with ProcessPoolExecutor(told.jobs, multiprocessing.get_context("spawn")) as pool:
        generation = 0
        while time.monotonic() < until and (told.goal is None or best[0] < told.goal):
            asked = [search.ask() for _ in range(search.population_size)]
            leads = list(pool.map(pair, [(one, generation, told.seconds) for one in asked]))
            search.tell([(one, -float(lead)) for one, lead in zip(asked, leads, strict=True)])
            # One opening says little: the best policy is tried on others too.
            found = asked[int(np.argmax(leads))]
            tried = [(found, 1000 + seed, told.seconds) for seed in range(3)]
            lead = statistics.mean(pool.map(pair, tried))
            if lead > best[0]:
                best = (lead, found)
                names = environment(told.seconds).names
                told.out.write_text(export(network(best[1], names)), encoding="utf-8")
            left_s = max(0.0, until - time.monotonic())
            told_now = f"best {max(leads):3}, on other openings {lead:5.1f}"
            print(f"{generation:3} {told_now}, {left_s:.0f} s left", flush=True)
            generation += 1
        exam = [(best[1], 5000 + seed, told.seconds) for seed in range(told.pairs)]
        won = sum(lead > 0 for lead in pool.map(pair, exam))
    print(f"{told.out} won {won} of {told.pairs} mirrored pairs against straight")


class _Raw(argparse.RawDescriptionHelpFormatter):
    pass


if __name__ == "__main__":
    main()
