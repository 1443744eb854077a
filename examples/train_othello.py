"""Train a bot for Robot-Othello against the bot straight, without a GPU, and write its file.

    pip install "lacoc[server,rl]"
    python examples/train_othello.py --minutes 30
    lacoc simulate my_bot.py straight --both-sides

The policy sees where its robot is and where it looks, and chooses every two seconds between turning
left, walking and turning right: 4 numbers in, 6 hidden ones, 3 keys out. It is symmetric: seen in a
mirror it turns the other way. So 26 numbers are all that is sought. CMA-ES changes them, and keeps
those with which the policy leads by more at the end.
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
MIRROR = np.array([1.0, -1.0, 1.0, -1.0])  # what a mirror along the field makes of SEES
PAIRS = 3  # of hidden numbers; the second of a pair is the first one in the mirror
BEATS = 100  # two seconds: about as long as a sequence of the sample gait
NUMBERS = PAIRS * (len(SEES) + 1) + 3 * PAIRS + 2


@cache
def environment(seconds: float) -> LacocEnv:
    """Return this process's environment."""
    return LacocEnv("othello", "straight", settings={"match": {"duration_s": seconds}}, beats=BEATS)


def network(numbers: Sequence[float], names: Sequence[str]) -> Network:
    """Make a policy from its numbers.

    Args:
        numbers: (NUMBERS,) weights and biases.
        names: the meaning of each number that the policy sees.
    """
    hidden, out, biases = np.split(np.asarray(numbers), [5 * PAIRS, 8 * PAIRS])
    weights = hidden.reshape(PAIRS, len(SEES) + 1)
    first = np.zeros((2 * PAIRS, len(names)))
    columns = [names.index(name) for name in SEES]
    first[:, columns] = np.concatenate([weights[:, :-1], weights[:, :-1] * MIRROR])
    near, far, ahead = out.reshape(3, PAIRS)
    last = np.array([[*near, *far], [*ahead, *ahead], [*far, *near]])
    turn, walk = biases
    return Network(
        [
            Layer(first, np.concatenate([weights[:, -1]] * 2)),
            Layer(last, np.array([turn, walk, turn])),
        ],
        KEYS,
        every_ticks=BEATS,
    )


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
            # One opening says little: the middle of the search is tried on others too.
            tried = [(search.mean, 1000 + one, told.seconds) for one in range(4)]
            lead = statistics.mean(pool.map(pair, tried))
            if lead > best[0]:
                best = (lead, search.mean)
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
