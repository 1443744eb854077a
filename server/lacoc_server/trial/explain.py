"""Explains in at most three sentences why a robot walks as it does, the most useful first.

Each rule looks for situations of docs/studio.md 3. Its sentence names the leg, the table's cell or
the figure that shows the situation. A cause in the table usually comes before an effect.
"""

import math
import statistics
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

from lacoc_robots.robot import RobotSpec
from lacoc_server.trial.figures import Figures
from lacoc_server.trial.steps import Steps, steps_of
from lacoc_server.trial.walk import Press, Walk
from lacoc_shared.gait.tables import LEVEL_NAMES, Posture
from lacoc_shared.studio import CellPlace, Sentence
from lacoc_shared.words import Phrase, say

MOST_SENTENCES = 3

_TIPPED = 0.8
"""A robot has tipped over if its `upright` is below this: it leans by more than 37 degrees."""
_AT_LIMIT_DEG = 0.5
SEAM_DEG, SEAM_RATIO = 12.0, 1.6
"""The seam is the step from the last posture to the first. A joint jumps there if its step is
larger than its largest other step by `SEAM_DEG` degrees, and also by the factor `SEAM_RATIO`."""
_LIFT_M = 0.008
"""Legs are checked for dragging only if the median leg lifts its foot higher than this [m]."""
_DRAGGED = 0.35
"""A leg drags its foot if it lifts the foot less than this part of the median leg's lift."""
_SWING_M2, _AGAINST = 1e-4, 0.3
"""A leg pushes in the wrong direction if its foot swings against the other feet while it is lifted,
by more than `_AGAINST` of the median swing. The median swing must be larger than `_SWING_M2`."""
_APART = 0.12
"""A leg is out of step if the time at which it is lifted differs from that of each other leg by
more than this part of the cycle."""
_BELLY, _FALLS, _TURNS_DEG_S, _SLIDES_MM_S, _SLOW_MM_S = 0.05, 0.9, 3.0, 20.0, 15.0


class TrialFinding(NamedTuple):
    """A situation that a rule found."""

    rank: float
    """The finding with the highest rank is told first."""
    said: Phrase
    leg: int = -1
    """Index of the leg that the finding is about; -1: the whole robot."""
    cell: CellPlace | None = None


@dataclass(frozen=True)
class SeenTrial:
    """The trial that the rules look at."""

    robot: RobotSpec
    walk: Walk
    figures: Figures
    press: Press
    """The key that was measured."""
    sequence: tuple[Posture, ...]
    """Postures of this key's sequence [rad]."""

    def cell(self, posture: int, leg: int, level: int) -> Phrase:
        """Make the phrase that names a cell of the table."""
        return say(
            "explain.cell",
            key=self.press.digit,
            posture=posture + 1,
            postures=len(self.sequence),
            leg=self.walk.legs[leg],
            level=LEVEL_NAMES[level],
        )

    def place(self, posture: int, leg: int, level: int) -> CellPlace:
        """Return the place of a cell in the key's sequence."""
        return CellPlace(posture=posture, joint=leg + len(self.walk.legs) * level)

    def degrees(self, posture: int, leg: int, level: int) -> float:
        """Return the angle in a cell [deg]."""
        joint = leg + len(self.walk.legs) * level
        return math.degrees(self.sequence[posture][joint])


def explain(
    robot: RobotSpec, walk: Walk, figures: Figures, press: Press, sequence: Sequence[Posture]
) -> list[Sentence]:
    """Explain a walk.

    Args:
        robot: the robot.
        walk: the trial of the robot.
        figures: figures of the trial.
        press: the key that was measured.
        sequence: postures of the key [rad].

    Returns:
        At most `MOST_SENTENCES` sentences, the most useful first.
    """
    seen = SeenTrial(robot, walk, figures, press, tuple(sequence))
    found = [finding for rule in _RULES for finding in rule(seen)]
    found.sort(key=lambda finding: -finding.rank)
    return [
        Sentence(said=finding.said, cell=finding.cell, leg=finding.leg)
        for finding in found[:MOST_SENTENCES]
    ]


# Causes in the table.


def _limits(seen: SeenTrial) -> Iterator[TrialFinding]:
    """Find the first angle that is within half a degree of an end of its joint's range."""
    cells = [
        (posture, leg, level)
        for posture in range(len(seen.sequence))
        for level in range(len(LEVEL_NAMES))
        for leg, spec in enumerate(seen.robot.legs)
        if _at_limit(seen.degrees(posture, leg, level), spec.range_deg)
    ]
    if cells:
        first = cells[0]
        said = say("explain.limit", cell=seen.cell(*first), angle_deg=seen.degrees(*first))
        yield TrialFinding(90, said, first[1], seen.place(*first))


def _at_limit(angle_deg: float, range_deg: tuple[float, float]) -> bool:
    return any(abs(angle_deg - end) < _AT_LIMIT_DEG for end in range_deg)


def _seam(seen: SeenTrial) -> Iterator[TrialFinding]:
    """Find the joint that jumps most from the last posture to the first, if one jumps there."""
    postures = len(seen.sequence)
    if postures < 3:
        return
    jumps = []
    for leg in range(len(seen.walk.legs)):
        for level in range(len(LEVEL_NAMES)):
            angles = [seen.degrees(posture, leg, level) for posture in range(postures)]
            steps = [abs(b - a) for a, b in pairwise(angles)]
            seam_deg, other_deg = abs(angles[0] - angles[-1]), max(steps)
            if seam_deg > max(other_deg * SEAM_RATIO, other_deg + SEAM_DEG):
                jumps.append((seam_deg - other_deg, seam_deg, leg, level))
    if jumps:
        _, seam_deg, leg, level = max(jumps)
        last = postures - 1, leg, level
        said = say("explain.seam", cell=seen.cell(*last), jump_deg=seam_deg)
        yield TrialFinding(80, said, leg, seen.place(*last))


# Causes in the way a leg moves, as the table commands it.


def _legs(seen: SeenTrial) -> Iterator[TrialFinding]:
    """Find legs that differ from the others: they drag, push the wrong way or are out of step."""
    if len(seen.sequence) < 2 or not seen.figures.cycles:
        return
    labels, legs = seen.walk.legs, range(len(seen.walk.legs))
    steps = steps_of(seen.robot, seen.sequence)
    highest_m, swing_m2 = steps.highest_m, steps.swing_m2
    usual_m, usual_m2 = statistics.median(highest_m), statistics.median(swing_m2)
    dragged = [leg for leg in legs if highest_m[leg] < _DRAGGED * usual_m and usual_m > _LIFT_M]
    for leg in dragged:
        at = steps.swings_to(leg), leg, 1
        slip_mm_s = seen.figures.slip_legs_mm_s[leg]
        yield TrialFinding(
            70 + 1 - highest_m[leg] / usual_m,
            say("explain.dragged", leg=labels[leg], cell=seen.cell(*at), slip_mm_s=slip_mm_s),
            leg,
            seen.place(*at),
        )
    for leg in legs:
        against = -swing_m2[leg] * math.copysign(1, usual_m2)
        if against > _AGAINST * abs(usual_m2) > _AGAINST * _SWING_M2 and leg not in dragged:
            ahead, at = steps.ahead_m[leg], (steps.swings_to(leg), leg, 0)
            yield TrialFinding(
                72 + min(1.0, against / abs(usual_m2)),
                say(
                    "explain.backward",
                    leg=labels[leg],
                    cell=seen.cell(*at),
                    push_mm=1000 * (max(ahead) - min(ahead)),
                ),
                leg,
                seen.place(*at),
            )
    yield from _out_of_step(seen, steps, [leg for leg in legs if leg not in dragged])


def _out_of_step(seen: SeenTrial, steps: Steps, legs: Sequence[int]) -> Iterator[TrialFinding]:
    """Find the one leg of `legs` that is lifted at another time than all others.

    Nothing is found if several legs are lifted alone.
    """
    if len(seen.sequence) < 3 or len(legs) < 4:
        return
    phases = steps.phase
    gaps = {
        leg: min(abs(_turn(phases[leg], phases[other])) for other in legs if other != leg)
        for leg in legs
    }
    leg = max(gaps, key=lambda one: gaps[one])
    others = [gap for one, gap in gaps.items() if one != leg]
    if gaps[leg] > _APART and max(others) < _APART:
        cycle_s = seen.figures.cycle_s or 0.0
        at = steps.swings_to(leg), leg, 1
        yield TrialFinding(
            60 + gaps[leg],
            say(
                "explain.out-of-step",
                leg=seen.walk.legs[leg],
                cell=seen.cell(*at),
                apart_s=gaps[leg] * cycle_s,
                cycle_s=cycle_s,
            ),
            leg,
            seen.place(*at),
        )


def _turn(one: float, other: float) -> float:
    """Return the difference of two phases, from -0.5 to 0.5."""
    return (one - other + 0.5) % 1.0 - 0.5


# What physics shows.


def _ended(seen: SeenTrial) -> Iterator[TrialFinding]:
    """Say that physics stopped, or that the robot tipped over."""
    if seen.walk.fault is not None:
        yield TrialFinding(100, say("explain.fault", why=seen.walk.fault))
    elif seen.figures.upright < _TIPPED:
        lean_deg = math.degrees(math.acos(max(-1.0, seen.figures.upright)))
        yield TrialFinding(55, say("explain.tipped", lean_deg=lean_deg))


def _balance(seen: SeenTrial) -> Iterator[TrialFinding]:
    """Say how often parts other than feet rest on the floor, and how often balance is lost."""
    figures = seen.figures
    if figures.belly_share > _BELLY:
        yield TrialFinding(78, say("explain.belly", percent=100 * figures.belly_share))
    if figures.stable_share < _FALLS:
        percent = 100 * (1 - figures.stable_share)
        margin_mm = figures.margin_low_mm if figures.margin_low_mm is not None else 0.0
        yield TrialFinding(35, say("explain.unstable", percent=percent, margin_mm=margin_mm))


def _way(seen: SeenTrial) -> Iterator[TrialFinding]:
    """Say which of these are true: the robot turns, its feet slide, it goes forward."""
    figures = seen.figures
    if not figures.cycles:
        return
    speed_mm_s = abs(figures.speed_mm_s)
    if abs(figures.drift_deg_s) > _TURNS_DEG_S:
        side = "left" if figures.drift_deg_s > 0 else "right"
        drift_deg_s = abs(figures.drift_deg_s)
        yield TrialFinding(40, say("explain.turns", side=side, drift_deg_s=drift_deg_s))
    if figures.slip_mm_s > _SLIDES_MM_S:
        legs = figures.slip_legs_mm_s
        leg = max(range(len(legs)), key=legs.__getitem__)
        yield TrialFinding(
            30,
            say(
                "explain.slides",
                slip_mm_s=figures.slip_mm_s,
                speed_mm_s=speed_mm_s,
                leg=seen.walk.legs[leg],
                leg_mm_s=legs[leg],
            ),
            leg,
        )
    if figures.speed_mm_s > _SLOW_MM_S:
        yield TrialFinding(20, say("explain.walks", speed_mm_s=figures.speed_mm_s))


_RULES: tuple[Callable[[SeenTrial], Iterator[TrialFinding]], ...] = (
    _ended,
    _limits,
    _seam,
    _legs,
    _balance,
    _way,
)
