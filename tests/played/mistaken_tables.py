"""Tables with one mistake that is known, and what a person is told of it."""

import random
from collections.abc import Callable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from sample_walks import course_of, entry_of

from lacoc_robots.robot import RobotSpec
from lacoc_server.studio.coach.coach import task_of
from lacoc_server.studio.coach.repair import repair
from lacoc_server.studio.coach.table import Angles, KeyTable
from lacoc_server.studio.coach.trials import Task, Trials, try_table
from lacoc_server.trial.course import SETTLE_TICKS
from lacoc_server.trial.figures import Figures, measure
from lacoc_server.trial.reasons.explain import explain
from lacoc_server.trial.reasons.goal import Goal
from lacoc_server.trial.walk import Floats, Press
from lacoc_shared.gait.tables import Gait, Level, LocomotionTable, Posture
from lacoc_shared.words import render

KEY = 2
_SAME_DEG = 8
"""A mistake changes at least one number by more than this."""
_BACK = 0.9

Changed = set[tuple[int, int, int]]
"""The cells of a mistake: posture, level, leg."""


class Mistaken(NamedTuple):
    """A table with a mistake."""

    robot: str
    kind: str
    table_deg: Floats
    """(postures, 3, legs)"""
    cells: Changed
    good_deg: Floats
    """The table without the mistake."""


class Said(NamedTuple):
    """What a person is told about a table with a mistake."""

    code: str
    """The code of the first sentence; empty: nothing was found."""
    named: bool
    """Whether the first sentence names the mistake."""
    pointed: bool
    """Whether it points at a wrong cell."""
    sentences: tuple[str, ...]
    codes: tuple[str, ...]
    """The codes of all sentences."""
    level: int
    """Level of the cell at which the first sentence points; -1: at none."""


class Outcome(NamedTuple):
    """What a person is told about a table with a mistake, and what the coach repairs."""

    robot: str
    kind: str
    code: str
    named: bool
    pointed: bool
    good_mm_s: float
    before_mm_s: float
    after_mm_s: float
    """With the coach's repairs; `before_mm_s` without any."""
    said: tuple[str, ...]

    @property
    def lost(self) -> bool:
        """Whether the mistake costs speed: a tenth, and 5 mm/s."""
        return self.good_mm_s - self.before_mm_s > max(5.0, 0.1 * self.good_mm_s)

    @property
    def back(self) -> bool:
        """Whether the repairs bring back nine tenths of the lost speed."""
        lost = self.good_mm_s - self.before_mm_s
        return self.after_mm_s - self.before_mm_s >= _BACK * lost


# Good gaits.


def _sample(robot: str) -> Floats:
    entry = entry_of(robot)
    assert entry.gait.locomotion is not None
    rows = np.degrees(np.array(entry.gait.locomotion.sequences[KEY]))
    return np.round(rows).reshape(len(rows), 3, -1)


def _tripod() -> Floats:
    """Return a gait as a student might make it: each foot swings by 20 degrees each way."""
    start = np.degrees(np.array(entry_of("hexapod").robot.start_posture)).reshape(3, -1)
    table = np.repeat(np.round(start)[None], 4, axis=0)
    for row, ahead in enumerate((-1, 1, 1, -1)):
        table[row, 0, 0::2] += 20 * ahead
        table[row, 0, 1::2] -= 20 * ahead
        table[row, 1, (0 if row < 2 else 1) :: 2] += 25
    return table


GOOD: dict[str, tuple[str, Callable[[], Floats]]] = {
    "sample": ("hexapod", lambda: _sample("hexapod")),
    "tripod": ("hexapod", _tripod),
    "long legs": ("long-legs", lambda: _sample("long-legs")),
    "octopod": ("octopod", lambda: _sample("octopod")),
    "quadruped": ("quadruped", lambda: _sample("quadruped")),
}


# Mistakes by chance.


def _sign(table: Floats, rng: random.Random) -> None:
    """Give one number the other sign."""
    places = [at for at in np.ndindex(table.shape) if abs(table[at]) > _SAME_DEG / 2]
    at = rng.choice(places)
    table[at] = -table[at]


def _swap(table: Floats, rng: random.Random) -> None:
    """Let two rows change places."""
    one, other = rng.sample(range(len(table)), 2)
    table[[one, other]] = table[[other, one]]


def _copy(table: Floats, rng: random.Random) -> None:
    """Copy a row over another one."""
    one, other = rng.sample(range(len(table)), 2)
    table[one] = table[other]


def _scale(table: Floats, rng: random.Random) -> None:
    """Let a joint of a leg move much less, or twice as far."""
    level, leg = rng.randrange(3), rng.randrange(table.shape[2])
    table[:, level, leg] = np.round(table[:, level, leg] * rng.choice((0.2, 2.0)))


def _leg(table: Floats, rng: random.Random) -> None:
    """Let a leg stand still, do everything late, or do what the leg beside it does."""
    leg = rng.randrange(table.shape[2])
    match rng.randrange(3):
        case 0:
            table[:, :, leg] = table[rng.randrange(len(table)), :, leg]
        case 1:
            table[:, :, leg] = np.roll(table[:, :, leg], rng.choice((1, -1)), axis=0)
        case _:
            table[:, :, leg] = table[:, :, (leg + 1) % table.shape[2]]


def _row(table: Floats, rng: random.Random) -> None:
    """Leave a row at 0, at the stand, or do not mirror it."""
    row = rng.randrange(len(table))
    match rng.randrange(3):
        case 0:
            table[row] = 0
        case 1:
            table[row] = np.round(table.mean(axis=0))
        case _:
            table[row] = table[row, :, ::-1]


_LEG_CODES = ("odd-leg", "odd-joint", "odd-joint-sign", "too-late", "too-early", "dragged")
_LEG_CODES += ("backward", "out-of-step", "odd-number", "odd-sign", "seam")
KINDS: dict[str, tuple[Callable[[Floats, random.Random], None], tuple[str, ...]]] = {
    "sign": (_sign, ("odd-sign", "odd-number", "limit")),
    "swap": (_swap, ("swapped-rows", "backward-order")),
    "copy": (_copy, ("copied-row", "equal-rows")),
    "scale": (_scale, ("limit", *_LEG_CODES)),
    "leg": (_leg, ("limit", *_LEG_CODES)),
    "row": (_row, ("odd-row", "copied-row")),
}


def mistaken(seed: int) -> Mistaken:
    """Put a mistake into a good gait."""
    rng = random.Random(seed)
    kind = tuple(KINDS)[seed % len(KINDS)]
    robot, make = GOOD[tuple(GOOD)[seed // len(KINDS) % len(GOOD)]]
    while True:
        good = make()
        table = good.copy()
        KINDS[kind][0](table, rng)
        table = _kept(table, entry_of(robot).robot)
        cells = {at for at in np.ndindex(table.shape) if abs(table[at] - good[at]) > 0.5}
        if np.abs(table - good).max() > _SAME_DEG and not _same_cycle(table, good):
            return Mistaken(robot, kind, table, cells, good)


def _same_cycle(one: Floats, other: Floats) -> bool:
    """Return whether two tables are the same cycle, begun at another row."""
    return any(np.array_equal(np.roll(one, by, axis=0), other) for by in range(len(one)))


def _kept(table: Floats, robot: RobotSpec) -> Floats:
    low, high = np.array(robot.ranges_deg).T.reshape(2, *table.shape[1:])
    return np.clip(table, low, high)


# Twenty tables of beginners.


_SHARED = ("zeros", "radians", "backward-order", "backward-signs", "no-lift", "all-lifted")
"""Faults of all legs: any cell shows them."""


def beginners() -> Iterator[tuple[Mistaken, tuple[str, ...]]]:
    """Yield the tables of beginners, each with the codes that name its mistake."""
    good = _sample("hexapod")
    rf, _, rb, lb, lc, lf = range(6)

    def made(kind: str, change: Callable[[Floats], Any], *codes: str) -> Any:
        table = good.copy()
        found = change(table)
        table = table if found is None else found
        everywhere = codes[0] in _SHARED
        cells = {
            at for at in np.ndindex(table.shape) if everywhere or abs(table[at] - good[at]) > 0.5
        }
        return Mistaken("hexapod", kind, table, cells, good), codes

    def put(at: Any, value: Any) -> Callable[[Floats], None]:
        return lambda table: table.__setitem__(at, value)

    def lifts(table: Floats, level: int, legs: Any, value: float) -> None:
        table[:, level, legs] = value

    yield made("zeros", put(slice(None), 0), "zeros")
    yield made("radians", lambda t: np.round(np.radians(t), 2), "radians")
    yield made("rows reversed", lambda t: t[::-1].copy(), "backward-order", "swapped-rows")
    yield made("all Roots' signs", lambda t: t.__imul__([[[-1], [1], [1]]]), "backward-signs")
    yield made("no foot lifted", lambda t: lifts(t, 2, slice(None), 0), "no-lift")
    both = np.array([40, 40, 0, 0])[:, None]
    yield made("all six lifted", put((slice(None), 2), both), "all-lifted")
    yield made("one side lifted", lambda t: lifts(t, 2, [lb, lc, lf], 0), "odd-side")
    yield made("typo: 2nd -30", put((0, 2, rf), -30), "odd-number", "odd-sign")
    yield made("typo: 1st 0, 2nd -30", put((0, [1, 2], rf), [0, -30]), "odd-number", "odd-leg")
    yield made("2nd -40", put((0, 2, rb), -40), "odd-sign")
    left = (slice(None), 0, slice(3, 6))
    yield made("left Roots' signs", lambda t: put(left, -t[left])(t), "side-sign")
    yield made(
        "rows 3, 4 copied", lambda t: put(slice(2, 4), t[:2])(t), "wrong-mirror", "copied-row"
    )
    mirrored = lambda t: put((slice(2, 4), 0), -t[2:4, 0])(t)  # noqa: E731
    yield made("mirror with signs", mirrored, "wrong-mirror")
    yield made("rows 2, 3 changed", lambda t: t[[0, 2, 1, 3]], "swapped-rows")
    yield made("row 2 copied from 1", lambda t: put(1, t[0])(t), "copied-row")
    yield made(
        "a leg at 0", put((slice(None), slice(None), rb), 0), "odd-leg", "odd-joint", "dragged"
    )
    late = (slice(None), slice(None), lf)
    shifted = lambda t: put(late, np.roll(t[late], 1, axis=0))(t)  # noqa: E731
    yield made("a leg late", shifted, "too-late", "out-of-step")
    yield made("4 for 40", put((0, 2, rf), 4), "odd-number")
    yield made(
        "swing and stance",
        put((slice(None), 2), [40, 0, 40, 0, 40, 0]),
        "wrong-mirror",
        "same-height",
    )
    yield made("all 1st at 60", put((1, 1), 60), "odd-row", "belly")


# Tables whose feet hang in the air, stand for ever, or go the wrong way.


def change_of(table: str, kind: str, change: Callable[[Floats], Any]) -> Mistaken:
    """Change a good gait of the hexapod.

    Args:
        table: the gait, of `GOOD`.
        kind: what the change is.
        change: changes the angles, (postures, 3, legs).
    """
    good = GOOD[table][1]()
    changed = good.copy()
    change(changed)
    changed = _kept(changed, entry_of("hexapod").robot)
    cells = {at for at in np.ndindex(good.shape) if abs(changed[at] - good[at]) > 0.5}
    return Mistaken("hexapod", kind, changed, cells, good)


# What is told.


def sequence_of(table_deg: Floats) -> tuple[Posture, ...]:
    """Return the postures of a table [rad]."""
    rows = np.radians(table_deg).reshape(len(table_deg), -1)
    return tuple(tuple(map(float, row)) for row in rows)


def told(table: Mistaken, codes: tuple[str, ...]) -> Said:
    """Let a robot walk with a table, and return what is said about it.

    Args:
        table: the table.
        codes: codes of sentences that name its mistake.
    """
    robot = entry_of(table.robot).robot
    sequence, gait = _gait_of(table)
    press = Press(SETTLE_TICKS, Level.LOCOMOTION, KEY)
    walk = course_of(table.robot).walk(gait, [press])
    explained = explain(robot, walk, measure(walk), press, sequence)
    first = explained[0] if explained else None
    code = first.said.code.removeprefix("explain.") if first else ""
    cell = first.cell if first else None
    at = None if cell is None else (cell.posture, *divmod(cell.joint, len(robot.legs)))
    return Said(
        code,
        code in codes,
        at in table.cells,
        tuple(render(one.said) for one in explained),
        tuple(one.said.code.removeprefix("explain.") for one in explained),
        at[1] if at else -1,
    )


def repaired(table: Mistaken, codes: tuple[str, ...]) -> Outcome:
    """Let the coach repair a table; arguments as in `told`."""
    first = told(table, codes)
    said = first.sentences
    task = task_of(entry_of(table.robot).robot, _gait_of(table)[1], KEY, Goal.FORWARD, None)
    good = KeyTable.of(sequence_of(table.good_deg))
    good_mm_s = try_table(task._replace(table=good), good.angles_deg).speed_mm_s
    before_mm_s = after_mm_s = try_table(task, task.table.angles_deg).speed_mm_s
    for one in repair(HereTrials(task)):
        after_mm_s = one.after.speed_mm_s
        said = (*said, f"{render(one.said)} {one.before.speed_mm_s:.0f} -> {after_mm_s:.0f}")
    return Outcome(
        table.robot,
        table.kind,
        first.code,
        first.named,
        first.pointed,
        good_mm_s,
        before_mm_s,
        after_mm_s,
        said,
    )


def _gait_of(table: Mistaken) -> tuple[tuple[Posture, ...], Gait]:
    """Return the postures of a table, and a gait that has them at its key `KEY`."""
    sequence = sequence_of(table.table_deg)
    stand = (entry_of(table.robot).robot.start_posture,)
    return sequence, Gait(None, LocomotionTable((*(stand,) * KEY, sequence)))


class HereTrials(Trials):
    """Trials in this process."""

    def __init__(self, task: Task) -> None:
        self.task = task
        self.count = 0
        self._spared = {}

    def _walks(self, tables: Sequence[Angles], way: tuple[int, int]) -> list[Figures]:
        self.count += len(tables)
        return [try_table(self.task, table, *way) for table in tables]
