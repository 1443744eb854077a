"""Finds the markers that the robots touch, once a tick; the touch exerts no force.

MuJoCo's distance between two geoms decides. It is computed only for pairs that may touch. These are
found in a top view, in which an upright probe is a circle, and two points are never farther apart
than in space. Probes far from a whole robot, or from a whole leg, are skipped at once.
"""

import math
from collections import defaultdict
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import mujoco
import numpy as np

from lacoc_server.world.robot import Robot
from lacoc_shared.messages import MarkerInfo

_TOUCH_M = 1e-3
"""Margin of the top view [m], larger than the error of MuJoCo's distance."""
_CELL_M = 0.04
"""Side of a square of the floor; each square lists the probes within a robot's reach."""


class _Probe(NamedTuple):
    """The geom of a marker that robots touch: it stands upright and never moves."""

    marker: int
    geom: int
    x_m: float
    y_m: float
    radius_m: float


class _Part(NamedTuple):
    """A geom of a robot, with a capsule around it along its z axis."""

    geom: int
    radius_m: float
    half_m: float
    """Half the distance between the centres of the capsule's two ends."""


class _Limb(NamedTuple):
    """A leg, or the robot's own body: a run of parts."""

    first: int
    """Index of its first part."""
    end: int
    """Index after its last part."""
    reach_m: float
    """Upper bound of the distance [m] of its points from its first part's centre, at all angles."""


class TouchTest:
    """Finds the markers that each robot touches.

    Args:
        model: the compiled model.
        data: its data, with the robots where they are now.
        robots: the robots, in the order of the seats.
        markers: markers of the game; the probe of a marker is the geom "probe:NAME".
    """

    def __init__(
        self, model: Any, data: Any, robots: Sequence[Robot], markers: Sequence[MarkerInfo]
    ) -> None:
        self._model, self._data = model, data
        mujoco.mj_kinematics(model, data)
        probes = list(_probes(model, data, markers))
        self._can_touch = bool(probes)
        """False if no marker has a probe: then robots touch nothing."""
        self._robots = [_Outline(model, data, robot, probes) for robot in robots]
        self._none: list[tuple[int, ...]] = [()] * len(robots)
        """The answer when no robot touches anything."""

    def __call__(self, gap_m: float = 0.0) -> Sequence[tuple[int, ...]]:
        """Return for each seat the indices of the markers that its robot touches, ascending.

        Args:
            gap_m: the largest distance that counts as a touch; negative: only deeper touches count.
        """
        if not self._can_touch:
            return self._none
        near = [robot.probes_near(gap_m) for robot in self._robots]
        if not any(near):
            return self._none
        # After mj_step the geoms are still where the last step began.
        mujoco.mj_kinematics(self._model, self._data)
        return [
            robot.touched(probes, gap_m) for robot, probes in zip(self._robots, near, strict=True)
        ]


class _Outline:
    """One robot, and the probes that it may touch.

    Args:
        model: the compiled model.
        data: its data.
        robot: the robot.
        probes: all probes, in the order of their markers.
    """

    def __init__(self, model: Any, data: Any, robot: Robot, probes: Sequence[_Probe]) -> None:
        self._model, self._data = model, data
        geoms = robot.geoms.tolist()  # MuJoCo numbers them body by body, outward along each leg
        self._parts = [_part(model, geom) for geom in geoms]
        self._limbs = _limbs(model, geoms)
        self._probes = probes
        # Views into MuJoCo's own arrays: they always show the present values.
        self._root_m = data.qpos[robot.root_qpos : robot.root_qpos + 2]
        self._middles_m = data.geom_xpos[geoms[0] : geoms[-1] + 1, :2]
        self._axes = data.geom_xmat[geoms[0] : geoms[-1] + 1, 2:6:3]  # x and y of the z axis
        root = model.geom_bodyid[geoms[0]]
        self._near = _map(probes, max(_reach_m(model, geom, root) for geom in geoms))

    def probes_near(self, gap_m: float) -> Sequence[_Probe]:
        """Return the probes near the robot's body: all that it may touch, and perhaps others."""
        if gap_m > 0:  # the map holds for real touches only
            return self._probes
        x_m, y_m = self._root_m.tolist()
        return self._near.get((x_m // _CELL_M, y_m // _CELL_M), ())

    def touched(self, probes: Sequence[_Probe], gap_m: float) -> tuple[int, ...]:
        """Find the markers whose probe the robot touches.

        Args:
            probes: the probes to test, in the order of their markers.
            gap_m: the largest distance that counts as a touch.
        """
        if not probes:
            return ()
        room_m = _TOUCH_M + abs(gap_m)
        middles_m, axes = self._middles_m.tolist(), self._axes.tolist()
        return tuple(
            probe.marker
            for probe in probes
            if any(
                self._distance_m(part, probe, room_m) <= gap_m
                for part in self._close(probe, room_m, middles_m, axes)
            )
        )

    def _close(
        self, probe: _Probe, room_m: float, middles_m: list[list[float]], axes: list[list[float]]
    ) -> Iterator[_Part]:
        """Yield all parts that may be at most `room_m` from a probe in the top view."""
        _, _, probe_x_m, probe_y_m, probe_radius_m = probe
        around_m = probe_radius_m + room_m
        for first, end, reach_m in self._limbs:
            x_m, y_m = middles_m[first]
            if (probe_x_m - x_m) ** 2 + (probe_y_m - y_m) ** 2 > (reach_m + around_m) ** 2:
                continue
            for index in range(first, end):
                part = self._parts[index]
                apart_m = part.radius_m + around_m
                x_m, y_m = middles_m[index]
                dx_m, dy_m = probe_x_m - x_m, probe_y_m - y_m
                gap_m2 = dx_m * dx_m + dy_m * dy_m
                if gap_m2 > (apart_m + part.half_m) ** 2:
                    continue
                axis_x, axis_y = axes[index]
                end_x_m, end_y_m = part.half_m * axis_x, part.half_m * axis_y
                if _gap_m2(dx_m, dy_m, end_x_m, end_y_m) <= apart_m * apart_m:
                    yield part

    def _distance_m(self, part: _Part, probe: _Probe, most_m: float) -> float:
        model, data = self._model, self._data
        distance_m: float = mujoco.mj_geomDistance(model, data, part.geom, probe.geom, most_m, None)
        return distance_m


def _gap_m2(x_m: float, y_m: float, end_x_m: float, end_y_m: float) -> float:
    """Return the squared distance of a point from the segment between -end and end."""
    along = x_m * end_x_m + y_m * end_y_m
    whole = end_x_m * end_x_m + end_y_m * end_y_m
    share = along / whole if abs(along) < whole else math.copysign(1.0, along)
    return (x_m - share * end_x_m) ** 2 + (y_m - share * end_y_m) ** 2


def _map(probes: Sequence[_Probe], reach_m: float) -> dict[tuple[float, float], list[_Probe]]:
    """Map each square of the floor to what a robot can touch while its body is in it.

    Args:
        probes: all probes.
        reach_m: upper bound of the distance of the robot's points from its body's origin [m].
    """
    near: dict[tuple[float, float], list[_Probe]] = defaultdict(list)
    for probe in probes:
        # The robot may be anywhere in the square, up to half a diagonal from its centre.
        apart_m = reach_m + probe.radius_m + _TOUCH_M + _CELL_M * math.sqrt(0.5)
        around = math.ceil(apart_m / _CELL_M)
        column, row = round(probe.x_m / _CELL_M), round(probe.y_m / _CELL_M)
        for i in range(column - around, column + around + 1):
            for j in range(row - around, row + around + 1):
                middle_m = ((i + 0.5) * _CELL_M, (j + 0.5) * _CELL_M)
                if math.dist(middle_m, (probe.x_m, probe.y_m)) <= apart_m:
                    near[i, j].append(probe)
    return dict(near)


def _probes(model: Any, data: Any, markers: Sequence[MarkerInfo]) -> Iterator[_Probe]:
    for marker, info in enumerate(markers):
        geom = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_GEOM, f"probe:{info.name}")
        if geom >= 0:
            x_m, y_m, _ = data.geom_xpos[geom].tolist()
            yield _Probe(marker, geom, x_m, y_m, float(model.geom_size[geom, 0]))


def _part(model: Any, geom: int) -> _Part:
    radius_m, half_m, _ = model.geom_size[geom].tolist()
    if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_CAPSULE:
        return _Part(geom, radius_m, half_m)
    return _Part(geom, float(model.geom_rbound[geom]), 0.0)


def _limbs(model: Any, geoms: Sequence[int]) -> list[_Limb]:
    """Split a robot into limbs: its body, then each leg from the root hinge outward."""
    bodies = [_limb_of(model, geom) for geom in geoms]
    limbs = []
    for body in dict.fromkeys(bodies):
        first, count = bodies.index(body), bodies.count(body)
        reach_m = max(_reach_m(model, geom, body) for geom in geoms[first : first + count])
        middle_m = _middle_m(model, geoms[first])
        limbs.append(_Limb(first, first + count, middle_m + reach_m))
    return limbs


def _limb_of(model: Any, geom: int) -> int:
    """Return the id of the body that a geom's limb begins with: a leg's first, or the main body."""
    body = model.geom_bodyid[geom]
    root = model.body_rootid[body]
    while body != root and model.body_parentid[body] != root:
        body = model.body_parentid[body]
    return int(body)


def _reach_m(model: Any, geom: int, base: int) -> float:
    """Return an upper bound [m] of the distance of a geom's points from the origin of `base`.

    The bound holds at all joint angles, because each hinge goes through the origin of its own body.
    """
    reach_m = _middle_m(model, geom) + float(model.geom_rbound[geom])
    body = model.geom_bodyid[geom]
    while body != base:
        reach_m += float(np.linalg.norm(model.body_pos[body]))
        body = model.body_parentid[body]
    return reach_m


def _middle_m(model: Any, geom: int) -> float:
    """Return the distance of a geom's centre from the origin of its body [m]."""
    return float(np.linalg.norm(model.geom_pos[geom]))
