"""Read a robot file: TOML in degrees, metres and kilograms (rules 1, workshop 4-3).

First every entry is checked by itself, then the robot as a whole. A wrong number becomes NaN. A
check of the whole robot reports a mistake only if all numbers that it needs are right.
"""

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

from lacoc_robots.leg import Capsule, LegSpec, Point
from lacoc_robots.limits import Limits
from lacoc_robots.robot import RobotSpec
from lacoc_robots.toml_entries import Entries
from lacoc_shared.contest.toml_text import BadToml, read_toml
from lacoc_shared.gait.tables import JOINTS_PER_LEG, LEVEL_NAMES, Posture, leg_and_level
from lacoc_shared.mistakes import FileRefused, Mistake
from lacoc_shared.seat import BEAT_S
from lacoc_shared.words import Phrase, say

__all__ = ["Capsule", "LegSpec", "Limits", "Point", "RobotSpec", "read_robot"]

LARGEST_FILE = 32 * 1024
"""Largest robot file [bytes], the same as for gait files (rules 2)."""

BODY_MIN_M = 0.01
"""Smallest size of a body in any direction [m]."""
ANG_MIN_LEAST_DEG_S = 1.0
KP_LEAST = 1.0
"""Smallest stiffness of a servo [N m/rad]."""
TORQUE_LEAST_N_M = 0.1

_ROUNDING_KG = 1e-9  # rounding error of a sum of decimal masses
_ROUNDING_M = 1e-6  # lets a foot stand exactly on the floor


class _LinkEntries(NamedTuple):
    """The entries of [link], which hold for all legs; a leg may replace any of them."""

    lengths_m: tuple[float, ...]
    radius_m: float
    masses_kg: tuple[float, ...]
    range_deg: tuple[float, ...]


def read_robot(text: str | bytes, file: str, limits: Limits | None = None) -> RobotSpec:
    """Read a robot file (TOML; the sample `hexapod` explains every entry).

    Args:
        text: the file's content.
        file: its name, for error messages.
        limits: the contest's limits; None: the defaults of rules 1.

    Raises:
        FileRefused: with every mistake in the file.
    """
    mistakes: list[Mistake] = []
    root = Entries(_parse(text, file), "", file, mistakes)
    robot = _robot(root, limits or Limits())
    if mistakes:
        raise FileRefused(mistakes)
    return robot


def _parse(text: str | bytes, file: str) -> dict[str, object]:
    try:
        return read_toml(text, LARGEST_FILE, any_integers=True)
    except BadToml as error:
        expected = error.remedy or say("robot.toml", most=LARGEST_FILE)
        mistake = Mistake(file=file, found=error.reason, expected=expected, row=error.row)
        raise FileRefused([mistake]) from None


def _robot(root: Entries, limits: Limits) -> RobotSpec:
    """Read every table of a robot file, and make the robot.

    A wrong number is noted, and becomes NaN in the robot (0 in `hold_us`).
    """
    body, start = root.table("body"), root.table("start")
    drive, servo = root.table("drive", optional=True), root.table("servo", optional=True)
    surface = root.table("surface", optional=True)
    name = root.text("name", 24)
    size = body.numbers(
        "size_m",
        [(BODY_MIN_M, most_m) for most_m in (limits.width_m, limits.length_m, limits.height_m)],
        "m",
    )
    body_mass_kg = body.number("mass_kg", limits.part_mass_min_kg, limits.part_mass_max_kg, "kg")
    legs = _legs(root, size, limits)
    advance = drive.choice("advance", ("reached", "time"))
    hold_s = (
        drive.number("hold_s", BEAT_S, limits.hold_s, "s", with_time=True)
        if advance == "time"
        else drive.number("hold_s", 0.0, limits.hold_s, "s", default=0.0)
    )
    robot = RobotSpec(
        name=name,
        size_m=(size[0], size[1], size[2]),
        body_mass_kg=body_mass_kg,
        legs=legs,
        start_height_m=start.number("height_m", 0.0, 2 * limits.height_m, "m"),
        start_posture=_posture(start, legs, limits),
        ang_min_rad_s=math.radians(
            drive.number(
                "ang_min_deg_s",
                ANG_MIN_LEAST_DEG_S,
                limits.ang_min_deg_s,
                "degrees-per-second",
                default=120.0,
            )
        ),
        advance="time" if advance == "time" else "reached",
        hold_us=0 if math.isnan(hold_s) else round(hold_s * 1e6),
        kp=servo.number("kp", KP_LEAST, limits.kp_max, "N m/rad", default=20.0),
        kv=servo.number("kv", 0.0, limits.kv_max, "N m s/rad", default=0.5),
        torque_n_m=servo.number(
            "torque_n_m", TORQUE_LEAST_N_M, limits.torque_n_m, "N m", default=2.0
        ),
        damping=servo.number("damping", 0.0, limits.damping_max, "N m s/rad", default=0.02),
        armature=servo.number(
            "armature", limits.armature_min, limits.armature_max, "kg m2", default=0.002
        ),
        friction=surface.number("friction", 0.0, limits.friction_max, default=1.0),
    )
    for table in (root, body, start, drive, servo, surface):
        table.finish()
    _check_order(root, robot)
    _check_mass(root, robot, limits)
    _check_size(root, start, robot, limits)
    return robot


def _legs(root: Entries, size_m: tuple[float, ...], limits: Limits) -> tuple[LegSpec, ...]:
    link_table = root.table("link")
    default = _link(link_table, None, limits)
    link_table.finish()
    low, high = int(limits.legs_min), int(limits.legs_max)
    expected = say("robot.legs", low=low, high=high)
    tables = root.tables("leg", expected)
    if tables and (len(tables) % 2 or not low <= len(tables) <= high):
        root.note("leg", say("robot.count", count=len(tables)), expected)
    legs: list[LegSpec] = []
    for table in tables[:high]:
        leg = _leg(table, size_m, default, limits)
        table.finish()
        if leg.label and leg.label in (other.label for other in legs):
            again = say("robot.label-again", label=leg.label)
            table.note("label", again, say("robot.other-label"))
        legs.append(leg)
    return tuple(legs)


def _leg(
    table: Entries, size_m: tuple[float, ...], default: _LinkEntries, limits: Limits
) -> LegSpec:
    label = table.text("label", 8)
    position = _position(table, size_m, limits)
    outward_deg = table.number("outward_deg", -180.0, 360.0, "degrees")
    if abs(math.cos(math.radians(outward_deg))) < 0.01:
        table.note(
            "outward_deg",
            say("robot.forward-leg", degrees=outward_deg),
            say("robot.sideways-leg"),
        )
    link = _link(table, default, limits)
    return LegSpec(
        label=label,
        position_m=Point(*position),
        outward_rad=math.radians(outward_deg),
        lengths_m=(link.lengths_m[0], link.lengths_m[1], link.lengths_m[2]),
        radius_m=link.radius_m,
        masses_kg=(link.masses_kg[0], link.masses_kg[1], link.masses_kg[2]),
        range_rad=(math.radians(link.range_deg[0]), math.radians(link.range_deg[1])),
        accent=table.flag("accent"),
    )


def _position(table: Entries, size_m: tuple[float, ...], limits: Limits) -> tuple[float, ...]:
    """Read where a leg is fixed to the body.

    The place is given in metres, or as a share of the body, whose sides are at -1 and 1.
    """
    if "position_m" not in table:
        table.ask("on_body")
    if "position_m" not in table and "on_body" in table:
        table.ask("position_m")
        share = table.numbers("on_body", [(-1.0, 1.0)] * 3)
        return tuple(one * size / 2 for one, size in zip(share, size_m, strict=True))
    sizes = (limits.width_m, limits.length_m, limits.height_m)
    return table.numbers("position_m", [(-size / 2, size / 2) for size in sizes], "m")


def _link(table: Entries, default: _LinkEntries | None, limits: Limits) -> _LinkEntries:
    """Read the table [link], or a leg's own entries.

    Args:
        table: the table.
        default: the values of entries that a leg leaves out.
        limits: the contest's limits.
    """

    def own(name: str) -> bool:
        table.ask(name)
        return default is None or name in table

    link = default or _LinkEntries((), 0.0, (), ())
    bounds_m = (limits.link_min_m, limits.link_max_m)
    if own("lengths_m"):
        root_bounds_m = (limits.radius_min_m, limits.link_max_m)
        lengths = table.numbers("lengths_m", [root_bounds_m, bounds_m, bounds_m], "m")
        link = link._replace(lengths_m=lengths)
    if own("radius_m"):
        radius = table.number("radius_m", limits.radius_min_m, limits.radius_max_m, "m")
        link = link._replace(radius_m=radius)
    if own("masses_kg"):
        part_kg = (limits.part_mass_min_kg, limits.part_mass_max_kg)
        link = link._replace(masses_kg=table.numbers("masses_kg", [part_kg] * 3, "kg"))
    if own("range_deg"):
        widest_deg = (-limits.range_deg, limits.range_deg)
        low, high = table.numbers("range_deg", [widest_deg] * 2, "degrees")
        if low >= high:
            backwards = say("robot.range", low=low, high=high)
            table.note("range_deg", backwards, say("robot.smaller-first"))
        link = link._replace(range_deg=(low, high))
    if own("lengths_m") or own("radius_m"):
        shortest = (link.radius_m, 2 * link.radius_m, 2 * link.radius_m)
        for level, (length, least) in enumerate(zip(link.lengths_m, shortest, strict=True)):
            if length < least or (level > 0 and length == least):
                table.note(
                    "lengths_m",
                    say("robot.link", level=LEVEL_NAMES[level], length_m=length),
                    say("robot.link-lengths", radius_m=link.radius_m),
                )
    return link


def _posture(start: Entries, legs: tuple[LegSpec, ...], limits: Limits) -> Posture:
    if not legs:
        start.ask("posture_deg")
        return ()
    bounds, where = [], []
    for joint in range(JOINTS_PER_LEG * len(legs)):
        leg = legs[leg_and_level(joint, len(legs))[0]]
        low, high = leg.range_deg
        known = low < high
        bounds.append((low, high) if known else (-limits.range_deg, limits.range_deg))
        where.append({"joint": joint, "leg": leg.label or None})
    angles_deg = start.numbers("posture_deg", bounds, "degrees", where)
    return tuple(math.radians(angle) for angle in angles_deg)


def _check_order(root: Entries, robot: RobotSpec) -> None:
    """Check that legs are numbered clockwise from the right front, seen from above (rules 1)."""
    bearings = [math.atan2(leg.position_m.x, leg.position_m.y) % math.tau for leg in robot.legs]
    for i, (one, other) in enumerate(pairwise(bearings), 1):
        if other <= one:
            root.note(
                f"leg {i}, position_m",
                say("robot.not-clockwise", one=robot.labels[i], other=robot.labels[i - 1]),
                say("robot.clockwise"),
            )


def _check_mass(root: Entries, robot: RobotSpec, limits: Limits) -> None:
    low_kg, high_kg = limits.mass_min_kg, limits.mass_max_kg
    if robot.mass_kg < low_kg - _ROUNDING_KG or robot.mass_kg > high_kg + _ROUNDING_KG:
        root.note(
            "mass_kg and masses_kg",
            say("robot.together", kg=robot.mass_kg),
            say("robot.mass", low_kg=low_kg, high_kg=high_kg),
        )


def too_large(
    bounds: tuple[Point, Point], posture: Phrase, limits: Limits
) -> Iterator[tuple[Phrase, Phrase]]:
    """Yield the size found and the size allowed, for each size that is too large (rules 1).

    Args:
        bounds: lowest and highest x, y and z of the robot in a posture [m]; NaN: unknown.
        posture: name of the posture (`posture.*`).
        limits: the contest's limits.
    """
    low, high = bounds
    width_m, length_m, height_m = (b - a for a, b in zip(low, high, strict=True))
    for extent_m, most_m, found in (
        (width_m, limits.width_m, say("robot.wide", metres=width_m, posture=posture)),
        (length_m, limits.length_m, say("robot.long", metres=length_m, posture=posture)),
        (height_m, limits.height_m, say("robot.high", metres=height_m, posture=posture)),
    ):
        if extent_m > most_m + _ROUNDING_M:
            yield found, say("robot.size", most_m=most_m)


def _check_size(root: Entries, start: Entries, robot: RobotSpec, limits: Limits) -> None:
    """Check the robot's size with every angle 0 and in the start posture, and its start height.

    At the start height, the lowest part must be on the floor or at most `drop_m` above it.
    """
    zero = (0.0,) * robot.joints
    for posture, named in (
        (zero, say("posture.zero")),
        (robot.start_posture, say("posture.start")),
    ):
        for found, expected in too_large(_bounds(robot, posture), named, limits):
            root.note("", found, expected)
    lowest = _bounds(robot, robot.start_posture)[0].z + robot.start_z_m
    if lowest < -_ROUNDING_M or lowest > limits.drop_m + _ROUNDING_M:
        least_m = robot.start_height_m - lowest
        start.note(
            "height_m",
            say("robot.lowest-part", height_m=robot.start_height_m, lowest_m=lowest),
            say(
                "robot.start-height",
                low_m=math.ceil(least_m * 1e3) / 1e3,
                high_m=least_m + limits.drop_m,
            ),
        )


def _bounds(robot: RobotSpec, posture: Posture) -> tuple[Point, Point]:
    """Return the lowest and the highest x, y and z of a robot's parts in a posture.

    All are NaN if a number that is needed is not known.
    """
    ends = (c for capsule in robot.capsules(posture) for c in (*capsule.start, *capsule.end))
    radii = (leg.radius_m for leg in robot.legs)
    if any(map(math.isnan, (*robot.size_m, *ends, *radii))):
        unknown = Point(math.nan, math.nan, math.nan)
        return unknown, unknown
    return robot.bounds(posture)
