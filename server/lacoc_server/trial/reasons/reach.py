"""Finds legs that are lifted so high that their feet never reach the floor, and lowers them."""

from collections.abc import Iterator

import numpy as np

from lacoc_server.trial.reasons.form import SAME_DEG, KeyForm, TableCell
from lacoc_server.trial.reasons.repairs import Repair
from lacoc_server.trial.steps import steps_of
from lacoc_server.trial.walk import Floats
from lacoc_shared.gait.tables import LEVEL_NAMES
from lacoc_shared.words import say

_RARE = 5


def reach_repairs(form: KeyForm) -> list[Repair]:
    """List the repairs of a table in which too few feet ever reach the floor to stand on.

    Return no repair if half of the feet reach the floor at some time: then only a part of the table
    is wrong, and `partner_repairs` lists its repairs.
    """
    steps = steps_of(form.robot, form.sequence)
    low = [leg for leg in range(form.legs) if any(steps.reaches[leg])]
    high = [leg for leg in range(form.legs) if leg not in low]
    if any(steps.stands) or len(low) >= form.legs // 2:
        return []
    start = form.start_deg
    above = (form.angles_deg - start)[:, :, high]
    # The 1st lifts a foot most. If it comes down to a stand's angle, it is the 2nd.
    at = 1 if above[:, 1].min(axis=0).max() > SAME_DEG else 2
    row, leg = np.unravel_index(int(above[:, at].argmax()), above[:, at].shape)
    cell = TableCell(int(row), at, high[int(leg)])
    name, level = form.name(cell), LEVEL_NAMES[at]
    if low:
        labels = [form.robot.labels[one] for one in low]
        said = say("explain.few-reach", cell=name, legs=labels, level=level)
    else:
        said = say("explain.none-reaches", cell=name, level=level)
    lowered = [Repair(said, cell, one, _RARE) for one in _lowered(form, high, at, start)]
    standing = [one for one in lowered if any(steps_of(form.robot, one.form.sequence).stands)]
    return standing or lowered


def _lowered(form: KeyForm, high: list[int], level: int, start_deg: Floats) -> Iterator[KeyForm]:
    """Yield the table with the high legs lowered: by the joint `level`, then by 1st and 2nd.

    Each joint is lowered until its lowest number is that of the start posture.
    """
    for levels in ([level], [1, 2]):
        ix = np.ix_(range(form.postures), levels, high)
        angles = form.angles_deg.copy()
        by_deg = angles[ix].min(axis=0) - start_deg[np.ix_(levels, high)]
        angles[ix] -= np.maximum(0.0, by_deg)
        yield form.changed(angles)
