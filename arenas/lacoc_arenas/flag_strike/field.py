"""The field of Flag-Strike: corners, flags that stand or lie, and poles that show a touch.

The pole of a flag is "probe:NAME": a cylinder without contacts. Its distance to the robots is
measured after each tick; a robot that reaches it touches the flag (rules 6).
"""

import math

import mujoco

from lacoc_arenas import field
from lacoc_arenas.game import DOWN, LEFT, NEUTRAL, RIGHT
from lacoc_shared.messages import MARKER_STATES

from .rules import FlagStrike
from .settings import Flag

HIDDEN_GROUP = 4
"""Geoms of this group are not drawn."""

_RIM_M, _RIM_TOP_M, _CORNER_TOP_M, _PAD_TOP_M = 0.008, 0.0015, 0.003, 0.001
_THIN_M = 0.002


def build(spec: mujoco.MjSpec, game: FlagStrike) -> None:
    """Add floor, walls, start pads, corners and flags with their probes (poles) to a model."""
    field.ground(spec, game.size_m)
    settings = game.settings
    for number, (left, right) in enumerate(zip(*game.starts, strict=True)):
        for seat, place in (("left", left), ("right", right)):
            name = f"pad:{seat}{number}"
            # Square, because round shapes are worth points here.
            half_m = 0.5 * settings.corner_radius_m
            size = [half_m, half_m, _PAD_TOP_M / 2]
            pos = [place.x_m, place.y_m, _PAD_TOP_M / 2]
            field.shape(spec, name, field.BOX, size, pos, field.PANEL)
    for corner in game.markers[: len(settings.corners)]:
        at_m = (corner.x_m, corner.y_m)
        field.disc(spec, f"rim:{corner.name}", at_m, corner.radius_m, _RIM_TOP_M, field.RIM)
        for state in (NEUTRAL, LEFT, RIGHT):
            name = field.marker_geom(corner.name, state)
            tint = field.TINTS[MARKER_STATES[state]]
            field.disc(spec, name, at_m, corner.radius_m - _RIM_M, _CORNER_TOP_M, tint)
    for flag in settings.flags:
        _probe(spec, flag, settings.pole_radius_m, settings.pole_height_m)
        _standing(spec, flag, settings.pole_radius_m, settings.pole_height_m)
        for state in (LEFT, RIGHT, DOWN):
            _lying(spec, flag, state, settings.pole_radius_m, settings.pole_height_m)


def _cloth_m(flag: Flag, height_m: float) -> tuple[float, float]:
    """Return half the length and half the height of a flag's cloth [m].

    The cloth is larger for a flag with more points, so that one sees the points without the colour.
    """
    size = 0.16 + 0.03 * min(flag.colour.points, 6)
    return size * height_m, 0.6 * size * height_m


def _probe(spec: mujoco.MjSpec, flag: Flag, radius_m: float, height_m: float) -> None:
    pos = [flag.x_m, flag.y_m, height_m / 2]
    size = [radius_m, height_m / 2]
    clear = (0.0, 0.0, 0.0, 0.0)
    name = f"probe:{flag.name}"
    field.shape(spec, name, field.CYLINDER, size, pos, clear, group=HIDDEN_GROUP)


def _standing(spec: mujoco.MjSpec, flag: Flag, radius_m: float, height_m: float) -> None:
    """Add a standing flag: its pole, and a cloth that points counter-clockwise round the field."""
    along = _along(flag)
    length_m, depth_m = _cloth_m(flag, height_m)
    pole = field.marker_geom(flag.name, NEUTRAL, "pole")
    pos = [flag.x_m, flag.y_m, height_m / 2]
    field.shape(spec, pole, field.CYLINDER, [radius_m, height_m / 2], pos, field.POLE)
    reach_m = radius_m + length_m
    field.shape(
        spec,
        field.marker_geom(flag.name, NEUTRAL, "cloth"),
        field.BOX,
        [length_m, 2 * _THIN_M, depth_m],
        [
            flag.x_m + reach_m * math.cos(along),
            flag.y_m + reach_m * math.sin(along),
            height_m - depth_m,
        ],
        field.rgba(flag.colour.rgb),
        quat=_about_z(along),
    )


def _lying(spec: mujoco.MjSpec, flag: Flag, state: int, radius_m: float, height_m: float) -> None:
    """Add a flag that lies on the floor: its cloth, and its pole unless the state is DOWN."""
    along = _along(flag)
    ux, uy = math.cos(along), math.sin(along)
    length_m, depth_m = _cloth_m(flag, height_m)
    tint = field.TINTS[MARKER_STATES[state]]
    if state != DOWN:
        field.shape(
            spec,
            field.marker_geom(flag.name, state, "pole"),
            field.BOX,
            [height_m / 2, radius_m / 2, _THIN_M],
            [flag.x_m + ux * height_m / 2, flag.y_m + uy * height_m / 2, _THIN_M],
            field.POLE,
            quat=_about_z(along),
        )
    at_m, beside_m = height_m - depth_m, length_m + radius_m / 2
    field.shape(
        spec,
        field.marker_geom(flag.name, state, "cloth"),
        field.BOX,
        [depth_m, length_m, _THIN_M],
        [
            flag.x_m + ux * at_m - uy * beside_m,
            flag.y_m + uy * at_m + ux * beside_m,
            _THIN_M,
        ],
        tint,
        quat=_about_z(along),
    )


def _along(flag: Flag) -> float:
    """Return the direction in which a flag's cloth points, and in which its pole falls [rad].

    It is counter-clockwise round the field. So the field looks the same when it is turned by 180
    degrees.
    """
    return math.atan2(flag.y_m, flag.x_m) + math.pi / 2


def _about_z(angle_rad: float) -> list[float]:
    return [math.cos(angle_rad / 2), 0.0, 0.0, math.sin(angle_rad / 2)]
