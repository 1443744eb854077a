"""Train a bot for Robot-Othello that learns to imitate a rule, without a GPU; write its file.

    pip install ".[server,rl]"
    python examples/train_othello.py --minutes 30
    lacoc simulate learned_bot.py straight --both-sides

The teacher is a rule of a few lines (`teach`): go to the nearest disc that can be flipped. The
learner is a network. It sees the places of both robots and all discs, and chooses between turning
left, walking and turning right each time a sequence of the sample gait ends. It plays matches
against `straight`, and learns what the teacher would do where it came to. So it also learns to mend
its own mistakes (dataset aggregation: Ross, Gordon and Bagnell, 2011).

A match takes seconds and a question to the teacher microseconds. So each place that the learner
came to gives many examples: seen in a mirror, on a turned board, and with the robot moved a little.
"""

import argparse
import multiprocessing
import statistics
import time
from collections.abc import Iterator
from concurrent.futures import Executor, ProcessPoolExecutor
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from lacoc_arenas.learned.network import Layer, Network, export
from lacoc_server.simulate.environments import LacocEnv

Seen = npt.NDArray[np.float32]
"""(rows, 8 + discs): for the own and the other robot x_m, y_m, forward_x, forward_y; the discs."""

KEYS = (1, 2, 3)
LEFT, WALK, RIGHT = range(3)
"""What the learner chooses between: indices of `KEYS`."""
BEATS = 72
"""Beats in a step: one sequence of the sample gait. A turn that is cut off turns the wrong way."""
SEATS = ("left", "right")
EXAM = 100_000
"""Seed of the first opening of the test, far from those of the training."""
PLACES = tuple(
    f"{whose} {name}"
    for whose in ("own", "other")
    for name in ("x_m", "y_m", "forward_x", "forward_y")
)
SCALE = (12.0, 12.0, 2.5, 2.5, 2.0, 2.0, 1.0, 1.0)
"""The numbers of `PLACES` are multiplied by these, as the own place must be known most exactly."""
COURAGE = 1.0
"""Added to the output for walking: a robot that turns left and right in doubt comes nowhere."""

DISC_M = 0.12
BESIDE_M = 0.35
"""A disc's eight neighbours are nearer than this in x and y. The teacher avoids discs that are so
near to the other robot."""
PASS_M = 0.42
AHEAD_RAD, PASS_RAD = np.radians(40), np.radians(75)
STRAY_RAD, NEAR_STRAY_RAD = np.radians(16), np.radians(45)
"""At smaller bearings the robot walks. The first is half of what one sequence turns; the second is
for discs nearer than `NEAR_M`."""
NEAR_M = 0.10

TURN, MIRROR = np.array([[0, -1], [1, 0]]), np.array([[1, 0], [0, -1]])
IMAGES = np.array(
    [
        np.linalg.matrix_power(TURN, turns) @ side
        for side in (np.eye(2), MIRROR)
        for turns in range(4)
    ],
    np.float32,
)
"""(8, 2, 2): the ways to turn and mirror the board so that it looks the same."""


@cache
def environment() -> LacocEnv:
    """Return this process's environment."""
    return LacocEnv("othello", "straight", beats=BEATS)


@cache
def discs_m() -> Seen:
    """Return the places of the discs on the floor: (discs, 2) [m]."""
    markers = environment().episode.match.sheet().markers
    return np.array([(disc.x_m, disc.y_m) for disc in markers], np.float32)


@cache
def columns() -> list[int]:
    """Return the indices of the numbers of `Seen` in the observation of an environment."""
    names = environment().names
    return [*map(names.index, PLACES), *range(len(names) - len(discs_m()), len(names))]


def teach(seen: Seen) -> npt.NDArray[np.int64]:
    """Return for each row what the teacher would do there.

    The teacher goes to the nearest disc that is not its own and has an own disc beside it. If it
    stands on a disc that is not its own, it first goes to an own disc.
    """
    place, look, other, own = seen[:, :2], seen[:, 2:4], seen[:, 4:6], seen[:, 8:] > 0.9
    gaps = np.abs(discs_m()[:, None] - discs_m()).max(2)
    beside = ((gaps > 0) & (gaps < BESIDE_M)).astype(np.float32)
    away_m = np.linalg.norm(discs_m() - place[:, None], axis=2)
    flips = ~own & (own @ beside > 0)
    starts = own & (~own @ beside > 0)
    lost = ((away_m < DISC_M) & ~own).any(1, keepdims=True)
    free = np.linalg.norm(discs_m() - other[:, None], axis=2) > BESIDE_M
    useful = np.where(lost, starts, flips) & free
    useful = np.where(useful.any(1, keepdims=True), useful, flips)
    target = discs_m()[np.where(useful, away_m, np.inf).argmin(1)] - place

    bearing, barred = _bearing(look, target), _bearing(look, other - place)
    in_way = np.linalg.norm(other - place, axis=1) < PASS_M
    in_way &= np.abs(_wrap(bearing - barred)) < AHEAD_RAD
    bearing = np.where(in_way, _wrap(barred + PASS_RAD), bearing)
    near = np.linalg.norm(target, axis=1) < NEAR_M
    walks = np.abs(bearing) < np.where(near, NEAR_STRAY_RAD, STRAY_RAD)
    return np.where(walks | ~useful.any(1), WALK, np.where(bearing > 0, LEFT, RIGHT))


def _bearing(look: Seen, way: Seen) -> Seen:
    """Return the angles by which to turn left to look along a way [rad]."""
    ahead = (look * way).sum(1)
    angles: Seen = np.arctan2(look[:, 0] * way[:, 1] - look[:, 1] * way[:, 0], ahead)
    return angles


def _wrap(angle: Seen) -> Seen:
    wrapped: Seen = np.remainder(angle + np.pi, 2 * np.pi) - np.pi
    return wrapped


class Task(NamedTuple):
    """A match that is to be played."""

    seed: int
    seat: str
    learner: Network | None
    """None: the teacher itself plays."""


class Match(NamedTuple):
    """A match that was played."""

    lead: int
    """By how many points the policy was ahead of straight at the end."""
    seen: Seen


def play(task: Task) -> Match:
    """Play a match against straight."""
    env, seen, over = environment(), [], False
    numbers, _ = env.reset(seed=task.seed, options={"seat": task.seat})
    while not over:
        seen.append(numbers[columns()])
        choice = task.learner.choose(numbers) if task.learner else int(teach(seen[-1][None])[0])
        numbers, _, ended, stopped, info = env.step(env.digits.index(KEYS[choice]))
        over = ended or stopped
    return Match(info["scores"][env.seat] - info["scores"][1 - env.seat], np.array(seen))


class Learner:
    """A network with two hidden layers that learns by Adam.

    Args:
        hidden: numbers in each hidden layer.
        seed: seed of the first weights, and of the examples that are drawn by chance.
    """

    def __init__(self, hidden: tuple[int, int], seed: int) -> None:
        self._chance = np.random.default_rng(seed)
        xy = discs_m()
        # The disc that comes to a place by an image was where the place comes from.
        self._moved = np.array(
            [[int(np.abs(xy - at).sum(1).argmin()) for at in xy @ image] for image in IMAGES]
        )
        self._scale = np.array([*SCALE, *np.ones(len(xy))], np.float32)
        sizes = (len(self._scale), *hidden, len(KEYS))
        self._parts: list[Seen] = []
        """Weights and biases of each layer in turn."""
        for inputs, outputs in pairwise(sizes):
            weights = self._chance.normal(0, inputs**-0.5, (outputs, inputs))
            self._parts += [weights.astype(np.float32), np.zeros(outputs, np.float32)]
        self._means = [np.zeros_like(part) for part in self._parts]
        self._squares = [np.zeros_like(part) for part in self._parts]
        self._steps = 0

    def network(self) -> Network:
        """Return the policy; its input is the whole observation of an environment."""
        parts = [part.astype(np.float64) for part in self._parts]
        weights, biases = parts[::2], parts[1::2]
        first = np.zeros((len(weights[0]), len(environment().names)))
        first[:, columns()] = weights[0] * self._scale
        weights[0] = first
        biases[-1][WALK] += COURAGE
        layers = [Layer(*one) for one in zip(weights, biases, strict=True)]
        return Network(layers, KEYS, BEATS)

    def learn(self, seen: Seen, rate: float, examples: int = 20_000) -> float:
        """Make examples of what was seen and learn from them; return the share of right answers."""
        asked = self._imagine(seen[self._chance.integers(len(seen), size=examples)])
        said, right = teach(asked), 0
        asked *= self._scale
        for start in range(0, examples, 500):
            some = slice(start, start + 500)
            slopes, agreed = self._slopes(asked[some], said[some])
            right += agreed
            self._move(slopes, rate)
        return right / examples

    def _imagine(self, seen: Seen) -> Seen:
        """Turn and mirror what was seen; in most rows also change the robot's heading at random."""
        chance, rows = self._chance, len(seen)
        part, angle = chance.random(rows), chance.uniform(0, 2 * np.pi, rows)
        looks = np.stack([np.cos(angle), np.sin(angle)], 1)
        seen[:, 2:4] = np.where(part[:, None] < 0.6, looks, seen[:, 2:4])
        places = seen[:, :2] + chance.normal(0, 0.1, (rows, 2))
        places = np.where(part[:, None] < 0.1, chance.uniform(-0.9, 0.9, (rows, 2)), places)
        seen[:, :2] = np.where(part[:, None] < 0.4, np.clip(places, -0.95, 0.95), seen[:, :2])
        image = chance.integers(len(IMAGES), size=rows)
        pairs = seen[:, : len(PLACES)].reshape(rows, -1, 2)
        seen[:, : len(PLACES)] = (pairs @ IMAGES[image].swapaxes(1, 2)).reshape(rows, -1)
        discs = seen[:, len(PLACES) :]
        seen[:, len(PLACES) :] = np.take_along_axis(discs, self._moved[image], 1)
        return seen

    def _slopes(self, asked: Seen, said: npt.NDArray[np.int64]) -> tuple[list[Seen], int]:
        """Return the slope of the error along each part, and how many answers were right."""
        values, last = [asked], len(self._parts) - 2
        for layer in range(0, last, 2):
            values.append(np.tanh(values[-1] @ self._parts[layer].T + self._parts[layer + 1]))
        out = values[-1] @ self._parts[last].T + self._parts[last + 1]
        error = np.exp(out - out.max(1, keepdims=True))
        error /= error.sum(1, keepdims=True)
        right = int((error.argmax(1) == said).sum())
        error[np.arange(len(said)), said] -= 1
        error /= len(said)
        slopes: list[Seen] = []
        for layer in range(last, -1, -2):
            below = values[layer // 2]
            slopes = [error.T @ below, error.sum(0), *slopes]
            error = error @ self._parts[layer] * (1 - below**2)
        return slopes, right

    def _move(self, slopes: list[Seen], rate: float) -> None:
        """Make one step of Adam."""
        self._steps += 1
        fair_mean, fair_square = 1 - 0.9**self._steps, 1 - 0.999**self._steps
        for part, slope, mean, square in zip(
            self._parts, slopes, self._means, self._squares, strict=True
        ):
            mean += 0.1 * (slope - mean)
            square += 0.001 * (slope**2 - square)
            part -= rate * mean / fair_mean / (np.sqrt(square / fair_square) + 1e-8)


def main() -> None:
    """Train until the time is over, write the policy, and play it against straight."""
    options = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    options.add_argument("--minutes", type=float, default=30, help="how long it trains")
    options.add_argument("--jobs", type=int, default=2, help="processes; one of them learns")
    options.add_argument("--hidden", type=int, nargs=2, default=(256, 128), help="hidden numbers")
    options.add_argument("--matches", type=int, default=4, help="matches between two policies")
    options.add_argument(
        "--pairs",
        type=int,
        default=100,
        help="pairs of matches, one in each seat, that test the policy at the end",
    )
    options.add_argument("--out", type=Path, default=Path("learned_bot.py"), help="the bot file")
    told = options.parse_args()
    if told.out.exists():
        options.error(f"{told.out} exists already; choose another name with --out")
    with _pool(max(1, told.jobs - 1)) as pool:
        learner = Learner(tuple(told.hidden), seed=1)
        for policy in train(pool, learner, 60 * told.minutes, told.matches):
            told.out.write_text(export(policy), encoding="utf-8")
    with _pool(told.jobs) as pool:
        leads = [match.lead for match in pool.map(play, _tasks(EXAM, told.pairs, policy))]
    won = sum(left + right > 0 for left, right in zip(leads[::2], leads[1::2], strict=True))
    print(f"{told.out} won {won} of {told.pairs} mirrored pairs against straight")


def train(pool: Executor, learner: Learner, length_s: float, matches: int) -> Iterator[Network]:
    """Learn while the pool plays; yield better and better policies until the time is over."""
    start_s, seen, played = time.monotonic(), np.empty((0, 0), np.float32), 0
    policy: Network | None = None
    left = 1.0
    while left > 0:
        plays = [pool.submit(play, task) for task in _tasks(played, matches // 2, policy)]
        right = [0.0]
        while left > 0 and not all(one.done() for one in plays):
            left = 1 - (time.monotonic() - start_s) / length_s
            if len(seen):
                # In the second half of the time the steps become smaller and smaller.
                right.append(learner.learn(seen, 1e-3 * min(1, 2 * max(left, 0.005))))
            else:
                time.sleep(0.1)
        if left > 0:
            new = [one.result() for one in plays]
            played += matches
            seen = np.concatenate([*([seen] if len(seen) else []), *(one.seen for one in new)])
            lead = statistics.mean(one.lead for one in new)
            who = "learner" if policy else "teacher"
            said = f"{1 - left:4.0%}: {played} matches; the {who} led straight by {lead:.1f} points"
            if policy:
                said += f", and chose as the teacher in {right[-1]:.0%} of all places"
            print(said, flush=True)
            policy = learner.network()
            yield policy
    yield learner.network()


def _tasks(first: int, pairs: int, policy: Network | None) -> list[Task]:
    return [Task(first + pair, seat, policy) for pair in range(pairs) for seat in SEATS]


def _pool(processes: int) -> ProcessPoolExecutor:
    return ProcessPoolExecutor(processes, multiprocessing.get_context("spawn"))


if __name__ == "__main__":
    main()
