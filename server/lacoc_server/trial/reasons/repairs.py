"""Lists the changes that would repair a table, each with its reason.

Each change undoes one mistake of a beginner: in a number, a joint, a leg, a row, a side, or half of
the rows. It changes signs, swaps two rows, shifts a leg in time, or copies the numbers of the
partners (the opposite legs, half a cycle later) or of another leg.
"""

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from lacoc_server.trial.reasons.form import SAME_DEG, KeyForm, TableCell
from lacoc_server.trial.walk import Floats
from lacoc_shared.gait.tables import LEVEL_NAMES
from lacoc_shared.words import Phrase, say

_LEAST_DEG = 8.0
"""The sign of an angle is not changed if the angle is smaller than this [deg]."""
_COPIED_DEG = 2.0


class Repair(NamedTuple):
    """A change of a table, and the mistake that it would repair."""

    said: Phrase
    """The sentence that names the mistake; its code is `explain.*`."""
    cell: TableCell
    """A cell with a wrong number, as an example of the mistake."""
    form: KeyForm
    """The repaired table."""
    rare: float
    """How improbable the mistake is before the table is seen, on the scale of
    `KeyForm.oddness_deg`."""
    leg: int = -1
    """Index of the leg with the mistake; -1: the mistake is not in a single leg."""


def partner_repairs(form: KeyForm) -> Iterator[Repair]:
    """List the repairs of mistakes that only a part of the table has."""
    yield from _cells(form)
    yield from _legs(form)
    if form.postures > 1:
        yield from _rows(form)
    if form.half:
        yield from _sides(form)
        yield from _halves(form)


def _cells(form: KeyForm) -> Iterator[Repair]:
    """Yield repairs of one number: the other sign, or the number of its partner or of a mate."""
    angles = form.angles_deg
    for at in np.ndindex(angles.shape):
        cell = TableCell(*at)
        if form.odd_deg[cell] <= 0:
            continue
        if abs(angles[cell]) >= _LEAST_DEG:
            partner = _alike(form, cell, -angles[cell])
            if partner is not None:
                said = say("explain.odd-sign", odd=_odd(form, cell, partner))
                yield Repair(said, cell, _with(form, at, -angles[cell]), 6, cell.leg)
        for partner in _partners(form, cell):
            if abs(angles[cell] - angles[partner]) > SAME_DEG:
                said = say("explain.odd-number", odd=_odd(form, cell, partner))
                yield Repair(said, cell, _with(form, at, angles[partner]), 8, cell.leg)


def _legs(form: KeyForm) -> Iterator[Repair]:
    """Yield repairs of a joint or a leg: the opposite leg's numbers, other signs, another time."""
    angles, odd = form.angles_deg, form.odd_deg
    for leg in range(form.legs):
        if odd[:, :, leg].max() <= 0:
            continue
        label = form.robot.labels[leg]
        for level in range(len(LEVEL_NAMES)):
            if odd[:, level, leg].max() <= 0:
                continue
            cell = form.odd_cell(leg, level)
            said = say(
                "explain.odd-joint-sign", cell=form.name(cell), leg=label, level=LEVEL_NAMES[level]
            )
            at = (slice(None), level, leg)
            yield Repair(said, cell, _with(form, at, -angles[at]), 12, leg)
            centre = angles[at].max() + angles[at].min()
            yield Repair(said, cell, _with(form, at, centre - angles[at]), 13, leg)
            if form.half:
                said = say("explain.odd-joint", odd=_odd(form, cell), leg=label)
                yield Repair(said, cell, _with(form, at, form.partners_deg[at]), 14, leg)
        cell = form.odd_cell(leg)
        whole = (slice(None), slice(None), leg)
        for late in range(1, form.postures):
            early = form.postures - late
            if late <= early:
                said = say("explain.too-early", cell=form.name(cell), leg=label, postures=late)
            else:
                said = say("explain.too-late", cell=form.name(cell), leg=label, postures=early)
            yield Repair(
                said, cell, _with(form, whole, np.roll(angles[whole], late, axis=0)), 10, leg
            )
        if form.half:
            said = say("explain.odd-leg", odd=_odd(form, cell), leg=label)
            yield Repair(said, cell, _with(form, whole, form.partners_deg[whole]), 18, leg)


def _rows(form: KeyForm) -> Iterator[Repair]:
    """Yield repairs of rows: two rows are swapped, or legs in a row get their partners' numbers."""
    angles = form.angles_deg
    for row in range(form.postures):
        for other in range(row + 1, form.postures):
            order = list(range(form.postures))
            order[row], order[other] = other, row
            moved = form.changed(angles[order])
            if np.abs(angles[row] - angles[other]).max() > SAME_DEG:
                cell = _oddest(form, row, angles[other])
                said = say(
                    "explain.swapped-rows", cell=form.name(cell), one=row + 1, other=other + 1
                )
                yield Repair(said, cell, moved, 14)
        if not form.half:
            continue
        partner = (row + form.half) % form.postures
        cell = _oddest(form, row, form.partners_deg[row])
        same = [
            other
            for other in range(form.postures)
            if other != row and np.abs(angles[row] - angles[other]).max() <= _COPIED_DEG
        ]
        for level in (*form.paired, None):
            at = (row, list(form.paired) if level is None else level)
            if same:
                said = say(
                    "explain.copied-row", cell=form.name(cell), one=row + 1, other=same[0] + 1
                )
            else:
                said = say("explain.odd-row", odd=_odd(form, cell), one=row + 1, other=partner + 1)
            rare = (20 if level is None else 22) - 4 * bool(same)
            yield Repair(said, cell, _with(form, at, form.partners_deg[at]), rare)


def _sides(form: KeyForm) -> Iterator[Repair]:
    """Yield repairs of a side: the other side's numbers, or the other sign at one joint level."""
    for side, name in ((1, "right"), (-1, "left")):
        legs = [leg for leg, spec in enumerate(form.robot.legs) if spec.side == side]
        levels: tuple[tuple[int, ...], ...] = ((0,), (1,), (2,), form.paired)
        for level in levels:
            if not set(level) <= set(form.paired):
                continue
            odd = form.odd_deg[:, level][:, :, legs]
            if odd.max() <= 0:
                continue
            row, at, leg = np.unravel_index(int(odd.argmax()), odd.shape)
            cell = TableCell(int(row), level[int(at)], legs[int(leg)])
            ix = np.ix_(range(form.postures), level, legs)
            if len(level) == 1:
                said = say(
                    "explain.side-sign",
                    cell=form.name(cell),
                    side=name,
                    level=LEVEL_NAMES[level[0]],
                )
                yield Repair(said, cell, _with(form, ix, -form.angles_deg[ix]), 18)
            said = say("explain.odd-side", odd=_odd(form, cell), side=name)
            yield Repair(said, cell, _with(form, ix, form.partners_deg[ix]), 30)


def _halves(form: KeyForm) -> Iterator[Repair]:
    """Yield repairs in which one half of the cycle becomes the mirror of the other half."""
    half = form.half
    for rows in (range(half, form.postures), range(half)):
        for level in ((0,), (1,), (2,), form.paired):
            if (half == 1 and len(level) > 1) or not set(level) <= set(form.paired):
                continue
            ix = np.ix_(rows, level, range(form.legs))
            odd = form.odd_deg[ix]
            row, at, leg = np.unravel_index(int(odd.argmax()), odd.shape)
            cell = TableCell(rows[int(row)], level[int(at)], int(leg))
            said = say(
                "explain.wrong-mirror",
                odd=_odd(form, cell),
                first=rows[0] + 1,
                last=rows[-1] + 1,
            )
            yield Repair(said, cell, _with(form, ix, form.partners_deg[ix]), 34 + 2 * len(level))


def _odd(form: KeyForm, cell: TableCell, partner: TableCell | None = None) -> Phrase:
    """Make the part of a sentence that compares a number with that of its partner or of a mate."""
    held = form.partner(cell) if partner is None else partner
    return say(
        "explain.odd",
        cell=form.name(cell),
        angle_deg=form.degrees(cell),
        partner=form.name(held),
        partner_deg=form.degrees(held),
    )


def _partners(form: KeyForm, cell: TableCell) -> Iterator[TableCell]:
    """Yield the cells that should have the same number as a cell: the opposite leg's, then mates'.

    For a Root, the mates are left out.
    """
    if form.half and cell.level in form.paired:
        yield form.partner(cell)
    if cell.level > 0:
        for leg in range(cell.leg % 2, form.legs, 2):
            if leg != cell.leg:
                yield TableCell(cell.posture, cell.level, leg)


def _alike(form: KeyForm, cell: TableCell, angle_deg: float) -> TableCell | None:
    """Find, among cells that should have the same number, one with about this angle; None: none."""
    near = (
        one
        for one in _partners(form, cell)
        if abs(form.degrees(one) - angle_deg) <= max(SAME_DEG, abs(angle_deg) / 2)
    )
    return next(near, None)


def _oddest(form: KeyForm, row: int, wanted_deg: Floats) -> TableCell:
    """Return the cell of a row that differs most from the wanted angles."""
    apart = np.abs(form.angles_deg[row] - wanted_deg)
    level, leg = np.unravel_index(int(apart.argmax()), apart.shape)
    return TableCell(row, int(level), int(leg))


def _with(form: KeyForm, at: Any, angles_deg: Floats | float) -> KeyForm:
    """Return the table with the angles at the indices `at` replaced."""
    angles = form.angles_deg.copy()
    angles[at] = angles_deg
    return form.changed(angles)
