"""Changes a whole table in a visible way: a higher body, longer steps, a lean.

Each way (`Way`) changes, in all postures at once, where the feet are relative to the body. How far
a foot moves may differ from posture to posture. The angles that put the feet there are found
iteratively, beginning with those of the table, so a foot that does not move keeps its angles. The
unit is a step: one step of each way is about equally visible.
"""

import math
from collections.abc import Sequence
from enum import StrEnum

import numpy as np

from lacoc_robots.robot import RobotSpec
from lacoc_server.studio.coach.table import Angles, KeyTable
from lacoc_server.trial.walk import Floats

_LIFT, _STRIDE = 1.35, 1.3
"""Factors of one step of the ways `LIFT` and `STRIDE`: for a foot's lift, and for its stride."""
_SHIFT = 0.08
"""One step moves the body or the feet by this part of a leg's length (1st and 2nd link)."""
_LEAN_RAD = math.radians(4.0)
_FLAT = 0.02
"""Least lift or stride that is measured, as a part of a leg's length, so that ratios are finite."""
_ROUNDS, _DAMPING = 5, 0.05
"""How the angles are found: rounds of damped least squares (Wampler 1986,
10.1109/TSMC.1986.289285); the damping is a part of a leg's length."""


class Way(StrEnum):
    """A visible way in which a walk can change. Each value names its positive direction."""

    HEIGHT = "height"
    """The body is higher above the floor."""
    LIFT = "lift"
    """Feet are lifted higher."""
    STRIDE = "stride"
    """Feet swing farther forward and back."""
    WIDTH = "width"
    """Feet stand farther out to the sides."""
    LEAN = "lean"
    """The front is higher than the rear."""
    LIMP = "limp"
    """The feet on the right are lifted higher than those on the left."""
    BOB = "bob"
    """The body goes up and down twice a cycle."""
    SWAY = "sway"
    """The body goes from side to side once a cycle."""


WAYS = tuple(Way)


class Styles:
    """Measures how tables of one key look, and changes them in the ways of `WAYS`.

    Args:
        robot: the robot.
        table: the key's table; its rows and their order stay as they are.
    """

    def __init__(self, robot: RobotSpec, table: KeyTable) -> None:
        self._robot = robot
        self._rows = len(table.rows)
        lows, highs = zip(*robot.ranges_rad, strict=True)
        self._whole_ranges = (
            np.radians(np.ceil(np.degrees(lows) - 1e-6)),
            np.radians(np.floor(np.degrees(highs) + 1e-6)),
        )
        legs = robot.legs
        self._long_m = sum(sum(leg.lengths_m[1:]) for leg in legs) / len(legs)
        self._side = np.array([leg.side for leg in legs], float)
        phases = [table.order.index(row) / len(table.order) for row in range(self._rows)]
        turns = 2 * math.pi * np.array(phases)
        self._bob = np.cos(2 * turns)
        # Rows of the first half of a cycle stand on one half of the feet.
        self._sway = np.cos(turns - math.pi / len(table.order))

    def look(self, angles_deg: Angles) -> Floats:
        """Measure how a table looks in each way of `WAYS`, such as how high the body is.

        Returns:
            An array (ways,) with one measure for each way, in the order of `WAYS`. Its unit is one
            step of this way, as in `turned`.
        """
        tips_m = self._tips_m(self._rows_of(angles_deg))
        x, y, z = np.moveaxis(tips_m, 2, 0)
        low, flat = z.min(axis=0), _FLAT * self._long_m
        lifts = np.maximum(z.max(axis=0) - low, flat)
        strides = np.maximum(y.max(axis=0) - y.min(axis=0), flat)
        ahead = y.mean(axis=0) - y.mean()
        slope = (ahead * low).sum() / max((ahead**2).sum(), 1e-9)
        right = np.log(lifts)[self._side > 0].mean() - np.log(lifts)[self._side < 0].mean()
        shift = _SHIFT * self._long_m
        return np.array(
            [
                -low.mean() / shift,
                np.log(lifts).mean() / math.log(_LIFT),
                np.log(strides).mean() / math.log(_STRIDE),
                (x * self._side).mean() / shift,
                -math.atan(slope) / _LEAN_RAD,
                right / (2 * math.log(_LIFT)),
                -_share(z.min(axis=1), self._bob) / (shift / 2),
                -_share(x.mean(axis=1), self._sway) / shift,
            ]
        )

    def turned(self, angles_deg: Angles, steps: Sequence[float] | Floats) -> Angles:
        """Change a table by some steps in each way of `WAYS`, as far as the joints can move.

        Args:
            angles_deg: the table.
            steps: (ways,) number of steps in each way, in the order of `WAYS`; 0: no step.

        Returns:
            The new table; an angle that would change by less than half a degree stays.
        """
        height, lift, stride, width, lean, limp, bob, sway = (float(step) for step in steps)
        rows = self._rows_of(angles_deg)
        tips_m = self._tips_m(rows)
        _, y, z = np.moveaxis(tips_m, 2, 0)
        shift = _SHIFT * self._long_m
        wanted = tips_m.copy()
        wanted[:, :, 0] += width * shift * self._side - sway * shift * self._sway[:, None]
        wanted[:, :, 1] += (y - y.mean(axis=0)) * (_STRIDE**stride - 1)
        wanted[:, :, 2] += (z - z.min(axis=0)) * (_LIFT ** (lift + limp * self._side) - 1)
        wanted[:, :, 2] -= height * shift + math.tan(lean * _LEAN_RAD) * y
        wanted[:, :, 2] -= bob * shift / 2 * self._bob[:, None]
        found = np.degrees(self._reached(rows, wanted) - rows).ravel()
        return tuple(angle + round(float(by)) for angle, by in zip(angles_deg, found, strict=True))

    def between(self, one: Angles, other: Angles, part: float) -> Angles:
        """Mix two tables linearly: `part` 0 gives the first, 1 the other, and 2 lies beyond it."""
        return self.within(np.array(one) + part * (np.array(other) - np.array(one)))

    def within(self, angles_deg: Floats) -> Angles:
        """Return a table of whole degrees within the joints' ranges."""
        low, high = (np.tile(np.degrees(end), self._rows) for end in self._whole_ranges)
        return tuple(round(float(angle)) for angle in np.clip(angles_deg, low, high))

    def _rows_of(self, angles_deg: Angles) -> Floats:
        return np.array(np.radians(angles_deg), np.float64).reshape(self._rows, -1)

    def _tips_m(self, rows: Floats) -> Floats:
        """Return the positions of the legs' tips in the body frame: (rows, legs, 3) [m]."""
        tips = [[leg[3] for leg in self._robot.points(tuple(row))] for row in rows]
        return np.array(tips, np.float64)

    def _reached(self, rows: Floats, wanted_m: Floats) -> Floats:
        """Find angles (rows, joints) [rad] that put the leg tips at `wanted_m`; start at `rows`."""
        legs, step = len(self._robot.legs), 1e-5
        damping = (_DAMPING * self._long_m) ** 2 * np.eye(3)
        for _ in range(_ROUNDS):
            tips_m = self._tips_m(rows)
            columns = []
            for level in range(3):
                moved = rows.copy()
                moved[:, level * legs : (level + 1) * legs] += step
                columns.append((self._tips_m(moved) - tips_m) / step)
            slopes = np.stack(columns, axis=3)  # (rows, legs, 3 coordinates, 3 levels)
            turned = np.swapaxes(slopes, 2, 3)
            left = (wanted_m - tips_m)[..., None]
            by = (turned @ np.linalg.solve(slopes @ turned + damping, left))[..., 0]
            rows = rows + np.moveaxis(by, 2, 1).reshape(rows.shape)
            rows = np.array(np.clip(rows, *self._whole_ranges))
        return rows


def far_apart(looks: Sequence[Floats], count: int, taken: Sequence[Floats] = ()) -> list[int]:
    """Choose vectors that differ most: each time the one farthest from all chosen and taken ones.

    Args:
        looks: vectors of what can be chosen.
        count: how many to choose, at most all.
        taken: vectors that the choice must differ from.

    Returns:
        Indices of `looks`. If `taken` is empty, the first index is 0.
    """
    chosen: list[int] = []
    nearest = [min((_apart(look, one) for one in taken), default=math.inf) for look in looks]
    while len(chosen) < min(count, len(looks)):
        best = max((i for i in range(len(looks)) if i not in chosen), key=lambda i: nearest[i])
        chosen.append(best)
        nearest = [
            min(near, _apart(look, looks[best])) for near, look in zip(nearest, looks, strict=True)
        ]
    return chosen


def _apart(one: Floats, other: Floats) -> float:
    return float(np.linalg.norm(one - other))


def _share(values: Floats, wave: Floats) -> float:
    """Return how much of a wave is in the values: the slope of their regression on it."""
    wave = wave - wave.mean()
    return float((values * wave).sum() / max((wave**2).sum(), 1e-9))
