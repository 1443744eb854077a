"""A robot as numbers: a box with legs, its servos, and its start (rules 1, workshop 4-3)."""

import math
from typing import Literal

import msgspec

from lacoc_robots.leg import Capsule, LegSpec, Point
from lacoc_shared.gait.tables import JOINTS_PER_LEG, Posture

NO_LOAD_SPEED = 3.0
"""Highest speed of a motor, as a multiple of AngMin. For the workshop's robot the result is the
speed of a common hobby servo, 60 degrees in 0.17 s."""


class RobotSpec(msgspec.Struct, frozen=True, kw_only=True):
    """A robot: a box with legs, its servos, and the posture and height in which it starts."""

    name: str
    size_m: tuple[float, float, float]
    """Size of the body: width (x), length (y), height (z) [m]."""
    body_mass_kg: float
    legs: tuple[LegSpec, ...]
    """The legs, clockwise from the right front, seen from above."""
    start_height_m: float
    """Height of the body's underside above the floor when the robot is put at a start place."""
    start_posture: Posture
    """(joints,) angles [rad], by joint id."""
    ang_min_rad_s: float
    """Speed with which commanded angles move to the target posture: the workshop's AngMin."""
    advance: Literal["reached", "time"]
    """When a sequence goes on to its next posture: see rules 3."""
    hold_us: int
    """How long a posture is held [µs], counted from when it is reached or from when it is
    commanded; `advance` says which."""
    kp: float
    """Servo stiffness [N m/rad]."""
    kv: float
    """Servo damping [N m s/rad]; if the motor's own damping, `back_emf`, is larger, that counts."""
    torque_n_m: float
    """Largest torque of a servo at rest, in either direction."""
    damping: float
    """Joint damping [N m s/rad]."""
    armature: float
    """Inertia of a motor at its joint [kg m2]."""
    friction: float
    """Coulomb friction coefficient between the robot and what it touches."""

    @property
    def joints(self) -> int:
        """Number of the robot's joints.

        The id of a joint is leg + number of legs * level (Root 0, 1st 1, 2nd 2).
        """
        return JOINTS_PER_LEG * len(self.legs)

    @property
    def labels(self) -> tuple[str, ...]:
        """The legs' labels, in leg order."""
        return tuple(leg.label for leg in self.legs)

    @property
    def ranges_rad(self) -> tuple[tuple[float, float], ...]:
        """Lowest and highest angle of each joint [rad], by joint id; (joints,)."""
        return tuple(leg.range_rad for _ in range(JOINTS_PER_LEG) for leg in self.legs)

    @property
    def ranges_deg(self) -> tuple[tuple[float, float], ...]:
        """Lowest and highest angle of each joint in the file's degrees, by joint id; (joints,)."""
        return tuple(leg.range_deg for _ in range(JOINTS_PER_LEG) for leg in self.legs)

    @property
    def mass_kg(self) -> float:
        """Mass of the whole robot."""
        return self.body_mass_kg + sum(mass for leg in self.legs for mass in leg.masses_kg)

    @property
    def no_load_rad_s(self) -> float:
        """Highest speed of a motor [rad/s].

        A motor's torque falls linearly with speed, and is 0 at this speed.
        """
        return NO_LOAD_SPEED * self.ang_min_rad_s

    @property
    def back_emf(self) -> float:
        """Torque that a motor loses per unit of speed [N m s/rad]."""
        return self.torque_n_m / self.no_load_rad_s

    @property
    def start_z_m(self) -> float:
        """Height of the body's origin above the floor when the robot is put at a start place."""
        return self.start_height_m + self.size_m[2] / 2

    @property
    def radius_m(self) -> float:
        """Largest horizontal distance of any part from the body's origin, in the start posture."""
        corner = math.hypot(self.size_m[0], self.size_m[1]) / 2
        return max(
            corner,
            *(
                math.hypot(end.x, end.y) + capsule.radius_m
                for capsule in self.capsules(self.start_posture)
                for end in (capsule.start, capsule.end)
            ),
        )

    def points(self, posture: Posture) -> tuple[tuple[Point, Point, Point, Point], ...]:
        """Compute the positions of every leg's root hinge, 1st hinge, 2nd hinge and tip.

        Args:
            posture: (joints,) angles [rad], by joint id.

        Returns:
            For each leg, in leg order, its four points in the body frame [m].
        """
        legs = len(self.legs)
        return tuple(leg.points(*posture[i::legs]) for i, leg in enumerate(self.legs))

    def capsules(self, posture: Posture) -> tuple[Capsule, ...]:
        """Compute the shapes of all links in a posture, leg by leg, in the body frame."""
        legs = len(self.legs)
        return tuple(
            capsule
            for i, leg in enumerate(self.legs)
            for capsule in leg.capsules(*posture[i::legs])
        )

    def bounds(self, posture: Posture) -> tuple[Point, Point]:
        """Compute the lowest and highest x, y and z of all parts in a posture (body frame)."""
        half = tuple(size / 2 for size in self.size_m)
        lows, highs = [tuple(-h for h in half)], [half]
        for capsule in self.capsules(posture):
            for end in (capsule.start, capsule.end):
                lows.append(tuple(at - capsule.radius_m for at in end))
                highs.append(tuple(at + capsule.radius_m for at in end))
        return Point(*map(min, zip(*lows, strict=True))), Point(*map(max, zip(*highs, strict=True)))
