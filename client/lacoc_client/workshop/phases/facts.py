"""Computes, from a trial or an edit, the few numbers and words that the phases ask for."""

import math
import re
from collections.abc import Sequence
from itertools import pairwise
from typing import Any, Literal

import msgspec
import numpy as np
import numpy.typing as npt

from lacoc_robots.leg import LegSpec
from lacoc_shared.seat import BEAT_S
from lacoc_shared.studio import TrialReply

TRIPOD_MARGIN_M = 0.010
"""A robot stands firmly if its support margin is at least this [m]."""

Pace = Literal["faster", "slower", "same"]
Way = Literal["left", "right", "straight"]
FootWay = Literal["forward", "back", "up", "down", "out", "in", "still"]
Difference = Literal["speed", "period", "lift", "duty", "turning"]

_SEAM = "explain.seam"
SAME_MM_S, SAME_SHARE = 3.0, 0.05
"""Two speeds count as the same if they differ by less than 3 mm/s, or by less than 5 %."""
STRAIGHT_DEG_S = 3.0
"""A robot that turns at most this fast counts as going straight [deg/s] (docs/studio.md 3)."""
_STILL_M = 0.001  # a foot that moves less than this stays where it is
_ALSO = 0.6  # a direction is a right answer if the motion along it is this part of the largest
_KEY = re.compile(r"([AaBb]?)([0-9])(?::[0-9.]+)?", re.ASCII)


class TrialFacts(msgspec.Struct, frozen=True, kw_only=True):
    """The facts of a trial, from its measured time; docs/studio.md 2 and 7 define the numbers."""

    keys: tuple[str, ...]
    """Level and digit of each pressed key in order, such as "A1". The last key was measured."""
    postures: int
    """How many postures of the measured key the drive has moved to."""
    cycles: int
    """Number of whole cycles that were measured."""
    cycle_s: float | None
    forward_mm: float
    """Distance that the robot went forward: in the direction that it faced when the measurement
    began."""
    left_mm: float
    """Distance to the left of this direction."""
    speed_mm_s: float
    drift_deg_s: float
    upright: float
    belly_share: float
    margin_mm: float | None
    clearance_mm: float
    duty: tuple[float, ...]
    """For each leg, the share of time in which its foot is down."""
    tripod_s: float
    """Longest time in which the robot stood on the same half of its feet (`feet_of_half`), with a
    support margin of at least `TRIPOD_MARGIN_M` [s]."""
    same_feet_share: float
    """Largest share of time in which the robot stood on the same half of its feet, with any
    margin."""
    seam_deg: float
    """Largest jump of a joint from the last posture back to the first [deg]; 0: no joint jumps."""
    stopped: bool
    """Whether physics stopped before the end of the trial."""
    stood: tuple[int, ...] = ()
    """Indices of the legs whose feet are the half that `same_feet_share` counts."""


class _FactFigures(msgspec.Struct, frozen=True, kw_only=True):
    """The figures in a studio's reply from which the facts of a trial are computed."""

    seconds: float
    cycles: int
    cycle_s: float | None
    speed_mm_s: float
    lateral_mm_s: float
    drift_deg_s: float
    upright: float
    belly_share: float
    margin_mm: float | None
    clearance_mm: float
    duty: tuple[float, ...]


def trial_facts(reply: TrialReply, keys: str = "") -> TrialFacts:
    """Compute the facts of a trial from a studio's reply.

    Args:
        reply: the reply.
        keys: keys of the request, as `TrialRequest.keys`.

    Raises:
        ValueError: if the reply's figures or arrays do not fit together.
    """
    figures = msgspec.convert(reply.figures, _FactFigures)
    feet = _array(reply.down, "u1", reply.ticks)[reply.first : reply.end]
    margins_m = _array(reply.margin_m, "<f4", reply.ticks)[reply.first : reply.end]
    postures = _array(reply.posture, "u1", reply.ticks)[reply.first : reply.end]
    tripod = np.where(_counts(feet) == feet_of_half(len(figures.duty)), feet, 0)
    firm = np.where(margins_m >= TRIPOD_MARGIN_M, tripod, 0)  # no margin is NaN: not firm
    half, ticks = _most_common(tripod)
    share = ticks / len(tripod) if len(tripod) else 0.0
    jumps = [
        said.said.values.get("jump_deg") for said in reply.explained if said.said.code == _SEAM
    ]
    return TrialFacts(
        keys=_pressed(keys, reply),
        postures=len(np.unique(postures)),
        cycles=figures.cycles,
        cycle_s=figures.cycle_s,
        forward_mm=_short(figures.speed_mm_s * figures.seconds),
        left_mm=_short(figures.lateral_mm_s * figures.seconds),
        speed_mm_s=_short(figures.speed_mm_s),
        drift_deg_s=_short(figures.drift_deg_s),
        upright=_short(figures.upright),
        belly_share=_short(figures.belly_share),
        margin_mm=None if figures.margin_mm is None else _short(figures.margin_mm),
        clearance_mm=_short(figures.clearance_mm),
        duty=tuple(map(_short, figures.duty)),
        tripod_s=round(_longest_run(firm) * BEAT_S, 2),
        same_feet_share=_short(share),
        stood=tuple(leg for leg in range(len(figures.duty)) if half >> leg & 1),
        seam_deg=max(
            (_short(jump) for jump in jumps if isinstance(jump, float | int)), default=0.0
        ),
        stopped=reply.fault is not None,
    )


def feet_of_half(legs: int) -> int:
    """Return how many feet count as half of the legs: three of six, and never fewer than three."""
    return max(3, legs // 2)


def pace(before: TrialFacts, after: TrialFacts) -> Pace:
    """Return whether the robot walked forward faster, slower or as fast as in the trial before."""
    by = after.speed_mm_s - before.speed_mm_s
    if abs(by) < max(SAME_MM_S, SAME_SHARE * abs(before.speed_mm_s)):
        return "same"
    return "faster" if by > 0 else "slower"


def way(facts: TrialFacts) -> Way:
    """Return to which side a robot turned in a trial, or that it went straight."""
    if abs(facts.drift_deg_s) <= STRAIGHT_DEG_S:
        return "straight"
    return "left" if facts.drift_deg_s > 0 else "right"


def differences(one: TrialFacts, other: TrialFacts) -> tuple[Difference, ...]:
    """List the differences between two walks that are large enough to see (docs/studio.md 7)."""
    found: list[Difference] = []
    if _apart(one.speed_mm_s, other.speed_mm_s, least=5.0, share=0.2):
        found.append("speed")
    if _apart(one.cycle_s or 0.0, other.cycle_s or 0.0, least=0.1, share=0.2):
        found.append("period")
    if _apart(one.clearance_mm, other.clearance_mm, least=3.0, share=0.2):
        found.append("lift")
    if _apart(_mean(one.duty), _mean(other.duty), least=0.08, share=0.0):
        found.append("duty")
    if _apart(one.drift_deg_s, other.drift_deg_s, least=2 * STRAIGHT_DEG_S, share=0.2):
        found.append("turning")
    return tuple(found)


def foot_ways(
    leg: LegSpec, before_deg: Sequence[float], after_deg: Sequence[float]
) -> tuple[FootWay, ...]:
    """Return the directions in which the foot of a leg moves, seen from the body.

    Args:
        leg: the leg.
        before_deg: (3,) angles of the joints Root, 1st and 2nd before the change.
        after_deg: (3,) their angles after the change.

    Returns:
        All directions that count as right answers, the one with the largest motion first. "out" is
        away from the middle of the body. A motion at 45 degrees between two directions has both.
    """
    start = leg.points(*map(math.radians, before_deg))[-1]
    end = leg.points(*map(math.radians, after_deg))[-1]
    out_m, ahead_m, up_m = leg.side * (end.x - start.x), end.y - start.y, end.z - start.z
    if math.hypot(out_m, ahead_m, up_m) < _STILL_M:
        return ("still",)
    moves: list[tuple[float, FootWay]] = [
        (abs(ahead_m), "forward" if ahead_m > 0 else "back"),
        (abs(up_m), "up" if up_m > 0 else "down"),
        (abs(out_m), "out" if out_m > 0 else "in"),
    ]
    moves.sort(key=lambda move: -move[0])
    return tuple(way for by_m, way in moves if by_m >= _ALSO * moves[0][0])


def _apart(one: float, other: float, least: float, share: float) -> bool:
    return abs(one - other) >= max(least, share * max(abs(one), abs(other)))


def _mean(values: tuple[float, ...]) -> float:
    return sum(values) / len(values) if values else 0.0


def _array(data: bytes, kind: str, ticks: int) -> npt.NDArray[Any]:
    values: npt.NDArray[Any] = np.frombuffer(data, kind)
    if len(values) != ticks:
        raise ValueError(f"{len(values)} values for {ticks} ticks")
    return values


def _counts(feet: npt.NDArray[np.uint8]) -> npt.NDArray[np.int64]:
    """Return how many feet are on the floor in each tick."""
    counts: npt.NDArray[np.int64] = np.unpackbits(feet[:, np.newaxis], axis=1).sum(
        axis=1, dtype=np.int64
    )
    return counts


def _longest_run(values: npt.NDArray[Any]) -> int:
    """Return the length of the longest run of equal values; runs of zeros do not count."""
    ends = np.flatnonzero(np.diff(values, prepend=-1, append=-1))
    runs = [int(b - a) for a, b in pairwise(ends) if values[a]]
    return max(runs, default=0)


def _most_common(values: npt.NDArray[Any]) -> tuple[int, int]:
    """Return the most common value and how often it occurs; zeros do not count.

    (0, 0): only zeros.
    """
    found, counts = np.unique(values[values != 0], return_counts=True)
    if not len(found):
        return 0, 0
    most = int(counts.argmax())
    return int(found[most]), int(counts[most])


def _pressed(keys: str, reply: TrialReply) -> tuple[str, ...]:
    """List the keys pressed in a trial; the last one comes from the reply.

    Keys without a level are of level B.
    """
    found = [_KEY.fullmatch(word.strip()) for word in keys.split(",")]
    before = [f"{(key[1] or 'B').upper()}{key[2]}" for key in found[:-1] if key]
    return (*before, f"{'AB'[reply.level]}{reply.key}")


def _short(value: float) -> float:
    """Round a number to three decimals, so that evidence stays small."""
    return round(float(value), 3)
