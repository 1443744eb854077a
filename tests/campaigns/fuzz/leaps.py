"""Looks for robots that pass the weigh-in and then leave their start place, or score, standing.

    python -m tests.campaigns.fuzz.leaps

The search first makes random robots within the contest's limits. Then it changes those that moved
farthest, step by step, and keeps each change that makes a robot move farther. Every robot is
weighed in as by a court. A robot that passes stands on both start places of a match of each game,
for longer than in its stand test; nobody presses a key. Many robots have arms beside their legs.
"""

import math
import random
import time
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from typing import NamedTuple

import msgspec
from arguments import arguments
from rich.console import Console

from lacoc_arenas import arena as arenas
from lacoc_robots.limits import Limits
from lacoc_robots.robot import RobotSpec
from lacoc_robots.robot_file import read_robot
from lacoc_robots.stand_test import stand
from lacoc_robots.standing import FARTHEST_M, mistakes_of
from lacoc_server.match.entry import weigh_in
from lacoc_server.match.match import Match
from lacoc_server.simulate.headless import to_play
from lacoc_server.world.world import World
from lacoc_shared.gait.cells import leg_labels
from lacoc_shared.gait.tables import Level, LocomotionTable, Posture
from lacoc_shared.gait.text import write_gait
from lacoc_shared.inputs import JoinSeat
from lacoc_shared.messages import SentFile
from lacoc_shared.mistakes import FileRefused
from lacoc_shared.record.schema import Setup
from lacoc_shared.seat import BEATS_PER_S, Phase

PLAY_BEATS = 3 * BEATS_PER_S
"""Beats of play; before it, robots stand for a second."""
LINES = 20
"""The number of robots that the search changes step by step."""

_BOUNDS: dict[str, tuple[float, float]] = {
    "width_m": (0.04, 0.2),
    "length_m": (0.04, 0.25),
    "thickness_m": (0.02, 0.08),
    "body_kg": (0.05, 1.0),
    "root_m": (0.005, 0.05),
    "first_m": (0.02, 0.12),
    "second_m": (0.02, 0.12),
    "arm_m": (0.02, 0.12),
    "radius_m": (0.005, 0.03),
    "root_kg": (0.005, 0.1),
    "first_kg": (0.005, 0.1),
    "second_kg": (0.005, 0.1),
    "ang_min_deg_s": (1.0, 240.0),
    "kp": (1.0, 200.0),
    "kv": (0.0, 5.0),
    "torque_n_m": (0.1, 2.0),
    "damping": (0.0, 1.0),
    "armature": (0.002, 0.02),
    "friction": (0.0, 1.5),
    "drop_m": (0.0, 0.05),
}
_ANY_HEIGHT = Limits(drop_m=1.0)
_MOSTLY = {"ang_min_deg_s": 240.0, "torque_n_m": 2.0, "kv": 0.0, "damping": 0.0, "armature": 0.002}
"""Each of these numbers, which make leaps likelier, is given to half of all random robots."""


class Candidate(NamedTuple):
    """The numbers of a robot, before its file is made and read."""

    legs: int
    arms: bool
    """Whether the legs in the middle of each side are arms, with links of their own."""
    numbers: dict[str, float]
    start_deg: tuple[float, ...]
    stand_deg: tuple[float, ...]
    """First posture of key 0, in which the robot stands."""


class Found(NamedTuple):
    """What was found out about a candidate."""

    candidate: Candidate
    is_robot: bool
    """Whether its robot file has no mistakes."""
    tried_m: float
    """How far it moved in its stand test; 0.0 if its file has mistakes."""
    leap_m: float | None
    """How far it moved in a match; None if it did not pass the weigh-in."""
    scored: bool = False
    """Whether a robot scored in a match."""


def at_random(seed: int) -> Candidate:
    """Make a robot with random numbers; the same seed makes the same robot."""
    dice = random.Random(seed)
    legs = dice.choice((4, 6, 8))
    numbers = {}
    for name, (low, high) in _BOUNDS.items():
        if name in _MOSTLY and dice.random() < 0.5:
            numbers[name] = _MOSTLY[name]
        elif low > 0 and high / low > 9:  # as many light robots as heavy ones
            numbers[name] = math.exp(dice.uniform(math.log(low), math.log(high)))
        else:
            numbers[name] = dice.uniform(low, high)
    start = _posture(dice, legs, dice.choice((15.0, 45.0, 90.0, 150.0)))
    if dice.random() < 0.5:
        near = dice.choice((2.0, 10.0, 30.0))
        stands = tuple(_within(angle + dice.uniform(-near, near)) for angle in start)
    else:
        stands = _posture(dice, legs, dice.choice((15.0, 45.0, 90.0)))
    return Candidate(legs, dice.random() < 0.5, numbers, start, stands)


def changed(candidate: Candidate, seed: int) -> Candidate:
    """Change a robot a little: up to three of its numbers, and some of its angles."""
    dice = random.Random(seed)
    numbers = dict(candidate.numbers)
    for name in dice.sample(sorted(_BOUNDS), dice.randint(0, 3)):
        low, high = _BOUNDS[name]
        numbers[name] = min(high, max(low, numbers[name] + dice.gauss(0, 0.1) * (high - low)))
    wide, part = dice.choice((1.0, 5.0, 20.0)), dice.random()

    def shaken(angles: tuple[float, ...]) -> tuple[float, ...]:
        return tuple(
            _within(a + dice.gauss(0, wide)) if dice.random() < part else a for a in angles
        )

    return candidate._replace(
        numbers=numbers,
        start_deg=shaken(candidate.start_deg),
        stand_deg=shaken(candidate.stand_deg),
    )


def judge(candidate: Candidate) -> Found:
    """Weigh a robot in, and if it passes, let it stand in a match."""
    made = _robot(candidate)
    if made is None:
        return Found(candidate, False, 0.0, None)
    robot, text = made
    posture = tuple(math.radians(angle) for angle in candidate.stand_deg)
    gait = write_gait(LocomotionTable(((posture,),)), leg_labels(candidate.legs))
    files = (SentFile("robot.toml", text.encode()), None, SentFile("LocoTra-data.txt", gait))
    stood = stand(robot, posture)
    try:
        if mistakes_of(stood, "robot.toml", (Level.LOCOMOTION,)):
            raise FileRefused([])
        weigh_in(*files)
    except FileRefused:
        return Found(candidate, True, stood.moved_m, None)
    stands = {game: standing(game, files) for game in ("flag-strike", "othello")}
    return Found(
        candidate,
        True,
        stood.moved_m,
        stands["flag-strike"][0],  # in Othello a wall is so near that it pushes large robots away
        any(scored for _, scored in stands.values()),
    )


def standing(game: str, files: tuple[SentFile, None, SentFile]) -> tuple[float, bool]:
    """Let two robots stand in a match; return how far one moves [m], and whether one scores."""
    arena = arenas.load(game, {"match": {"countdown_s": 0.02}})
    setup = Setup(
        match_id="stand", court="", match=1, arena=game, settings=arena.settings, limits={}
    )
    match = Match(setup, World)
    joins = [JoinSeat(seat, f"Team {seat}", *files, token_hash="") for seat in (0, 1)]
    farthest_m, before = 0.0, None
    for _ in to_play(joins, match.beat):
        farthest_m = max(farthest_m, _gone_from_start_m(match))
    for _ in range(PLAY_BEATS):
        frame = match.beat().frame
        scores = (frame.markers, *(seat.score for seat in frame.seats))
        before = before or scores
        if scores != before:
            return farthest_m, True
        farthest_m = max(farthest_m, _gone_from_start_m(match))
    return (farthest_m if match.phase is Phase.PLAYING else math.inf), False


def _gone_from_start_m(match: Match) -> float:
    if not match.staging.poses:
        return 0.0
    return max(match.staging.from_start_m(seat) for seat in (0, 1))


def search(robots: int, steps: int, jobs: int, seed: int = 0) -> Iterator[Found]:
    """Judge random robots, then change those that moved farthest so that they move farther.

    Args:
        robots: number of random robots.
        steps: number of changes in all.
        jobs: number of processes.
        seed: seed of the first random robot.
    """
    with ProcessPoolExecutor(jobs, get_context("forkserver")) as pool:
        found: list[Found] = []
        at = seed
        while len(found) < robots:
            some = range(at, at + 2 * (robots - len(found)) + 8)
            at = some.stop
            right = (one for one in pool.map(_random, some, chunksize=8) if one.is_robot)
            for one, _ in zip(right, range(robots - len(found)), strict=False):
                found.append(one)
                yield one
        best = sorted((one for one in found if one.leap_m is not None), key=_gone_m)[-LINES:]
        for step in range(0, steps, max(1, len(best))):
            tries = [(one.candidate, at + step + line) for line, one in enumerate(best)]
            for line, one in enumerate(pool.map(_changed, tries[: steps - step])):
                yield one
                if _gone_m(one) > _gone_m(best[line]):
                    best[line] = one


def main() -> None:
    """Search and print the result; exit with 1 if a robot leapt."""
    options = arguments(
        __doc__,
        robots=(2000, "robots at random"),
        steps=(2000, "changes of the best"),
        jobs=(2, "processes"),
        seed=(0, "of the first robot"),
    )
    began_s = time.monotonic()
    found = list(search(options.robots, options.steps, options.jobs, options.seed))
    let_in = [one for one in found if one.leap_m is not None]
    farthest = max(let_in, key=_gone_m)
    console = Console()
    console.print(
        f"{len(found)} robots in {time.monotonic() - began_s:.0f} s, {len(let_in)} let in. "
        f"Farthest while it stood: {_gone_m(farthest):.4f} m in a match, "
        f"{farthest.tried_m:.4f} m in its stand test; of those not let in "
        f"{max(one.tried_m for one in found):.3f} m. {sum(one.scored for one in found)} scored."
    )
    bad = [one for one in let_in if one.scored or _gone_m(one) > FARTHEST_M]
    if bad:
        console.print(msgspec.json.encode(bad[0]).decode(), soft_wrap=True)
        raise SystemExit(1)


def _random(seed: int) -> Found:
    return judge(at_random(seed))


def _changed(what: tuple[Candidate, int]) -> Found:
    return judge(changed(*what))


def _gone_m(found: Found) -> float:
    return -1.0 if found.leap_m is None else found.leap_m


def _robot(candidate: Candidate) -> tuple[RobotSpec, str] | None:
    """Return a candidate as a robot and its file, `drop_m` high; None if it breaks a limit."""
    try:
        robot = read_robot(_file(candidate, 0.5), "robot.toml", _ANY_HEIGHT)
        lowest_m = robot.bounds(robot.start_posture)[0].z + robot.size_m[2] / 2
        text = _file(candidate, candidate.numbers["drop_m"] - lowest_m)
        return read_robot(text, "robot.toml"), text
    except FileRefused:
        return None


def _file(candidate: Candidate, height_m: float) -> str:
    legs, n = candidate.legs, candidate.numbers
    lines = [
        'name = "Leaper"',
        "[body]",
        f"size_m = [{n['width_m']}, {n['length_m']}, {n['thickness_m']}]",
        f"mass_kg = {n['body_kg']}",
        "[start]",
        f"height_m = {height_m}",
        f"posture_deg = {list(candidate.start_deg)}",
        "[drive]",
        f"ang_min_deg_s = {n['ang_min_deg_s']}",
        "[servo]",
        *(f"{name} = {n[name]}" for name in ("kp", "kv", "torque_n_m", "damping", "armature")),
        "[surface]",
        f"friction = {n['friction']}",
        "[link]",
        f"lengths_m = [{n['root_m']}, {n['first_m']}, {n['second_m']}]",
        f"radius_m = {n['radius_m']}",
        f"masses_kg = [{n['root_kg']}, {n['first_kg']}, {n['second_kg']}]",
        "range_deg = [-150, 150]",
    ]
    half = legs // 2
    for leg in range(legs):
        side = 1 if leg < half else -1
        row = leg if leg < half else legs - 1 - leg
        y_m = n["length_m"] * (0.45 - 0.9 * row / (half - 1))
        lines += [
            "[[leg]]",
            f'label = "{leg}"',
            f"position_m = [{side * n['width_m'] / 2}, {y_m}, {-n['thickness_m'] / 4}]",
            f"outward_deg = {0 if side > 0 else 180}",
        ]
        if candidate.arms and 0 < row < half - 1:
            lines.append(f"lengths_m = [{n['root_m']}, {n['arm_m']}, {n['arm_m']}]")
    return "\n".join(lines)


def _posture(dice: random.Random, legs: int, wide_deg: float) -> Posture:
    """Draw random angles of all joints, the same for all legs or different ones."""
    if dice.random() < 0.5:
        three = [dice.uniform(-wide_deg, wide_deg) for _ in range(3)]
        return tuple(three[joint // legs] for joint in range(3 * legs))
    return tuple(dice.uniform(-wide_deg, wide_deg) for _ in range(3 * legs))


def _within(angle_deg: float) -> float:
    return min(150.0, max(-150.0, angle_deg))


if __name__ == "__main__":
    main()
