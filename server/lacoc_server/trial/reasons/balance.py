"""Finds when the feet do not carry the robot or it loses balance, and which number causes this."""

import math
from collections.abc import Iterator

import numpy as np

from lacoc_server.trial.feet import DOWN_SHARE
from lacoc_server.trial.figures import yaw_rad
from lacoc_server.trial.reasons.form import SAME_DEG, TableCell
from lacoc_server.trial.reasons.seen import SeenTrial, TrialFinding
from lacoc_server.trial.support import margins_m
from lacoc_server.trial.walk import Bools
from lacoc_shared.words import say

_BELLY, _FALLS = 0.05, 0.1
_CLEAR_M, _LOWER_M = 0.01, 0.003
"""If feet are lower than the body's underside by more than the first [m], they are low enough. A
number that could lower a foot by less than the second [m] is not the cause."""


def balance(seen: SeenTrial) -> Iterator[TrialFinding]:
    """Yield findings: how often no foot carries the robot, its belly does, or it loses balance."""
    figures = seen.figures
    hangs = seen.no_feet_share
    if min(hangs, figures.belly_share) > _BELLY:
        yield TrialFinding(58.5, say("explain.no-feet", percent=100 * hangs))
    if figures.belly_share > hangs + _BELLY:
        cell = _high_foot(seen)
        name = None if cell is None else seen.form.name(cell)
        said = say("explain.belly", percent=100 * figures.belly_share, cell=name)
        yield TrialFinding(58, said, cell=cell)
    falls = 1 - figures.stable_share - hangs
    if falls > _FALLS and figures.margin_low_mm is not None:
        cell = _foot_in_the_air(seen)
        said = say(
            "explain.unstable",
            percent=100 * falls,
            margin_mm=figures.margin_low_mm,
            leg=None if cell is None else seen.robot.labels[cell.leg],
            cell=None if cell is None else seen.form.name(cell),
        )
        yield TrialFinding(35, said, cell=cell)


def _high_foot(seen: SeenTrial) -> TableCell | None:
    """Find the number of the table that keeps a foot high while the body rests on the floor.

    It is searched in the posture in which the body rests most.

    Only the lower half of the feet is expected to carry the body. If these feet are low enough,
    the body rests on the floor for another reason: then return None.
    """
    walk, form, robot = seen.walk, seen.form, seen.robot
    rests = walk.other_load_n[seen.part] > DOWN_SHARE * walk.weight_n
    row = _most(seen, rests)
    angles = form.angles_deg[row]

    def height_m(leg: int, one: np.ndarray) -> float:
        """Return how high a leg's foot is above the body's underside."""
        tip = robot.legs[leg].points(*np.radians(one[:, leg]))[3]
        return tip.z + robot.size_m[2] / 2

    carry = sorted(range(form.legs), key=lambda leg: height_m(leg, angles))[: form.legs // 2]
    leg = carry[-1]
    if height_m(leg, angles) < -_CLEAR_M:
        return None
    lower_m = []
    for level in (1, 2):
        lowered = angles.copy()
        lowered[level] = np.minimum(angles[level], form.start_deg[level])
        lower_m.append(height_m(leg, angles) - height_m(leg, lowered))
    best = int(np.argmax(lower_m))
    return TableCell(row, best + 1, leg) if lower_m[best] > _LOWER_M else None


def _foot_in_the_air(seen: SeenTrial) -> TableCell | None:
    """Find the number of the table that lifts the foot on the side to which the robot falls."""
    walk, form, part = seen.walk, seen.form, seen.part
    down = walk.down[part]
    contact_w_m, centre_w_m = walk.contact_w_m[part], walk.centre_w_m[part]
    falls = margins_m(down, contact_w_m, centre_w_m) <= 0  # false where there is no margin
    row = _most(seen, falls)
    ticks = np.flatnonzero(falls & (walk.posture[part] == row))
    if not len(ticks):
        return None
    way = np.zeros(2)
    for tick in ticks:
        yaw = yaw_rad(walk.body_w[part][tick])
        x, y = centre_w_m[tick] - contact_w_m[tick, down[tick]].mean(axis=0)
        way += (
            x * math.cos(yaw) + y * math.sin(yaw),
            y * math.cos(yaw) - x * math.sin(yaw),
        )
    tips = [leg[3] for leg in seen.robot.points(form.sequence[row])]
    sides = {
        leg: float(way @ (tips[leg].x, tips[leg].y))
        for leg in range(form.legs)
        if 2 * down[ticks, leg].sum() < len(ticks)
    }
    leg = max(sides, key=lambda one: sides[one], default=-1)
    if leg < 0 or sides[leg] <= 0:
        return None
    low = np.minimum(form.angles_deg.min(axis=0), form.start_deg)
    above = (form.angles_deg[row] - low)[1:, leg]
    level = int(above.argmax())
    return TableCell(row, level + 1, leg) if above[level] > SAME_DEG else None


def _most(seen: SeenTrial, ticks: Bools) -> int:
    """Return the index of the posture to which the robot moves in most of the given ticks."""
    return int(np.bincount(seen.walk.posture[seen.part][ticks], minlength=1).argmax())
