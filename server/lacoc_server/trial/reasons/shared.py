"""Finds faults that all legs share, so that no partner has the right numbers, and their repairs."""

from collections.abc import Iterator

import numpy as np

from lacoc_server.trial.reasons.form import KeyForm, TableCell
from lacoc_server.trial.reasons.repairs import Repair
from lacoc_server.trial.steps import LIFT_M, steps_of
from lacoc_server.trial.walk import Floats
from lacoc_shared.gait.tables import LEVEL_NAMES
from lacoc_shared.words import Phrase, say

_SAME_DEG = 2.0
_RADIANS = 2.0
"""If all angles are smaller than this, they are probably in radians, but tables have degrees."""
_SWING_M = 0.006
"""A foot whose swing is shorter than this counts as not swinging [m]."""
_STEP_DEG = 20.0
"""Angle by which a repair turns the roots forward and back, for a first step [deg]."""
_LIFTS_DEG = ((2, 40.0), (1, 25.0), (1, 40.0))
"""Ways in which a repair lifts a foot: the joint's level, and the angle to add [deg]."""
_AREA_M2 = 1e-4


def same_feet_repairs(form: KeyForm) -> list[Repair]:
    """List the repair of a table in which the same feet carry the robot in all postures.

    When these feet swing back, they undo their push. The mistake is that postures are missing, not
    that a number is wrong: so the repair has the same table. Tables with 4, 6, 8 and so on postures
    are left out if legs are opposite: there a half that should mirror the other is the mistake.
    """
    steps = steps_of(form.robot, form.sequence)
    carries = steps.carries[0]
    if form.postures < 2 or form.half > 1 or all(carries):
        return []
    if any(one != carries for one in steps.carries):
        return []
    legs = [leg for leg, carrying in enumerate(carries) if carrying]
    swings_m = [max(steps.ahead_m[leg]) - min(steps.ahead_m[leg]) for leg in legs]
    if max(swings_m) < _SWING_M:
        return []
    leg = legs[swings_m.index(max(swings_m))]
    cell = TableCell(steps.swings_to(leg), 0, leg)
    labels = [form.robot.labels[one] for one in legs]
    said = say("explain.same-feet", cell=form.name(cell), legs=labels)
    return [Repair(said, cell, form, 5)]


def shared_repairs(form: KeyForm) -> Iterator[Repair]:
    """Yield the repairs of the first fault that all legs of the table share.

    Yield nothing if the table has no such fault.
    """
    angles = form.angles_deg
    if form.postures < 2:
        return
    largest = TableCell(*map(int, np.unravel_index(int(np.abs(angles).argmax()), angles.shape)))
    origin = TableCell(0, 0, 0)
    if not np.any(angles):
        yield from _steps(form, say("explain.zeros", cell=form.name(origin)), origin)
        return
    if np.abs(angles).max() < _RADIANS:
        said = say("explain.radians", cell=form.name(largest), angle_deg=form.degrees(largest))
        yield Repair(said, largest, form.changed(np.degrees(angles)), 5)
        return
    if np.ptp(angles, axis=0).max() < _SAME_DEG:
        cell = TableCell(1, 0, 0)
        yield from _steps(form, say("explain.equal-rows", cell=form.name(cell)), cell)
        return
    steps = steps_of(form.robot, form.sequence)
    lift = np.array(steps.lift_m).T  # (postures, legs)
    ahead = np.array(steps.ahead_m).T
    swings = int(np.ptp(ahead, axis=0).argmax())
    at = steps.swings_to(swings)
    if np.ptp(ahead, axis=0).max() < _SWING_M:
        cell = TableCell(int(lift.max(axis=1).argmax()), 0, int(lift.max(axis=0).argmax()))
        yield from _swung(form, say("explain.no-swing", cell=form.name(cell)), cell)
        return
    thrust = np.array(form.thrust_m2)
    signs = list(_lift_signs(form))
    if lift.max() < LIFT_M and signs:
        yield from signs
    elif lift.max() < LIFT_M:
        folds = np.ptp(angles[:, 1:], axis=0).max() > _SAME_DEG * 3
        row, level, leg = np.unravel_index(
            int(np.abs(angles[:, 1:] - angles[:, 1:].min(axis=0)).argmax()), angles[:, 1:].shape
        )
        cell = TableCell(int(row), int(level) + 1, int(leg)) if folds else TableCell(at, 1, swings)
        name = form.name(cell)
        said = say("explain.all-lifted", cell=name) if folds else say("explain.no-lift", cell=name)
        yield from _lifted(form, said, cell, 5)
    elif np.abs(thrust).max() < _AREA_M2 and any(steps.stands):
        cell = TableCell(at, 2, swings)
        said = say("explain.same-height", cell=form.name(cell), leg=form.robot.labels[swings])
        yield from _lifted(form, said, cell, 45)
    elif thrust.sum() < 0:
        yield from signs
        yield from _backward(form, thrust)


def _lift_signs(form: KeyForm) -> Iterator[Repair]:
    """Yield repairs that change the sign of all 1st or all 2nd joints, if the legs then push."""
    angles = form.angles_deg
    start = form.start_deg
    for level in (1, 2):
        mean = angles[:, level].mean(axis=0)
        stands_so = np.abs(mean + start[level]).sum() + 1 < np.abs(mean - start[level]).sum()
        all_minus = angles[:, level].max() <= _SAME_DEG and mean.min() < -_SAME_DEG
        if not (stands_so or all_minus):
            continue
        flipped = angles.copy()
        flipped[:, level] *= -1
        repaired = form.changed(flipped)
        if sum(repaired.thrust_m2) < _AREA_M2:
            continue
        at = np.unravel_index(int(np.abs(angles[:, level]).argmax()), angles[:, level].shape)
        cell = TableCell(int(at[0]), level, int(at[1]))
        said = say("explain.lift-sign", cell=form.name(cell), level=LEVEL_NAMES[level])
        yield Repair(said, cell, repaired, 5)


def _backward(form: KeyForm, thrust: Floats) -> Iterator[Repair]:
    """Yield two repairs: the other sign for all roots, and the rows in reverse order."""
    leg = int(thrust.argmin())
    cell = TableCell(steps_of(form.robot, form.sequence).swings_to(leg), 0, leg)
    angles = form.angles_deg
    flipped = angles.copy()
    flipped[:, 0] *= -1
    start = form.start_deg[0]
    mean = angles[:, 0].mean(axis=0)
    is_sign = np.abs(mean + start).sum() + 1 < np.abs(mean - start).sum()
    order = say("explain.backward-order", cell=form.name(cell))
    signs = say("explain.backward-signs", cell=form.name(cell))
    yield Repair(signs, cell, form.changed(flipped), 20 if is_sign else 26)
    yield Repair(order, cell, form.changed(angles[::-1]), 23)


def _lifted(form: KeyForm, said: Phrase, cell: TableCell, rare: float) -> Iterator[Repair]:
    """Yield repairs that lift half of the feet in half of the rows, the others in the rest."""
    angles = form.angles_deg
    half = form.postures // 2
    base = angles[:, 1:].min(axis=0)
    for level, by_deg in _LIFTS_DEG:
        for begin in range(form.postures):
            lifted = angles.copy()
            lifted[:, 1:] = base
            for row in range(form.postures):
                first = 0 if (row - begin) % form.postures < half else 1
                lifted[row, level, first::2] += by_deg
            yield Repair(said, cell, form.changed(lifted), rare)


def _swung(form: KeyForm, said: Phrase, cell: TableCell) -> Iterator[Repair]:
    """Yield repairs in which the roots swing, one half of the feet half a cycle after the other."""
    half = form.postures // 2
    for begin in range(form.postures):
        swung = form.angles_deg.copy()
        for row in range(form.postures):
            ahead = 1 if (row - begin) % form.postures < half else -1
            swung[row, 0, 0::2] += ahead * _STEP_DEG
            swung[row, 0, 1::2] -= ahead * _STEP_DEG
        yield Repair(said, cell, form.changed(swung), 20)


def _steps(form: KeyForm, said: Phrase, cell: TableCell) -> Iterator[Repair]:
    """Yield new tables: from the start posture, swing and lift half of the feet at a time."""
    flat = KeyForm(
        form.robot, np.repeat(form.start_deg[None], form.postures, axis=0), form.goal, form.digit
    )
    for one in _swung(flat, said, cell):
        yield from _lifted(one.form, said, cell, 5)
