"""Chooses the model that MuJoCo steps with the least work, from where the robots are.

In all models of a world robots move alike, as long as none comes near what a model leaves out.
A robot is inside a ball around the origin of its body, at all angles of its joints. So only the
places of the bodies count. They are looked at before each tick.
"""

import math
from collections.abc import Sequence
from itertools import combinations
from typing import Any, NamedTuple

import mujoco
import numpy as np
import numpy.typing as npt

from lacoc_server.world.models import Models, obstacles
from lacoc_server.world.robot import Robot, reach_m

_SKIN_M = 0.03
"""How far a body moves before the model is chosen again [m]."""
_TICK_M = 0.1
"""Assumed: two robots, or a robot and a wall, approach each other by less in a tick [m]: 5 m/s."""


class _Obstacle(NamedTuple):
    """A fixed geom: a plane, or anything inside a ball."""

    at_w: tuple[float, float, float]
    """A point of the plane, or the middle of the ball [m]."""
    normal_w: tuple[float, float, float] | None
    """The normal of the plane; None for a ball."""
    radius_m: float

    def gap_m(self, point_w: Sequence[float]) -> float:
        """Return how far a point is from the obstacle, at least [m]."""
        if self.normal_w is None:
            return math.dist(self.at_w, point_w) - self.radius_m
        apart = [there - here for there, here in zip(point_w, self.at_w, strict=True)]
        return sum(a * n for a, n in zip(apart, self.normal_w, strict=True))


class Nearness:
    """Chooses the model that is stepped.

    Args:
        models: the models of a world.
        qpos: the positions that are stepped; always the present ones.
        robots: the robots of the world.
    """

    def __init__(
        self, models: Models, qpos: npt.NDArray[np.float64], robots: Sequence[Robot]
    ) -> None:
        self.models = models
        model = models.stepped
        self._chosen: Any = model
        self._places: list[Any] = []
        """Views of where the bodies are; none if there is nothing to choose from."""
        self._moves: list[tuple[Any, Sequence[float]]] = []
        """Each view, and the place of the body when the model was chosen."""
        if models.clear is None and models.apart is None:
            return
        self._places = [qpos.data[robot.root_qpos : robot.root_qpos + 3] for robot in robots]
        self._moves = [(place, (math.nan,) * 3) for place in self._places]
        self._reaches_m = [
            max(reach_m(model, geom, model.body_rootid[model.geom_bodyid[geom]]) for geom in geoms)
            for geoms in (robot.geoms.tolist() for robot in robots)
        ]
        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        self._obstacles = [_obstacle(model, data, geom) for geom in obstacles(model)]

    def model(self) -> Any:
        """Return the model for the next tick."""
        for place, then in self._moves:
            if not math.dist(place.tolist(), then) <= _SKIN_M:  # the first time it is not a number
                now = [place.tolist() for place in self._places]
                self._moves = [*zip(self._places, now, strict=True)]
                self._chosen = self._choose(now)
                break
        return self._chosen

    def _choose(self, places_w: Sequence[Sequence[float]]) -> Any:
        """Return the model with the least work for these places of the robots."""
        models = self.models
        robots = [*zip(places_w, self._reaches_m, strict=True)]
        if models.apart is not None and all(
            math.dist(a, b) > reach_a + reach_b + 2 * _SKIN_M + _TICK_M
            for (a, reach_a), (b, reach_b) in combinations(robots, 2)
        ):
            return models.apart
        if models.clear is not None and all(
            obstacle.gap_m(place) > reach + _SKIN_M + _TICK_M
            for obstacle in self._obstacles
            for place, reach in robots
        ):
            return models.clear
        return models.stepped


def _obstacle(model: Any, data: Any, geom: int) -> _Obstacle:
    at_w = tuple(data.geom_xpos[geom].tolist())
    if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_PLANE:
        return _Obstacle(at_w, tuple(data.geom_xmat[geom][2::3].tolist()), 0.0)
    return _Obstacle(at_w, None, float(model.geom_rbound[geom]))
