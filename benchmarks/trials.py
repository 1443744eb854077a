"""Compares trials with matches, and tries whether an explanation names what is wrong.

python -m benchmarks.trials matches --tables 1000
python -m benchmarks.trials explained --tables 210

- `matches`: random tables must walk in a trial as in a match of the same keys, bit for bit. It also
  counts how often feet go up or down.
- `explained`: one fault is put into each table. How often does the first sentence name it?
"""

import math
import random
import statistics
from collections import Counter
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from typing import Any, NamedTuple, TypeVar

from arguments import arguments
from faulty_tables import FAULTS, sequence_of, tell
from sample_walks import ROBOTS, course_of, entry_of, match_digests

from benchmarks.figures import finish
from lacoc_robots.library import find_robot
from lacoc_server.match.entry import weigh_in
from lacoc_server.trial.course import SETTLE_TICKS
from lacoc_server.trial.figures import Figures, measure
from lacoc_server.trial.walk import Press, Walk
from lacoc_shared.gait.tables import Gait, Level, LocomotionTable
from lacoc_shared.gait.text import write_gait
from lacoc_shared.messages import SentFile

_TURN_DEG = 60
"""Random angles are at most this far from the start posture."""
_WALKS_MM_S = 10.0
"""A robot walks if it goes forward faster than this, on its feet."""
_LOW_M = 0.001
_NAMED_AIM = 0.9

T = TypeVar("T")


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
    """Try tables, print the figures, and exit with 1 if an aim is missed."""
    options = arguments(__doc__, ("matches", "explained"), tables=1000, seed=1)
    seeds = range(options.seed, options.seed + options.tables)
    if options.what == "explained":
        named = dict.fromkeys(FAULTS, 0)
        told = _each(tell, seeds)
        for one in told:
            named[one.fault] += one.named
        missed = [(one.fault, one.leg, *one.said) for one in told if not one.named]
        finish(
            {"named": named, "of": Counter(one.fault for one in told), "not_named": missed},
            sum(named.values()) >= _NAMED_AIM * len(told),
        )
    found = _each(compared, seeds)
    differ = sum(one.differs_at is not None for one in found)
    walking = [one for one in found if one.walks]
    hz = [one.changes_hz for one in walking] or [0.0]
    figures: dict[str, Any] = {
        "tables": Counter(one.robot for one in found),
        "cycles": sum(one.cycles for one in found),
        "ticks": sum(one.ticks for one in found),
        "differ": differ,
        "walk": len(walking),
        "changes_of_a_foot_hz": {"median": statistics.median(hz), "most": max(hz)},
        "load_and_height_agree": statistics.mean([one.agrees for one in walking] or [1.0]),
        "samples": {
            robot: {
                "changes_of_a_foot_hz": statistics.mean(measure(walk).changes_hz),
                "load_and_height_agree": _agrees(walk),
            }
            for robot, walk in ((one, _sample_walk(one)) for one in ROBOTS)
        },
    }
    finish(figures, not differ)


def _each(function: Callable[[int], T], seeds: range) -> list[T]:
    with ProcessPoolExecutor(mp_context=get_context("spawn")) as pool:
        return list(pool.map(function, seeds, chunksize=4))


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
            sequence_of([[*map(math.degrees, posture)] for posture in sequence], spec)
            for sequence in sequences
        )
    )
    file = SentFile("LocoTra-data.txt", write_gait(table, spec.labels))
    return weigh_in(SentFile(*find_robot(robot)), None, file).gait, file


def _sample_walk(robot: str) -> Walk:
    return course_of(robot).walk(entry_of(robot).gait, [Press(SETTLE_TICKS, Level.LOCOMOTION, 2)])


if __name__ == "__main__":
    main()
