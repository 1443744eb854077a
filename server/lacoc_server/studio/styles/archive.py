"""A map of gaits: a grid that keeps the best gait of each cell (MAP-Elites).

After Mouret and Clune, "Illuminating search spaces by mapping elites" (2015, arXiv:1504.04909).
"""

import math
from typing import NamedTuple

from lacoc_robots.robot import RobotSpec
from lacoc_server.studio.coach.goal import goal_score
from lacoc_server.studio.coach.table import Angles
from lacoc_server.trial.figures import Figures
from lacoc_server.trial.reasons.goal import Goal

_SPEEDS, _AROUSALS = 6, 5
"""Number of cells along each axis of the map."""
_SPEED_PART, _AROUSAL_PART = 1 / 15, 1 / 50
"""Size of a cell along each axis, as a part of a speed: that of a foot at a leg's length from a
joint which turns with AngMin. The cells of the workshop's robot are 20 and 6 mm/s wide."""
_OWN_PART = 1 / 3
"""A cell's size is at least this part of the value of the student's own gait on the axis, so that
the map has room for faster gaits."""
_STRAIGHT_DEG_S, _STRAIGHT_SIDE, _STRAIGHT_MM_S = 3.0, 0.25, 5.0
"""A gait is straight if it turns no faster than the first. Its speed sideways may be at most the
second times its speed forward, or the third if that is larger."""
_UPRIGHT = 0.9
_EQUAL_MM_S = 5.0
"""Scores are rounded down to multiples of this; of equal ones, the smaller change is better."""


class MapPlace(NamedTuple):
    """A cell of a map of gaits: index along each axis."""

    speed: int
    arousal: int


class MapGrid(NamedTuple):
    """The axes of a map of gaits: forward speed, and arousal (how excited a gait looks).

    Both axes begin at 0, and their last cells have no upper end.

    The calmest cell is twice as wide as the others, because its lower half would stay almost empty:
    a robot that lifts its feet at all is hardly ever so calm.
    """

    speed_mm_s: float
    """Width of a cell along the axis of forward speed."""
    arousal_mm_s: float
    """Width of a cell along the axis of arousal (how excited a gait looks)."""
    speeds: int = _SPEEDS
    arousals: int = _AROUSALS

    def place(self, figures: Figures) -> MapPlace | None:
        """Return the cell of a gait; None if it goes backward or has no cycle."""
        arousal = arousal_mm_s(figures)
        if arousal is None or figures.speed_mm_s < 0:
            return None
        return MapPlace(
            min(int(figures.speed_mm_s / self.speed_mm_s), self.speeds - 1),
            max(0, min(int(arousal / self.arousal_mm_s) - 1, self.arousals - 1)),
        )

    @property
    def speeds_mm_s(self) -> tuple[float, ...]:
        """Lower ends of the cells along the axis of forward speed."""
        return tuple(index * self.speed_mm_s for index in range(self.speeds))

    @property
    def arousals_mm_s(self) -> tuple[float, ...]:
        """Lower ends of the cells along the axis of arousal (how excited a gait looks)."""
        return (0.0, *(index * self.arousal_mm_s for index in range(2, self.arousals + 1)))


class Elite(NamedTuple):
    """The best gait of a cell of a map of gaits."""

    angles_deg: Angles
    figures: Figures
    worth: tuple[float, float]
    """Result of the function `worth`: of two gaits, the one with the larger value is kept."""


def arousal_mm_s(figures: Figures) -> float | None:
    """Return how excited a gait looks: height of the feet over the period; None without a cycle.

    A low and slow gait is calm, a high and quick one is excited (Karg et al., RO-MAN 2010,
    10.1109/ROMAN.2010.5598640).
    """
    return figures.clearance_mm / figures.cycle_s if figures.cycle_s else None


def grid_of(robot: RobotSpec, own: Figures) -> MapGrid:
    """Make the axes of a map of a robot's gaits, so that the student's own gait lies in it.

    Args:
        robot: the robot.
        own: figures of the student's own gait.
    """
    long_m = max(sum(leg.lengths_m[1:]) for leg in robot.legs)
    foot_mm_s = 1000 * robot.ang_min_rad_s * long_m
    speed_mm_s = max(_SPEED_PART * foot_mm_s, _OWN_PART * own.speed_mm_s)
    arousal = max(_AROUSAL_PART * foot_mm_s, _OWN_PART * (arousal_mm_s(own) or 0.0))
    return MapGrid(_whole(speed_mm_s, 5), _whole(arousal, 2))


def _whole(size_mm_s: float, step_mm_s: int) -> float:
    """Round a size to a multiple of the step, at least to one step [mm/s]."""
    return float(max(1, round(size_mm_s / step_mm_s)) * step_mm_s)


def is_sound(figures: Figures) -> bool:
    """Return whether a robot walks whole cycles, upright, and never rests on its body."""
    return figures.cycles > 0 and figures.upright >= _UPRIGHT and figures.belly_share == 0


def is_straight(figures: Figures) -> bool:
    """Return whether a robot walks straight ahead."""
    side_mm_s = max(_STRAIGHT_MM_S, _STRAIGHT_SIDE * figures.speed_mm_s)
    return abs(figures.drift_deg_s) <= _STRAIGHT_DEG_S and abs(figures.lateral_mm_s) <= side_mm_s


def worth(own: Angles, angles_deg: Angles, figures: Figures) -> tuple[float, float]:
    """Return the worth of a gait; of the gaits for one cell of the map the one worth most is kept.

    First the rounded score counts, then how little the gait differs from the student's own.
    """
    change_deg = sum(abs(a - b) for a, b in zip(own, angles_deg, strict=True))
    return math.floor(goal_score(figures, Goal.FORWARD) / _EQUAL_MM_S), -float(change_deg)


class Archive:
    """A map of gaits: keeps the best gait of each cell.

    Args:
        own: the student's own table.
        grid: the axes.
    """

    def __init__(self, own: Angles, grid: MapGrid) -> None:
        self.grid = grid
        self.elites: dict[MapPlace, Elite] = {}
        self._own = own

    def would_take(self, angles_deg: Angles, figures: Figures) -> bool:
        """Return whether a gait is sound, straight and better than the gait in its map cell."""
        place = self.grid.place(figures)
        if place is None or not (is_sound(figures) and is_straight(figures)):
            return False
        there = self.elites.get(place)
        return there is None or there.worth < worth(self._own, angles_deg, figures)

    def add(self, angles_deg: Angles, figures: Figures) -> bool:
        """Keep a gait if the map `would_take` it; return whether it was kept."""
        place = self.grid.place(figures)
        if place is None or not self.would_take(angles_deg, figures):
            return False
        self.elites[place] = Elite(angles_deg, figures, worth(self._own, angles_deg, figures))
        return True

    def empty_beside(self, place: MapPlace) -> int:
        """Count the empty cells beside a cell of the map: at most four."""
        beside = [
            MapPlace(place.speed + by, place.arousal + to)
            for by, to in ((1, 0), (-1, 0), (0, 1), (0, -1))
        ]
        return sum(
            0 <= one.speed < self.grid.speeds
            and 0 <= one.arousal < self.grid.arousals
            and one not in self.elites
            for one in beside
        )
