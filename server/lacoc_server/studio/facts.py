"""The numbers of a robot file, and the limits of the rules for them (workshop 4-3, rules 1)."""

import math
from collections.abc import Iterable
from typing import Any

from lacoc_robots.limits import Limits
from lacoc_robots.robot import RobotSpec

Bounds = tuple[float | None, float | None]
"""Lowest and highest value that the rules allow; None: no limit on this side."""


def facts(robot: RobotSpec) -> dict[str, Any]:
    """List a robot's numbers by name; for what can differ between legs, the lowest and highest."""
    low, high = robot.bounds((0.0,) * robot.joints)
    width_m, length_m, height_m = (b - a for a, b in zip(low, high, strict=True))
    legs = robot.legs
    root_m, first_m, second_m = zip(*(leg.lengths_m for leg in legs), strict=True)
    return {
        "legs": len(legs),
        "joints": robot.joints,
        "width_m": _rounded(width_m),
        "length_m": _rounded(length_m),
        "height_m": _rounded(height_m),
        "body_width_m": robot.size_m[0],
        "body_length_m": robot.size_m[1],
        "body_height_m": robot.size_m[2],
        "mass_kg": _rounded(robot.mass_kg),
        "body_mass_kg": robot.body_mass_kg,
        "link_mass_kg": _pair(mass for leg in legs for mass in leg.masses_kg),
        "root_link_m": _pair(root_m),
        "first_link_m": _pair(first_m),
        "second_link_m": _pair(second_m),
        "link_radius_m": _pair(leg.radius_m for leg in legs),
        "range_deg": _pair(end for leg in legs for end in leg.range_deg),
        "drop_m": _rounded(robot.bounds(robot.start_posture)[0].z + robot.start_z_m),
        "ang_min_deg_s": _rounded(math.degrees(robot.ang_min_rad_s)),
        "advance": robot.advance,
        "hold_s": robot.hold_us / 1e6,
        "torque_n_m": robot.torque_n_m,
        "kp": robot.kp,
        "kv": robot.kv,
        "damping": robot.damping,
        "armature": robot.armature,
        "friction": robot.friction,
    }


def bounds(limits: Limits) -> dict[str, Bounds]:
    """List the limits of the rules for the numbers that `facts` gives, under the same names."""
    part_kg = limits.part_mass_min_kg, limits.part_mass_max_kg
    link_m = limits.link_min_m, limits.link_max_m
    return {
        "legs": (limits.legs_min, limits.legs_max),
        "width_m": (None, limits.width_m),
        "length_m": (None, limits.length_m),
        "height_m": (None, limits.height_m),
        "mass_kg": (limits.mass_min_kg, limits.mass_max_kg),
        "body_mass_kg": part_kg,
        "link_mass_kg": part_kg,
        "root_link_m": (limits.radius_min_m, limits.link_max_m),
        "first_link_m": link_m,
        "second_link_m": link_m,
        "link_radius_m": (limits.radius_min_m, limits.radius_max_m),
        "range_deg": (-limits.range_deg, limits.range_deg),
        "drop_m": (0.0, limits.drop_m),
        "ang_min_deg_s": (None, limits.ang_min_deg_s),
        "hold_s": (0.0, limits.hold_s),
        "torque_n_m": (None, limits.torque_n_m),
        "kp": (None, limits.kp_max),
        "kv": (0.0, limits.kv_max),
        "damping": (0.0, limits.damping_max),
        "armature": (limits.armature_min, limits.armature_max),
        "friction": (0.0, limits.friction_max),
    }


def _rounded(number: float) -> float:
    """Remove the rounding errors of sums and of radians."""
    return round(number, 6) + 0.0


def _pair(numbers: Iterable[float]) -> tuple[float, float]:
    known = list(numbers)
    return min(known), max(known)
