"""Steering for bots: read poses from frames, and choose keys that bring a robot to a point.

The keys are those of workshop Fig. 4-2, which every sample gait follows: [0] stand, [1] turn left,
[2] forward, [3] turn right, at the level of locomotion.
"""

import math
from struct import Struct
from typing import NamedTuple

from lacoc_arenas.bot import Brain, Key
from lacoc_shared.gait.tables import JOINTS_PER_LEG, Level
from lacoc_shared.messages import Frame, SeatFrame, Sheet
from lacoc_shared.seat import BEATS_PER_S, RESTART_KEY

STAND, TURN_LEFT, FORWARD, TURN_RIGHT = (Key(Level.LOCOMOTION, digit) for digit in range(4))
RESTART = Key(Level.LOCOMOTION, RESTART_KEY)

SPEED_M_S = 0.057
"""Walking speed of the sample hexapod; with other robots it is near enough for plans."""
TURN_RAD_S = math.radians(21)

_POSE = Struct("<7f")
_FLOAT_BYTES = 4

_STRAY_RAD = math.radians(16)
"""Half the angle by which one turn sequence turns the robot: at smaller bearings the robot
walks."""
_NEAR_M = 0.10
"""Nearer to the target than this, the robot walks at bearings up to `_NEAR_STRAY_RAD`, because the
bearing changes fast there.
"""
_NEAR_STRAY_RAD = math.radians(45)

_FALLEN_TICKS = 2 * BEATS_PER_S
_TANGLED_TICKS = 8 * BEATS_PER_S
_TANGLED_M = 0.36
"""Two robots that are this near for `_TANGLED_TICKS` count as caught in each other's legs."""
_STUCK_TICKS = 4 * BEATS_PER_S
_STUCK_M = 0.06
"""A robot that walks for `_STUCK_TICKS` and moves less than this counts as blocked."""
_EVADE_TICKS = 6 * BEATS_PER_S

_PASS_M = 0.42
"""Two robots whose centres are this near touch, or soon will."""
_AHEAD_RAD = math.radians(40)
_PASS_RAD = math.radians(75)
_WALL_M = 0.20
"""Least distance of a robot's centre from a wall."""


class Pose(NamedTuple):
    """The place, heading and tilt of a robot."""

    x_m: float
    y_m: float
    heading_rad: float
    """Direction of the body's +y (forward), counter-clockwise from the world's +x."""
    up: float
    """World z of the body's upward direction: 1 upright, -1 on its back."""

    def bearing_rad(self, x_m: float, y_m: float) -> float:
        """Return the angle by which the robot must turn left to face a point [rad], -pi to pi."""
        angle = math.atan2(y_m - self.y_m, x_m - self.x_m) - self.heading_rad
        return math.remainder(angle, math.tau)

    def distance_m(self, x_m: float, y_m: float) -> float:
        """Return the distance from the robot to a point on the floor [m]."""
        return math.hypot(x_m - self.x_m, y_m - self.y_m)

    def travel_s(self, x_m: float, y_m: float, reach_m: float = 0.0) -> float:
        """Return how long the robot needs to turn to a point and walk to `reach_m` from it [s]."""
        walk_m = max(0.0, self.distance_m(x_m, y_m) - reach_m)
        return abs(self.bearing_rad(x_m, y_m)) / TURN_RAD_S + walk_m / SPEED_M_S


class Eyes:
    """Reads the poses of all robots from the frames of one match."""

    def __init__(self, sheet: Sheet) -> None:
        self._offsets: list[int] = []
        offset = 0
        for seat in sheet.seats:
            self._offsets.append(offset)
            offset += _POSE.size + _FLOAT_BYTES * JOINTS_PER_LEG * len(seat.legs)

    def poses(self, frame: Frame) -> list[Pose]:
        """Return the pose of each robot, by seat; the frame must be of phase READY or later."""
        return [_pose(*_POSE.unpack_from(frame.poses, offset)) for offset in self._offsets]


def _pose(x: float, y: float, z: float, qw: float, qx: float, qy: float, qz: float) -> Pose:
    forward_x, forward_y = 2 * (qx * qy - qw * qz), 1 - 2 * (qx * qx + qz * qz)
    return Pose(x, y, math.atan2(forward_y, forward_x), 1 - 2 * (qx * qx + qy * qy))


class Pilot:
    """Chooses keys that bring one robot to a point: to turn, walk, pass the other robot, get free.

    Except for [x], it changes the key only where a sequence ends: half a step does not move the
    robot forward, and half a turn turns it the wrong way.
    """

    def __init__(self, sheet: Sheet, seat: int, size_m: tuple[float, float]) -> None:
        self._seat = seat
        self._postures = sheet.seats[seat].postures
        self._limits_m = tuple(size / 2 - _WALL_M for size in size_m)
        self._posture = 0
        self._upright_at = self._apart_at = self._seen = 0  # clock
        self._walked_ticks = 0
        self._mark_m = (0.0, 0.0)  # where it made its last progress
        self._evade: tuple[int, float] | None = None  # until which tick, and the heading

    def toward(
        self, frame: Frame, poses: list[Pose], target_m: tuple[float, float] | None
    ) -> Key | None:
        """Return the key to press now so that the robot comes nearer to a point, or [x].

        None keeps the present key.

        Args:
            frame: the newest frame.
            poses: the poses of all robots in this frame.
            target_m: the point (x, y); None to stand.
        """
        seat, now = frame.seats[self._seat], frame.clock_ticks
        if self._must_restart(poses, now):
            return RESTART
        self._watch_progress(poses, now, (seat.level, seat.key) == FORWARD)
        if not self._sequence_ended(seat) or seat.locked_ticks:
            return None
        wanted = STAND if target_m is None else self._steer(poses, target_m, now)
        return wanted if (seat.level, seat.key) != wanted else None

    def _sequence_ended(self, seat: SeatFrame) -> bool:
        """Say whether the robot has gone once through the sequence of its present key.

        At level A, for key 0 and for a key with a single posture the answer is always yes.
        """
        before, self._posture = self._posture, seat.posture
        if seat.level != Level.LOCOMOTION or seat.key == STAND.key:
            return True
        return seat.posture < before or self._postures[seat.key] == 1

    def _must_restart(self, poses: list[Pose], now: int) -> bool:
        """Say whether the robot has been on its back, or very near to another one, for too long."""
        pose = poses[self._seat]
        others = [other for other in poses if other is not pose]
        tangled = any(pose.distance_m(other.x_m, other.y_m) < _TANGLED_M for other in others)
        if pose.up >= 0:
            self._upright_at = now
        if not tangled:
            self._apart_at = now
        restart = now - self._upright_at >= _FALLEN_TICKS or now - self._apart_at >= _TANGLED_TICKS
        if restart:
            self._upright_at = self._apart_at = now
        return restart

    def _watch_progress(self, poses: list[Pose], now: int, walks: bool) -> None:
        """Walk in another direction for a while if the robot walks for long without progress."""
        pose = poses[self._seat]
        if pose.distance_m(*self._mark_m) > _STUCK_M:
            self._mark_m, self._walked_ticks = (pose.x_m, pose.y_m), 0
        elif walks:
            self._walked_ticks += now - self._seen
        self._seen = now
        if self._walked_ticks >= _STUCK_TICKS:
            away = [other for other in poses if other is not pose and _is_near(pose, other)]
            bearing_rad = (
                pose.bearing_rad(away[0].x_m, away[0].y_m) + math.pi
                if away
                else pose.bearing_rad(0.0, 0.0)
            )
            self._evade = (now + _EVADE_TICKS, pose.heading_rad + bearing_rad)
            self._walked_ticks = 0

    def _steer(self, poses: list[Pose], target_m: tuple[float, float], now: int) -> Key:
        pose = poses[self._seat]
        if self._evade is not None and now < self._evade[0]:
            return _key_for(self._evade[1] - pose.heading_rad, _STRAY_RAD)
        bearing_rad = pose.bearing_rad(*target_m)
        for other in poses:
            if other is not pose and _is_near(pose, other):
                bearing_rad = self._pass(pose, other, bearing_rad)
        near = pose.distance_m(*target_m) < _NEAR_M
        return _key_for(bearing_rad, _NEAR_STRAY_RAD if near else _STRAY_RAD)

    def _pass(self, pose: Pose, other: Pose, bearing_rad: float) -> float:
        """Return the bearing in which to walk, so that the robot passes the other one in its way.

        It passes on the right if there is room.
        """
        blocked_rad = pose.bearing_rad(other.x_m, other.y_m)
        if abs(math.remainder(bearing_rad - blocked_rad, math.tau)) > _AHEAD_RAD:
            return bearing_rad
        right_rad, left_rad = blocked_rad - _PASS_RAD, blocked_rad + _PASS_RAD
        return right_rad if self._is_free(pose, right_rad) else left_rad

    def _is_free(self, pose: Pose, bearing_rad: float) -> bool:
        """Say whether a robot that walks in this direction has room before the wall."""
        angle = pose.heading_rad + bearing_rad
        ahead_m = pose.x_m + _WALL_M * math.cos(angle), pose.y_m + _WALL_M * math.sin(angle)
        return all(abs(at) <= limit for at, limit in zip(ahead_m, self._limits_m, strict=True))


def _is_near(pose: Pose, other: Pose) -> bool:
    return pose.distance_m(other.x_m, other.y_m) < _PASS_M


def _key_for(bearing_rad: float, stray_rad: float) -> Key:
    """Return the key to walk if the bearing is at most `stray_rad`, else the key to turn to it."""
    bearing_rad = math.remainder(bearing_rad, math.tau)
    if abs(bearing_rad) <= stray_rad:
        return FORWARD
    return TURN_LEFT if bearing_rad > 0 else TURN_RIGHT


def straight(sheet: Sheet, seat: int) -> Brain:
    """Make a brain that walks straight ahead: the simplest bot of the games for two."""

    def brain(frame: Frame) -> Key | None:
        standing = frame.seats[seat]
        locked = standing.locked_ticks > 0
        return None if locked or (standing.level, standing.key) == FORWARD else FORWARD

    return brain
