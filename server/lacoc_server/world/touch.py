"""Finds the markers that the robots touch, once a tick; the touch exerts no force.

MuJoCo's distance between two geoms decides. It is computed only for pairs that may touch. These are
found in a top view, in which an upright probe is a circle, and two points are never farther apart
than in space. Which limbs are near a probe is found again only after the robot's body has moved a
little, as a neighbour list of molecular dynamics is.
"""

import math
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import mujoco
import numpy as np

from lacoc_server.world.robot import Robot
from lacoc_shared.messages import MarkerInfo

PROBE = "probe:"
"""Beginning of the name of a geom that robots touch; the name of its marker follows."""

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


class _Part(NamedTuple):
    """A geom of a robot, with a capsule around it along its z axis."""

    geom: int
    radius_m: float
    half_m: float
    """Half the distance between the centres of the capsule's two ends."""
    middle: int
    """Index of its centre in `geom_xpos`, taken as one row of numbers."""
    axes: int
    """Index of its orientation in `geom_xmat`, taken as one row of numbers."""


class _Limb(NamedTuple):
    """A leg, or the robot's own body."""

    parts: tuple[_Part, ...]
    origin: int
    """Index in `xpos`, taken as one row of numbers, of the origin of its first body."""
    reach_m: float
    """Upper bound of the distance of its points from that origin, at all joint angles."""


_Pair = tuple[_Probe, tuple[_Part, ...]]
"""A probe, and the parts of one robot that it may touch."""


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
        room_m = _TOUCH_M + abs(gap_m)
        gone = [robot for robot in self._robots if robot.has_gone(room_m)]
        if not gone and not any(robot.near for robot in self._robots):
            return self._none
        # After mj_step the geoms are still where the last step began.
        mujoco.mj_kinematics(self._model, self._data)
        for robot in gone:
            robot.look_around(room_m)
        return [robot.touched(gap_m, room_m) if robot.near else () for robot in self._robots]


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
        self._limbs, self._arm_m = _limbs(model, geoms)
        self._reach_m = self._arm_m + max(limb.reach_m for limb in self._limbs)
        self._probes = probes
        # Views into MuJoCo's own arrays: they always show the present values.
        self._pose = memoryview(data.qpos)[robot.root_qpos : robot.root_qpos + 7]
        self._origins_m = memoryview(data.xpos.reshape(-1))
        self._middles_m = memoryview(data.geom_xpos.reshape(-1))
        self._axes = memoryview(data.geom_xmat.reshape(-1))
        self._seen_from: Sequence[float] = [math.nan] * 7
        self._room_m = 0.0
        self.near: list[_Pair] = []
        """All pairs that may touch until the robot `has_gone`, in the order of the markers."""

    def has_gone(self, room_m: float) -> bool:
        """Return whether `near` may lack a pair with a distance of at most `room_m`."""
        now, then = self._pose.tolist(), self._seen_from
        turned = math.dist(now[3:], then[3:])  # a point at 1 m has moved at most twice as far
        gone_m = math.dist(now[:2], then[:2]) + 2 * self._arm_m * turned
        return not gone_m <= _SKIN_M or room_m > self._room_m

    def look_around(self, room_m: float) -> None:
        """Find the pairs that are `near`; the positions of bodies must be the present ones."""
        self._seen_from, self._room_m = self._pose.tolist(), room_m
        x_m, y_m = self._seen_from[:2]
        self.near = []
        for probe in self._probes:
            more_m = probe.radius_m + room_m + _SKIN_M
            if math.dist((x_m, y_m), (probe.x_m, probe.y_m)) <= self._reach_m + more_m:
                parts = tuple(self._parts_near(probe, more_m))
                if parts:
                    self.near.append((probe, parts))

    def _parts_near(self, probe: _Probe, more_m: float) -> Iterator[_Part]:
        for parts, origin, reach_m in self._limbs:
            x_m, y_m = self._origins_m[origin], self._origins_m[origin + 1]
            if math.dist((x_m, y_m), (probe.x_m, probe.y_m)) <= reach_m + more_m:
                yield from parts

    def touched(self, gap_m: float, room_m: float) -> tuple[int, ...]:
        """Find the markers whose probe the robot touches; geoms must be where they are now.

        Args:
            gap_m: the largest distance that counts as a touch.
            room_m: pairs that are farther apart than this in the top view don't touch.
        """
        middles_m, axes = self._middles_m, self._axes
        touched = []
        for probe, parts in self.near:
            _, probe_geom, probe_x_m, probe_y_m, probe_radius_m = probe
            around_m = probe_radius_m + room_m
            for geom, radius_m, half_m, middle, axis in parts:
                apart_m = radius_m + around_m
                x_m, y_m = probe_x_m - middles_m[middle], probe_y_m - middles_m[middle + 1]
                if x_m * x_m + y_m * y_m > (apart_m + half_m) ** 2:
                    continue
                if half_m:
                    end_x_m, end_y_m = half_m * axes[axis + 2], half_m * axes[axis + 5]
                    if _gap_m2(x_m, y_m, end_x_m, end_y_m) > apart_m * apart_m:
                        continue
                if self._distance_m(geom, probe_geom, room_m) <= gap_m:
                    touched.append(probe.marker)
                    break
        return tuple(touched)

    def _distance_m(self, geom: int, probe: int, most_m: float) -> float:
        model, data = self._model, self._data
        distance_m: float = mujoco.mj_geomDistance(model, data, geom, probe, most_m, None)
        return distance_m


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


def _part(model: Any, geom: int) -> _Part:
    radius_m, half_m, _ = model.geom_size[geom].tolist()
    if model.geom_type[geom] != mujoco.mjtGeom.mjGEOM_CAPSULE:
        radius_m, half_m = float(model.geom_rbound[geom]), 0.0
    return _Part(geom, radius_m, half_m, 3 * geom, 9 * geom)


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
        _Limb(
            tuple(_part(model, geom) for geom in own),
            3 * body,
            max(_reach_m(model, geom, body) for geom in own),
        )
        for body, own in limbs.items()
    ], max(arms_m)


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
    middle_m = np.linalg.norm(model.geom_pos[geom])
    reach_m = float(middle_m) + float(model.geom_rbound[geom])
    body = model.geom_bodyid[geom]
    while body != base:
        reach_m += float(np.linalg.norm(model.body_pos[body]))
        body = model.body_parentid[body]
    return reach_m
