"""Change one number in the text of a robot file; everything else stays as it was written."""

import math
import tomllib
from collections.abc import Mapping
from typing import Any, Literal, NamedTuple, get_args

import tomlkit
from tomlkit.exceptions import TOMLKitError

from lacoc_robots.robot_file import LARGEST_FILE
from lacoc_shared.contest.toml_text import BadToml, read_toml
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

RobotEntry = Literal[
    "body_width_m",
    "body_length_m",
    "body_height_m",
    "body_mass_kg",
    "root_link_m",
    "first_link_m",
    "second_link_m",
    "link_radius_m",
    "root_link_kg",
    "first_link_kg",
    "second_link_kg",
    "range_low_deg",
    "range_high_deg",
    "start_height_m",
    "ang_min_deg_s",
    "hold_s",
    "torque_n_m",
    "kp",
    "kv",
    "damping",
    "armature",
    "friction",
]
"""A number of the whole robot, by its name in the facts that the studio sends."""
LegEntry = Literal["leg_x_m", "leg_y_m", "leg_z_m", "leg_outward_deg"]
"""A number of one leg: where it is fixed to the body, and where it points."""
AnyEntry = Literal[RobotEntry, LegEntry]


class _NumberPlace(NamedTuple):
    """Where a number stands in a robot file."""

    table: str
    name: str
    at: int | None = None
    """Place of the number in the entry's list; None: the entry is a single number."""


_PLACES: Mapping[AnyEntry, _NumberPlace] = {
    "body_width_m": _NumberPlace("body", "size_m", 0),
    "body_length_m": _NumberPlace("body", "size_m", 1),
    "body_height_m": _NumberPlace("body", "size_m", 2),
    "body_mass_kg": _NumberPlace("body", "mass_kg"),
    "root_link_m": _NumberPlace("link", "lengths_m", 0),
    "first_link_m": _NumberPlace("link", "lengths_m", 1),
    "second_link_m": _NumberPlace("link", "lengths_m", 2),
    "link_radius_m": _NumberPlace("link", "radius_m"),
    "root_link_kg": _NumberPlace("link", "masses_kg", 0),
    "first_link_kg": _NumberPlace("link", "masses_kg", 1),
    "second_link_kg": _NumberPlace("link", "masses_kg", 2),
    "range_low_deg": _NumberPlace("link", "range_deg", 0),
    "range_high_deg": _NumberPlace("link", "range_deg", 1),
    "start_height_m": _NumberPlace("start", "height_m"),
    "ang_min_deg_s": _NumberPlace("drive", "ang_min_deg_s"),
    "hold_s": _NumberPlace("drive", "hold_s"),
    "torque_n_m": _NumberPlace("servo", "torque_n_m"),
    "kp": _NumberPlace("servo", "kp"),
    "kv": _NumberPlace("servo", "kv"),
    "damping": _NumberPlace("servo", "damping"),
    "armature": _NumberPlace("servo", "armature"),
    "friction": _NumberPlace("surface", "friction"),
    "leg_x_m": _NumberPlace("leg", "position_m", 0),
    "leg_y_m": _NumberPlace("leg", "position_m", 1),
    "leg_z_m": _NumberPlace("leg", "position_m", 2),
    "leg_outward_deg": _NumberPlace("leg", "outward_deg"),
}
assert _PLACES.keys() == set(get_args(AnyEntry))
_SHARE_DIGITS = 9


def edit_robot(text: str, entry: AnyEntry, value: float, leg: int = 0) -> str:
    """Return the text of a robot file with one number changed.

    A number in [link] is changed for all legs, also for a leg with a value of its own. Where a leg
    is fixed in shares of the body (`on_body`), the share is changed.

    Args:
        text: the robot file (TOML).
        entry: which number.
        value: the new number, in the unit that the entry's name ends with. The limits of a robot
            are not checked here.
        leg: which leg, from 0; only for a `LegEntry`.

    Raises:
        UserError: if the text is no TOML, has no place for the number, or the number is not finite.
    """
    place = _PLACES[entry]
    if not math.isfinite(value):
        raise UserError(say("design.no-place", entry=_shown(place)))
    try:
        wanted = read_toml(text, LARGEST_FILE, any_integers=True)  # refuses what is hostile
    except BadToml as error:
        raise UserError(error.phrase) from None
    try:
        _set(wanted, place, value, leg)
        document = tomlkit.parse(text)
        _set(document, place, value, leg)
        edited = tomlkit.dumps(document)
        is_right = tomllib.loads(edited) == wanted
    except (TOMLKitError, ArithmeticError, LookupError, TypeError, ValueError):
        is_right = False
    if not is_right:
        raise UserError(say("design.no-place", entry=_shown(place)))
    return edited


def _set(robot: Any, place: _NumberPlace, value: float, leg: int) -> None:
    """Put a number into its place in a parsed robot file.

    A number of the table [link] is also put into each leg that has an entry of the same name.
    """
    if place.table == "leg":
        _set_leg(robot, robot["leg"][leg], place, value)
        return
    if place.table not in robot:
        robot[place.table] = {}
    tables = [robot[place.table]]
    if place.table == "link":
        tables += [leg for leg in robot.get("leg", ()) if place.name in leg]
    for table in tables:
        _put(table, place.name, place.at, value)


def _set_leg(robot: Any, leg: Any, place: _NumberPlace, value: float) -> None:
    """Put a number into its place in the entries of one leg."""
    name, at = place.name, place.at
    if at is not None and name not in leg:
        name = "on_body"
        value = round(2 * value / robot["body"]["size_m"][at], _SHARE_DIGITS)
    _put(leg, name, at, value)


def _put(table: Any, name: str, at: int | None, value: float) -> None:
    if at is None:
        table[name] = _like(table.get(name), value)
    else:
        numbers = table[name]
        numbers[at] = _like(numbers[at], value)


def _like(old: Any, value: float) -> Any:
    """Return a number as the old one is written: a whole one without a point if that has none."""
    if isinstance(old, int) and value == int(value):
        return int(value)
    return float(value)


def _shown(place: _NumberPlace) -> str:
    return f"{place.table}.{place.name}"
