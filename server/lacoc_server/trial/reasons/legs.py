"""Finds legs that move differently from the others, and joints that jump or are at a limit."""

import math
import statistics
from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np

from lacoc_server.trial.reasons.form import TableCell
from lacoc_server.trial.reasons.seen import SeenTrial, TrialFinding
from lacoc_server.trial.steps import Steps, steps_of
from lacoc_shared.gait.tables import LEVEL_NAMES
from lacoc_shared.words import say

_AT_LIMIT_DEG = 0.5
SEAM_DEG, SEAM_RATIO = 12.0, 1.6
"""The seam is the step from the last posture to the first. A joint jumps there if its step is
larger than its largest other step by `SEAM_DEG` degrees, and also by the factor `SEAM_RATIO`."""
_MISSING = 1.5
"""In a cycle with an odd number of postures one is probably missing where the joints turn this many
times as far as in any other step."""
_STANDS, _STEP_M = 0.9, 0.005
"""A foot pushes the body if it is down for at least this share of the time and moves farther than
this [m]."""
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


def at_limits(seen: SeenTrial) -> Iterator[TrialFinding]:
    """Find the first angle that is within half a degree of an end of its joint's range."""
    form = seen.form
    cells = [
        TableCell(posture, level, leg)
        for posture in range(form.postures)
        for level in range(len(LEVEL_NAMES))
        for leg, spec in enumerate(seen.robot.legs)
        if _at_limit(form.degrees(TableCell(posture, level, leg)), spec.range_deg)
    ]
    if cells:
        first = cells[0]
        said = say("explain.limit", cell=form.name(first), angle_deg=form.degrees(first))
        yield TrialFinding(96, said, first.leg, first)


def _at_limit(angle_deg: float, range_deg: tuple[float, float]) -> bool:
    return any(abs(angle_deg - end) < _AT_LIMIT_DEG for end in range_deg)


def seam(seen: SeenTrial) -> Iterator[TrialFinding]:
    """Find the joint that jumps most from the last posture to the first, if one jumps there."""
    form, postures = seen.form, seen.form.postures
    if postures < 3:
        return
    jumps = []
    for leg in range(len(seen.walk.legs)):
        for level in range(len(LEVEL_NAMES)):
            angles = form.angles_deg[:, level, leg]
            steps = [abs(float(b - a)) for a, b in pairwise(angles)]
            seam_deg, other_deg = abs(float(angles[0] - angles[-1])), max(steps)
            if seam_deg > max(other_deg * SEAM_RATIO, other_deg + SEAM_DEG):
                jumps.append((seam_deg - other_deg, seam_deg, leg, level))
    if jumps:
        _, seam_deg, leg, level = max(jumps)
        last = TableCell(postures - 1, level, leg)
        said = say("explain.seam", cell=form.name(last), jump_deg=seam_deg)
        yield TrialFinding(80, said, leg, last)


def missing_posture(seen: SeenTrial) -> Iterator[TrialFinding]:
    """Find the step in which a posture is left out, in a cycle with an odd number of postures."""
    form = seen.form
    if form.postures < 3 or form.postures % 2 == 0:
        return
    turns = np.abs(np.roll(form.angles_deg, -1, axis=0) - form.angles_deg)
    ways = turns.sum(axis=(1, 2))
    row, other_deg = int(ways.argmax()), float(np.sort(ways)[-2])
    if ways[row] <= _MISSING * other_deg:
        return
    level, leg = np.unravel_index(int(turns[row].argmax()), turns[row].shape)
    cell = TableCell(row, int(level), int(leg))
    said = say(
        "explain.missing-posture",
        cell=form.name(cell),
        one=row + 1,
        other=(row + 1) % form.postures + 1,
        times=float(ways[row]) / other_deg,
    )
    yield TrialFinding(79, said, cell=cell)


def half_cycle(seen: SeenTrial) -> Iterator[TrialFinding]:
    """Find standing feet that push the body back while one key of level A follows another key."""
    if seen.before is None:
        return
    digit, posture = seen.before
    ahead_m = steps_of(seen.robot, (posture, *seen.form.sequence)).ahead_m
    moves_m = {
        leg: ahead[-1] - ahead[0]
        for leg, (ahead, share) in enumerate(zip(ahead_m, seen.figures.duty, strict=True))
        if share >= _STANDS
    }
    wrong = [leg for leg, move in moves_m.items() if move > _STEP_M]
    if not wrong:
        return
    cell = TableCell(0, 0, max(wrong, key=lambda leg: moves_m[leg]))
    said = say(
        "explain.half-back",
        cell=seen.form.name(cell),
        before=digit,
        row=seen.form.digit,
        legs=[seen.walk.legs[leg] for leg in wrong],
        others=[seen.walk.legs[leg] for leg, move in moves_m.items() if move < -_STEP_M],
    )
    yield TrialFinding(90, said, cell=cell)


def odd_legs(seen: SeenTrial) -> Iterator[TrialFinding]:
    """Find legs that differ from the others: they drag, push the wrong way or are out of step."""
    if seen.form.postures < 2 or not seen.figures.cycles:
        return
    labels, legs = seen.walk.legs, range(len(seen.walk.legs))
    steps = steps_of(seen.robot, seen.form.sequence)
    if not any(steps.stands):
        return
    highest_m, swing_m2 = steps.highest_m, steps.swing_m2
    usual_m, usual_m2 = statistics.median(highest_m), statistics.median(swing_m2)
    dragged = [leg for leg in legs if highest_m[leg] < _DRAGGED * usual_m and usual_m > _LIFT_M]
    for leg in dragged:
        at = _oddest(seen, leg, TableCell(steps.swings_to(leg), 1, leg), (1, 2))
        slip_mm_s = seen.figures.slip_legs_mm_s[leg]
        yield TrialFinding(
            70 + 1 - highest_m[leg] / usual_m,
            say("explain.dragged", leg=labels[leg], cell=seen.form.name(at), slip_mm_s=slip_mm_s),
            leg,
            at,
        )
    for leg in legs:
        against = -swing_m2[leg] * math.copysign(1, usual_m2)
        if against > _AGAINST * abs(usual_m2) > _AGAINST * _SWING_M2 and leg not in dragged:
            ahead = steps.ahead_m[leg]
            at = _oddest(seen, leg, TableCell(steps.swings_to(leg), 0, leg), (0,))
            yield TrialFinding(
                72 + min(1.0, against / abs(usual_m2)),
                say(
                    "explain.backward",
                    leg=labels[leg],
                    cell=seen.form.name(at),
                    push_mm=1000 * (max(ahead) - min(ahead)),
                ),
                leg,
                at,
            )
    yield from _out_of_step(seen, steps, [leg for leg in legs if leg not in dragged])


def _out_of_step(seen: SeenTrial, steps: Steps, legs: Sequence[int]) -> Iterator[TrialFinding]:
    """Find the one leg of `legs` that is lifted at another time than all others.

    Nothing is found if more than one leg is lifted at a time of its own.
    """
    if seen.form.postures < 3 or len(legs) < 4:
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
        at = _oddest(seen, leg, TableCell(steps.swings_to(leg), 1, leg), (0, 1, 2))
        yield TrialFinding(
            60 + gaps[leg],
            say(
                "explain.out-of-step",
                leg=seen.walk.legs[leg],
                cell=seen.form.name(at),
                apart_s=gaps[leg] * cycle_s,
                cycle_s=cycle_s,
            ),
            leg,
            at,
        )


def _turn(one: float, other: float) -> float:
    """Return the difference of two phases, from -0.5 to 0.5."""
    return (one - other + 0.5) % 1.0 - 0.5


def _oddest(seen: SeenTrial, leg: int, usual: TableCell, levels: Sequence[int]) -> TableCell:
    """Return the cell of a leg with the largest `KeyForm.odd_deg`; `usual` if all are 0."""
    cells = [seen.form.odd_cell(leg, level) for level in levels]
    oddest = max(cells, key=lambda cell: seen.form.odd_deg[cell])
    return oddest if seen.form.odd_deg[oddest] > 0 else usual
