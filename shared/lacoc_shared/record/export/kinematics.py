"""Forward kinematics: compute every body's pose from a scene and the poses of a frame.

A page does the same computation to draw a frame; this one is for exports and for programs
that analyse a match. Quaternions are w, x, y, z.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lacoc_shared.messages import ROOT_FLOATS, Scene, Sheet

Array = NDArray[np.float64]
_AT_ORIGIN = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)


def joints_per_seat(sheet: Sheet) -> tuple[int, ...]:
    """Return the number of joints of each seat's robot; 0 for a seat without a robot."""
    return tuple(3 * len(seat.legs) for seat in sheet.seats)


def split_poses(poses: bytes, joints: Sequence[int]) -> tuple[Array, ...]:
    """Split `Frame.poses` into one array for the robot of each seat.

    Args:
        poses: as in a frame; not empty.
        joints: number of joints of each seat's robot.

    Returns:
        For each seat an array (7 + joints,): position [m], quaternion, joint angles [rad].

    Raises:
        ValueError: if `poses` has another length.
    """
    floats = np.frombuffer(poses, "<f4").astype(np.float64)
    ends = np.cumsum([ROOT_FLOATS + count for count in joints])
    if len(floats) != ends[-1]:
        raise ValueError(
            f"poses of {len(floats)} numbers, but robots of {list(joints)} joints have {ends[-1]}"
        )
    return tuple(np.split(floats, ends[:-1]))


class ForwardKinematics:
    """Computes the poses of the bodies of a scene from the poses in a frame.

    Args:
        scene: as the court sent it; every body comes after its parent.
        joints: number of joints of each seat's robot, as in the frames.
    """

    def __init__(self, scene: Scene, joints: Sequence[int]) -> None:
        self._bodies = scene.bodies
        starts = np.cumsum([0, *(ROOT_FLOATS + count for count in joints)])
        self._roots: dict[int, int] = {}
        self._angles: dict[int, int] = {}
        self.moving: list[int] = []
        """Indices of the bodies of robots; all other bodies stand still."""
        self.rest = np.concatenate(
            [np.zeros(0), *([*_AT_ORIGIN, *([0.0] * count)] for count in joints)]
        )
        """Poses of a frame with all robots at the origin and every angle 0: enough for bodies that
        don't move."""
        seats: list[int] = []
        for index, body in enumerate(scene.bodies):
            seats.append(body.seat if body.seat >= 0 or body.parent < 0 else seats[body.parent])
            if seats[index] >= 0:
                self.moving.append(index)
            if body.seat >= 0:
                self._roots[index] = int(starts[body.seat])
            elif body.joint >= 0:
                self._angles[index] = int(starts[seats[index]]) + ROOT_FLOATS + body.joint

    def poses(self, poses: Any) -> tuple[Array, Array]:
        """Compute every body's pose in the world.

        Args:
            poses: `Frame.poses` (not empty), or an array (..., numbers) of such poses: many
                frames together take little longer than one.

        Returns:
            Positions [m] (..., bodies, 3) and quaternions (..., bodies, 4), body to world.
        """
        numbers = np.frombuffer(poses, "<f4") if isinstance(poses, bytes) else np.asarray(poses)
        numbers = numbers.astype(np.float64)
        pos_w = np.empty((*numbers.shape[:-1], len(self._bodies), 3))
        quat_w = np.empty((*numbers.shape[:-1], len(self._bodies), 4))
        for index, body in enumerate(self._bodies):
            if index in self._roots:
                start = self._roots[index]
                pos_w[..., index, :] = numbers[..., start : start + 3]
                quat_w[..., index, :] = _unit(numbers[..., start + 3 : start + ROOT_FLOATS])
                continue
            pos, quat = np.array(body.pos), np.array(body.quat)
            if index in self._angles:
                quat = multiply(quat, _turn(body.axis, numbers[..., self._angles[index]]))
            if body.parent >= 0:
                parent = quat_w[..., body.parent, :]
                pos = pos_w[..., body.parent, :] + rotate(parent, pos)
                quat = multiply(parent, quat)
            pos_w[..., index, :] = pos
            quat_w[..., index, :] = quat
        return pos_w, quat_w


def multiply(first: Array, second: Array) -> Array:
    """Multiply quaternions (..., 4): the product turns by `second`, then by `first`."""
    w, v = first[..., :1], first[..., 1:]
    w2, v2 = second[..., :1], second[..., 1:]
    real = w * w2 - np.sum(v * v2, axis=-1, keepdims=True)
    return np.concatenate([real, w * v2 + w2 * v + np.cross(v, v2)], axis=-1)


def rotate(quat: Array, vector: Array) -> Array:
    """Turn vectors (..., 3) by unit quaternions (..., 4)."""
    v = quat[..., 1:]
    twice = 2.0 * np.cross(v, vector)
    turned: Array = vector + quat[..., :1] * twice + np.cross(v, twice)
    return turned


def euler_zyx(quat: Array) -> Array:
    """Convert unit quaternions (..., 4) to roll, pitch and yaw [rad] (..., 3).

    Euler ZYX: the body is turned by roll about x, then by pitch about y, then by yaw about
    z, all axes of the world. So yaw is 0 if the body's +y points along the world's +y (rules 2).
    """
    w, x, y, z = np.moveaxis(np.asarray(quat, dtype=np.float64), -1, 0)
    roll = np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    pitch = np.arcsin(np.clip(2 * (w * y - z * x), -1.0, 1.0))
    yaw = np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    return np.stack([roll, pitch, yaw], axis=-1)


def _turn(axis: Sequence[float], angle_rad: Array) -> Array:
    """Return the quaternions (..., 4) that turn by these angles about an axis of unit length."""
    half = np.asarray(angle_rad)[..., None] / 2
    return np.concatenate([np.cos(half), np.sin(half) * np.array(axis)], axis=-1)


def _unit(quat: Array) -> Array:
    """Normalise a frame's quaternion, whose length is not quite 1 after rounding to float32."""
    unit: Array = quat / np.linalg.norm(quat, axis=-1, keepdims=True)
    return unit
