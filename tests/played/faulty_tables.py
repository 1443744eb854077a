"""Tables into which one fault was put, and what a trial's explanation says of it."""

import math
import random
from collections.abc import Callable
from typing import NamedTuple

from sample_walks import course_of, entry_of

from lacoc_robots.robot import RobotSpec
from lacoc_server.trial.course import SETTLE_TICKS
from lacoc_server.trial.figures import measure
from lacoc_server.trial.reasons.explain import explain
from lacoc_server.trial.walk import Press
from lacoc_shared.gait.tables import Gait, Level, LocomotionTable, Posture
from lacoc_shared.words import Phrase, render

KEY = 2
_NOISE_DEG = 3
"""Each angle differs by at most this much from the sample's, so that no two tables are equal."""

Table = list[list[float]]
"""For each posture, its angles by joint id [deg]."""


def sequence_of(table: Table, robot: RobotSpec) -> tuple[Posture, ...]:
    """Return a table as postures in whole degrees, within the joints' ranges."""
    return tuple(
        tuple(
            math.radians(round(min(max(angle, low), high)))
            for angle, (low, high) in zip(posture, robot.ranges_deg, strict=True)
        )
        for posture in table
    )


class Told(NamedTuple):
    """A fault that was put into a table, and the sentences that explain the trial."""

    fault: str
    leg: str
    named: bool
    """Whether the first sentence names the fault, and its leg if it has one."""
    said: tuple[str, ...]


def tell(seed: int) -> Told:
    """Put a fault into a table, let the robot walk with the table, and return the explanation."""
    rng = random.Random(seed)
    name = tuple(FAULTS)[seed % len(FAULTS)]
    code, put = FAULTS[name]
    entry = entry_of("hexapod")
    assert entry.gait.locomotion is not None
    table = [
        [math.degrees(angle) + rng.randint(-_NOISE_DEG, _NOISE_DEG) for angle in posture]
        for posture in entry.gait.locomotion.sequences[KEY]
    ]
    # The sample's middle legs do not swing, so the fault "swapped" would change nothing there.
    swinging = [leg for leg in range(len(entry.robot.legs)) if _swings(table, leg)]
    leg = rng.choice(swinging if name == "swapped" else range(len(entry.robot.legs)))
    put(table, leg, entry.robot, rng)
    sequence = sequence_of(table, entry.robot)
    start = (entry.robot.start_posture,)
    gait = Gait(None, LocomotionTable((*(start,) * KEY, sequence)))
    press = Press(SETTLE_TICKS, Level.LOCOMOTION, KEY)
    walk = course_of("hexapod").walk(gait, [press])
    explained = explain(entry.robot, walk, measure(walk), press, sequence)
    said = [one.said for one in explained]
    label = entry.robot.labels[leg]
    named = bool(said) and said[0].code in code and (name in WHOLE or label in _legs(said[0]))
    return Told(name, label, named, tuple(render(phrase) for phrase in said))


def _legs(phrase: Phrase) -> list[object]:
    """List the legs that a sentence names."""
    cell = phrase.values.get("cell")
    inner = cell.values.get("leg") if isinstance(cell, Phrase) else None
    return [phrase.values.get("leg"), inner]


def _swings(table: Table, leg: int) -> bool:
    roots = [posture[leg] for posture in table]
    return max(roots) - min(roots) > 4 * _NOISE_DEG


def _dragged(table: Table, leg: int, robot: RobotSpec, rng: random.Random) -> None:
    """Never lift the foot of a leg: keep the leg's 1st and 2nd joints near their start angles."""
    legs = len(robot.legs)
    for posture in table:
        for joint in (leg + legs, leg + 2 * legs):
            posture[joint] = math.degrees(robot.start_posture[joint]) + rng.randint(-1, 1)


def _swapped(table: Table, leg: int, robot: RobotSpec, rng: random.Random) -> None:
    """Swing the root of a leg the wrong way, as if the leg were on the other side."""
    roots = [posture[leg] for posture in table]
    for posture in table:
        posture[leg] = max(roots) + min(roots) - posture[leg]


def _late(table: Table, leg: int, robot: RobotSpec, rng: random.Random) -> None:
    """Move a leg's angles to the next posture, so that the leg does everything one posture late."""
    legs = len(robot.legs)
    for joint in range(leg, len(table[0]), legs):
        angles = [posture[joint] for posture in table]
        for posture, angle in zip(table, angles[-1:] + angles[:-1], strict=True):
            posture[joint] = angle


def _seam(table: Table, leg: int, robot: RobotSpec, rng: random.Random) -> None:
    """Turn a joint by equal steps from posture to posture, so that it jumps back at the seam."""
    joint = leg + len(robot.legs) * rng.choice((0, 2))
    step = rng.choice((-1, 1)) * rng.randint(13, 18)
    middle = table[0][joint]
    for index, posture in enumerate(table):
        posture[joint] = middle + step * (index - 1.5)


def _limit(table: Table, leg: int, robot: RobotSpec, rng: random.Random) -> None:
    """Set one angle to the end of the joint's range."""
    joint = leg + len(robot.legs) * rng.randrange(2)
    rng.choice(table)[joint] = rng.choice(robot.ranges_deg[joint])


def _belly(table: Table, leg: int, robot: RobotSpec, rng: random.Random) -> None:
    """Lift all legs in one posture, so that the body comes down on the floor."""
    legs = len(robot.legs)
    posture = rng.choice(table)
    for joint in range(legs, 2 * legs):
        posture[joint] = rng.randint(50, 60)


def _none(table: Table, leg: int, robot: RobotSpec, rng: random.Random) -> None:
    """Leave the table without a fault; the explanation must not name one."""


FAULTS: dict[
    str, tuple[tuple[str, ...], Callable[[Table, int, RobotSpec, random.Random], None]]
] = {
    "dragged": (("explain.dragged",), _dragged),
    "swapped": (("explain.backward",), _swapped),
    "late": (
        ("explain.out-of-step", "explain.too-late", "explain.odd-leg", "explain.odd-joint"),
        _late,
    ),
    "seam": (("explain.seam",), _seam),
    "limit": (("explain.limit",), _limit),
    "belly": (("explain.belly", "explain.odd-row"), _belly),
    "none": (("explain.slides", "explain.turns", "explain.unstable", "explain.walks"), _none),
}
"""For each fault: the codes of the sentences that name it, and the function that puts it in."""
WHOLE = frozenset({"belly", "none"})
"""Faults of the whole robot, not of one leg."""
