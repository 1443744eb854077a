"""Compares trials with matches on random tables, and counts how often feet go up or down.

python -m benchmarks.trials --tables 1000
"""

import argparse
import math
import random
import statistics
import sys
import time
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import cache
from multiprocessing import get_context
from typing import NamedTuple

from lacoc_robots.library import find_robot, sample_gait_files
from lacoc_server.match.entry import Entry, weigh_in
from lacoc_server.match.match import Match
from lacoc_server.trial.course import SETTLE_TICKS, Course, practice_field
from lacoc_server.trial.figures import Figures, measure
from lacoc_server.trial.walk import Press, Walk
from lacoc_server.world.sensed import make_course
from lacoc_server.world.world import World
from lacoc_shared.gait.tables import Gait, Level, LocomotionTable
from lacoc_shared.gait.text import write_gait
from lacoc_shared.inputs import Input, JoinSeat, KeySeat, ReadySeat
from lacoc_shared.messages import SentFile
from lacoc_shared.record.schema import Setup
from lacoc_shared.seat import Phase

ROBOTS = ("hexapod", "quadruped", "octopod")
_TURN_DEG = 60
"""Random angles are at most this far from the start posture."""
_WALKS_MM_S = 10.0
"""A robot walks if it goes forward faster than this, on its feet."""
_LOW_M = 0.001


class Compared(NamedTuple):
    """A comparison of a table's trial with a match of the same keys."""

    robot: str
    ticks: int
    cycles: int
    differs_at: int | None
    """Index of the first cycle at whose end the state hashes differ; -1: they differ only in other
    ticks; None: they never differ."""
    walks: bool
    """Whether the robot walks."""
    changes_hz: float
    """How often a foot comes down or goes up, mean over the feet [1/s]."""
    agrees: float
    """Share of ticks and feet in which load and height agree on whether the foot is down."""


def main() -> None:
    """Compare trials with matches, print, and exit with 1 if a state hash differs."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.trials", description=__doc__)
    parser.add_argument("--tables", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    begin = time.perf_counter()
    with ProcessPoolExecutor(mp_context=get_context("spawn")) as pool:
        seeds = range(options.seed, options.seed + options.tables)
        found = list(pool.map(compared, seeds, chunksize=10))
    differ = [one for one in found if one.differs_at is not None]
    cycles, ticks = sum(one.cycles for one in found), sum(one.ticks for one in found)
    robots = ", ".join(f"{count} {name}" for name, count in Counter(o.robot for o in found).items())
    print(f"{len(found)} tables ({robots}), {cycles} cycles, {ticks} ticks: {len(differ)} differ")
    walking = [one for one in found if one.walks]
    hz = sorted(one.changes_hz for one in walking) or [0.0]
    agrees = statistics.mean([one.agrees for one in walking] or [1.0])
    print(f"{len(walking)} of them walk. Changes of a foot: median {statistics.median(hz):.1f}/s,")
    print(f"largest {hz[-1]:.1f}/s. Load and height agree in {100 * agrees:.1f} % of their ticks")
    for robot in ROBOTS:
        walk = _sample_walk(robot)
        hz_of = statistics.mean(measure(walk).changes_hz)
        print(f"sample {robot}: {hz_of:.1f}/s, agree in {100 * _agrees(walk):.1f} %")
    print(f"{time.perf_counter() - begin:.0f} s")
    sys.exit(bool(differ))


def compared(seed: int) -> Compared:
    """Draw a random table, and compare its trial with a match of the same keys."""
    rng = random.Random(seed)
    robot = ROBOTS[seed % len(ROBOTS)]
    gait, locomotion = _drawn(rng, robot)
    press = Press(SETTLE_TICKS, Level.LOCOMOTION, rng.randrange(len(gait.keys(Level.LOCOMOTION))))
    walk = course_of(robot).walk(gait, [press])
    played = match_digests(robot, locomotion, [press], len(walk.digests))
    ends = [*walk.starts[1:], len(walk.digests)]
    differs = next(
        (i for i, end in enumerate(ends) if walk.digests[end - 1] != played[end - 1]), None
    )
    if differs is None and list(walk.digests) != played:
        differs = -1
    figures = measure(walk)
    return Compared(
        robot,
        len(walk.digests),
        len(walk.starts),
        differs,
        _walks(figures),
        statistics.mean(figures.changes_hz),
        _agrees(walk),
    )


def _walks(figures: Figures) -> bool:
    return (
        figures.cycles > 0
        and figures.speed_mm_s > _WALKS_MM_S
        and figures.belly_share == 0
        and figures.upright > 0.9
    )


def _agrees(walk: Walk) -> float:
    """Return how often load and height agree on whether a foot is down, as a share."""
    part = slice(walk.span.first, walk.span.end)
    down = walk.down[part]
    return float(((walk.tip_m[part] < _LOW_M) == down).mean()) if len(down) else 1.0


def _drawn(rng: random.Random, robot: str) -> tuple[Gait, SentFile]:
    """Draw a gait in whole degrees, and its file; half of the gaits are changed sample gaits."""
    entry = entry_of(robot)
    spec = entry.robot
    assert entry.gait.locomotion is not None
    sequences = [list(sequence) for sequence in entry.gait.locomotion.sequences]
    if rng.random() < 0.5:
        for sequence in sequences:
            for index, posture in enumerate(sequence):
                changed = list(posture)
                for joint in rng.sample(range(len(changed)), rng.randint(0, 3)):
                    changed[joint] += math.radians(rng.randint(-15, 15))
                sequence[index] = tuple(changed)
    else:
        sequences = [
            [
                tuple(
                    angle + math.radians(rng.randint(-_TURN_DEG, _TURN_DEG))
                    for angle in spec.start_posture
                )
                for _ in range(rng.randint(1, 4))
            ]
            for _ in range(rng.randint(1, 4))
        ]
    table = LocomotionTable(
        tuple(
            tuple(
                tuple(
                    math.radians(round(math.degrees(min(max(angle, low), high))))
                    for angle, (low, high) in zip(posture, spec.ranges_rad, strict=True)
                )
                for posture in sequence
            )
            for sequence in sequences
        )
    )
    file = SentFile("LocoTra-data.txt", write_gait(table, spec.labels))
    return weigh_in(SentFile(*find_robot(robot)), None, file).gait, file


def match_digests(
    robot: str, locomotion: SentFile, presses: Sequence[Press], ticks: int
) -> list[bytes]:
    """Play a trial's keys in a practice match; return the state hash after each tick."""
    settings = practice_field().settings
    setup = Setup(
        match_id="trial", court="trial", match=1, arena="practice", settings=settings, limits={}
    )
    match = Match(setup, World)
    match.beat([JoinSeat(0, "Team", SentFile(*find_robot(robot)), None, locomotion, token_hash="")])
    due = {press.tick: press for press in presses}
    inputs: list[Input] = [ReadySeat(0, True)]
    found: list[bytes] = []
    while len(found) < ticks:
        if match.beat(inputs).ticked:
            found.append(match.physics.digest)
        elif match.fault is not None:
            break
        press = due.get(len(found)) if match.phase is Phase.PLAYING else None
        inputs = [KeySeat(0, len(found), int(press.level), press.digit)] if press else []
    return found


@cache
def entry_of(robot: str) -> Entry:
    """Weigh in a sample robot with its sample gait."""
    return weigh_in(SentFile(*find_robot(robot)), *sample_gait_files(robot))


@cache
def course_of(robot: str) -> Course:
    """Build the floor and the robot for trials of a sample robot."""
    return make_course(entry_of(robot).robot)


def _sample_walk(robot: str) -> Walk:
    return course_of(robot).walk(entry_of(robot).gait, [Press(SETTLE_TICKS, Level.LOCOMOTION, 2)])


if __name__ == "__main__":
    main()
