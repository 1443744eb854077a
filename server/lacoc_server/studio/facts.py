"""Lists a robot's numbers and the limits that the rules set for them (docs/rules.md 1)."""

import math
from collections.abc import Iterable
from typing import Any

from lacoc_robots.leg import LegSpec
from lacoc_robots.limits import Limits
from lacoc_robots.robot import RobotSpec
from lacoc_robots.robot_file import ANG_MIN_LEAST_DEG_S, BODY_MIN_M, KP_LEAST, TORQUE_LEAST_N_M
from lacoc_shared.seat import BEAT_S
from lacoc_shared.studio import LegShape

Bounds = tuple[float | None, float | None]
"""Lowest and highest value that the rules allow; None: no limit on this side."""


def facts(robot: RobotSpec) -> dict[str, Any]:
    """List a robot's numbers by name.

    For a number that each leg has, give two: the lowest and the highest of all legs.
    """
    low, high = robot.bounds((0.0,) * robot.joints)
    width_m, length_m, height_m = (b - a for a, b in zip(low, high, strict=True))
    legs = robot.legs
    root_m, first_m, second_m = zip(*(leg.lengths_m for leg in legs), strict=True)
    root_kg, first_kg, second_kg = zip(*(leg.masses_kg for leg in legs), strict=True)
    low_deg, high_deg = zip(*(leg.range_deg for leg in legs), strict=True)
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
        "root_link_kg": _pair(root_kg),
        "first_link_kg": _pair(first_kg),
        "second_link_kg": _pair(second_kg),
        "root_link_m": _pair(root_m),
        "first_link_m": _pair(first_m),
        "second_link_m": _pair(second_m),
        "link_radius_m": _pair(leg.radius_m for leg in legs),
        "range_low_deg": _pair(low_deg),
        "range_high_deg": _pair(high_deg),
        "start_height_m": robot.start_height_m,
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


def leg_shape(leg: LegSpec) -> LegShape:
    """Return the shape of a leg in millimetres and degrees, for a page that draws and bends it."""
    x, y, z = (round(1000 * one, 6) for one in leg.position_m)
    l0, l1, l2 = (round(1000 * one, 6) for one in leg.lengths_m)
    return LegShape(
        label=leg.label,
        position_mm=(x, y, z),
        outward_deg=round(math.degrees(leg.outward_rad), 9),
        lengths_mm=(l0, l1, l2),
        range_deg=leg.range_deg,
    )


def bounds(robot: RobotSpec, limits: Limits) -> dict[str, Bounds]:
    """List the rules' limits for a robot by the names of `facts`.

    Numbers without limits are left out.
    """
    part_kg = limits.part_mass_min_kg, limits.part_mass_max_kg
    link_m = limits.link_min_m, limits.link_max_m
    return {
        "legs": (limits.legs_min, limits.legs_max),
        "width_m": (None, limits.width_m),
        "length_m": (None, limits.length_m),
        "height_m": (None, limits.height_m),
        "body_width_m": (BODY_MIN_M, limits.width_m),
        "body_length_m": (BODY_MIN_M, limits.length_m),
        "body_height_m": (BODY_MIN_M, limits.height_m),
        "mass_kg": (limits.mass_min_kg, limits.mass_max_kg),
        "body_mass_kg": part_kg,
        "root_link_kg": part_kg,
        "first_link_kg": part_kg,
        "second_link_kg": part_kg,
        "root_link_m": (limits.radius_min_m, limits.link_max_m),
        "first_link_m": link_m,
        "second_link_m": link_m,
        "link_radius_m": (limits.radius_min_m, limits.radius_max_m),
        "range_low_deg": (-limits.range_deg, limits.range_deg),
        "range_high_deg": (-limits.range_deg, limits.range_deg),
        "drop_m": (0.0, limits.drop_m),
        "ang_min_deg_s": (ANG_MIN_LEAST_DEG_S, limits.ang_min_deg_s),
        "hold_s": (BEAT_S if robot.advance == "time" else 0.0, limits.hold_s),
        "torque_n_m": (TORQUE_LEAST_N_M, limits.torque_n_m),
        "kp": (KP_LEAST, limits.kp_max),
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
