"""Finds the markers that the robots touch, once a tick; the touch exerts no force.

MuJoCo's distance between two geoms decides. It is computed only for pairs that may touch. They are
found in a top view, in which an upright probe is a circle, and two points are never farther apart
than in space. The list of limbs near a probe is computed again only after the robot's body has
moved a little, like a neighbour list in molecular dynamics.
"""

import math
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import mujoco
import numpy as np
import numpy.typing as npt

from lacoc_server.world.models import PROBE
from lacoc_server.world.robot import Robot, reach_m
from lacoc_shared.messages import MarkerInfo

Floats = npt.NDArray[np.float64]

_TOUCH_M = 1e-3
"""Margin of the top view [m], larger than the error of MuJoCo's distance."""
_SKIN_M = 0.03
"""How far a body moves before the limbs near a probe are found again [m]."""


class _Probe(NamedTuple):
    """The geom of a marker that robots touch: it stands upright and never moves."""

    marker: int
    geom: int
    x_m: float
    y_m: float
    radius_m: float


class _RobotPart(NamedTuple):
    """A geom of a robot, with a capsule around it along its z axis."""

    geom: int
    radius_m: float
    half_m: float
    """Half the distance between the centres of the capsule's two ends."""
    reach_m: float
    """Upper bound of the distance of its points from the origin of its limb, at all angles [m]."""


class _Limb(NamedTuple):
    """A leg, or the robot's own body."""

    parts: tuple[_RobotPart, ...]
    body: int
    """Id of the body that the limb begins with; its origin is that of the limb."""


class _TouchPair(NamedTuple):
    """A part of a robot and a probe that it may touch."""

    geom: int
    half_m: float
    """`half_m` of the part."""
    middle_m2: float
    """Square of the largest distance of their centres in the top view at which they may touch."""
    axis_m2: float
    """Square of the largest distance of probe centre and part's axis at which they may touch."""


class TouchTest:
    """Finds the markers that each robot touches, in a model of its own.

    Args:
        model: a compiled model of the robots and the probes; a marker's probe is "probe:NAME".
        qpos: the positions of the robots, from the data that are stepped; always the present ones.
        robots: the robots of this model, in the order of the seats.
        markers: markers of the game.
    """

    def __init__(
        self, model: Any, qpos: Floats, robots: Sequence[Robot], markers: Sequence[MarkerInfo]
    ) -> None:
        self._model, self._data = model, mujoco.MjData(model)
        self._from, self._qpos = qpos, self._data.qpos
        self._look()
        probes = list(_probes(model, self._data, markers))
        self._robots = [_Outline(model, self._data, qpos, robot, probes) for robot in robots]

    def __call__(self, gap_m: float = 0.0) -> Sequence[tuple[int, ...]]:
        """Return for each seat the indices of the markers that its robot touches, ascending.

        Args:
            gap_m: the largest distance that counts as a touch; negative: only deeper touches count.
        """
        room_m, robots = _TOUCH_M + abs(gap_m), self._robots
        gone = [robot for robot in robots if robot.has_gone(room_m)]
        if gone or any(robot.near for robot in robots):
            self._look()
        for robot in gone:
            robot.look_around(room_m)
        return [robot.touched(gap_m, room_m) for robot in robots]

    def _look(self) -> None:
        """Compute the present positions of all geoms from `qpos`."""
        self._qpos[:] = self._from
        mujoco.mj_kinematics(self._model, self._data)


class _Outline:
    """One robot, and the probes that it may touch.

    Args:
        model: the compiled model.
        data: its data.
        qpos: the present positions of the robots.
        robot: the robot.
        probes: all probes, in the order of their markers.
    """

    def __init__(
        self, model: Any, data: Any, qpos: Floats, robot: Robot, probes: Sequence[_Probe]
    ) -> None:
        self._model, self._data = model, data
        geoms = robot.geoms.tolist()  # MuJoCo numbers them body by body, outward along each leg
        self._limbs, self._arm_m = _limbs(model, geoms)
        reaches_m = (part.reach_m for limb in self._limbs for part in limb.parts)
        self._reach_m = self._arm_m + max(reaches_m)
        self._probes = probes
        # Views: they always show the present values.
        self._pose: Any = qpos.data[robot.root_qpos : robot.root_qpos + 7]
        self._origins_m = data.xpos
        self._x_m, self._y_m = memoryview(data.geom_xpos[:, 0]), memoryview(data.geom_xpos[:, 1])
        # x and y of the geoms' z axes.
        self._axis_x, self._axis_y = (
            memoryview(data.geom_xmat[:, 2]),
            memoryview(data.geom_xmat[:, 5]),
        )
        self._seen_from: Sequence[float] = [math.nan] * 7
        self._room_m = 0.0
        self.near: list[tuple[_Probe, list[_TouchPair]]] = []
        """All pairs that may touch until the robot `has_gone`, by probe, in their order."""

    def has_gone(self, room_m: float) -> bool:
        """Return whether `near` may lack a pair with a distance of at most `room_m`."""
        now, then = self._pose.tolist(), self._seen_from
        turned = math.dist(now[3:], then[3:])  # a point at 1 m has moved at most twice as far
        gone_m = math.dist(now[:2], then[:2]) + 2 * self._arm_m * turned
        return not gone_m <= _SKIN_M or room_m > self._room_m

    def look_around(self, room_m: float) -> None:
        """Find the pairs that are `near`; the positions of bodies must be the present ones."""
        self._seen_from, self._room_m = self._pose.tolist(), room_m
        here_m = self._seen_from[:2]
        limbs = [(self._origins_m[limb.body, :2].tolist(), limb.parts) for limb in self._limbs]
        self.near = []
        for probe in self._probes:
            at_m = (probe.x_m, probe.y_m)
            apart_m = probe.radius_m + room_m
            if math.dist(here_m, at_m) <= self._reach_m + apart_m + _SKIN_M:
                pairs = [
                    _TouchPair(
                        part.geom,
                        part.half_m,
                        (part.half_m + part.radius_m + apart_m) ** 2,
                        (part.radius_m + apart_m) ** 2,
                    )
                    for origin_m, parts in limbs
                    for part in parts
                    if math.dist(origin_m, at_m) <= part.reach_m + apart_m + _SKIN_M
                ]
                if pairs:
                    self.near.append((probe, pairs))

    def touched(self, gap_m: float, room_m: float) -> tuple[int, ...]:
        """Find the markers whose probe the robot touches; geoms must be where they are now.

        Args:
            gap_m: the largest distance that counts as a touch.
            room_m: gap of a part and a probe in the top view [m] up to which they may touch.
        """
        model, data, distance_m = self._model, self._data, mujoco.mj_geomDistance
        x_m, y_m, axis_x, axis_y = self._x_m, self._y_m, self._axis_x, self._axis_y
        touched = []
        for (marker, probe, probe_x_m, probe_y_m, _), pairs in self.near:
            for geom, half_m, middle_m2, axis_m2 in pairs:
                dx_m, dy_m = probe_x_m - x_m[geom], probe_y_m - y_m[geom]
                if dx_m * dx_m + dy_m * dy_m > middle_m2:
                    continue
                if half_m:
                    end_x_m, end_y_m = half_m * axis_x[geom], half_m * axis_y[geom]
                    if _gap_m2(dx_m, dy_m, end_x_m, end_y_m) > axis_m2:
                        continue
                if distance_m(model, data, geom, probe, room_m, None) <= gap_m:
                    touched.append(marker)
                    break
        return tuple(touched)


def _gap_m2(x_m: float, y_m: float, end_x_m: float, end_y_m: float) -> float:
    """Return the squared distance of a point from the segment between -end and end."""
    along = x_m * end_x_m + y_m * end_y_m
    whole = end_x_m * end_x_m + end_y_m * end_y_m
    share = along / whole if abs(along) < whole else math.copysign(1.0, along)
    return (x_m - share * end_x_m) ** 2 + (y_m - share * end_y_m) ** 2


def _probes(model: Any, data: Any, markers: Sequence[MarkerInfo]) -> Iterator[_Probe]:
    for marker, info in enumerate(markers):
        geom = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_GEOM, f"{PROBE}{info.name}")
        if geom >= 0:
            x_m, y_m, _ = data.geom_xpos[geom].tolist()
            yield _Probe(marker, geom, x_m, y_m, float(model.geom_size[geom, 0]))


def _part(model: Any, geom: int, origin: int) -> _RobotPart:
    radius_m, half_m, _ = model.geom_size[geom].tolist()
    if model.geom_type[geom] != mujoco.mjtGeom.mjGEOM_CAPSULE:
        radius_m, half_m = float(model.geom_rbound[geom]), 0.0
    return _RobotPart(geom, radius_m, half_m, reach_m(model, geom, origin))


def _limbs(model: Any, geoms: Sequence[int]) -> tuple[list[_Limb], float]:
    """Split a robot into limbs: its body, then each leg from the root hinge outward.

    Returns:
        The limbs; and the largest distance of a limb's origin from the robot's origin [m].
    """
    limbs: dict[int, list[int]] = {}
    for geom in geoms:
        limbs.setdefault(_limb_of(model, geom), []).append(geom)
    root = model.body_rootid[model.geom_bodyid[geoms[0]]]
    arms_m = [float(np.linalg.norm(model.body_pos[body])) for body in limbs if body != root]
    return [
        _Limb(tuple(_part(model, geom, body) for geom in own), body) for body, own in limbs.items()
    ], max(arms_m)


def _limb_of(model: Any, geom: int) -> int:
    """Return the id of the body that a geom's limb begins with: a leg's first, or the main body."""
    body = model.geom_bodyid[geom]
    root = model.body_rootid[body]
    while body != root and model.body_parentid[body] != root:
        body = model.body_parentid[body]
    return int(body)
