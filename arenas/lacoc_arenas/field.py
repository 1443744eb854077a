"""MuJoCo geoms (shapes) of which the fields of all games are built.

Of these geoms, robots collide only with the floor and the four wall planes. Every other one is only
visible: it has no mass and no contacts, so it does not change the physics at all (rules 6). The
geoms of a marker are named "marker:NAME:STATE", followed by ":PART" if a state has several shapes;
they are shown while the marker is in that state.
"""

import math
from collections.abc import Sequence
from typing import Any

import mujoco

from lacoc_shared.messages import MARKER_STATES

Rgba = tuple[float, float, float, float]


def rgba(colour: str, alpha: float = 1.0) -> Rgba:
    """Return the colour "#rrggbb" as numbers from 0 to 1."""
    red, green, blue = (int(colour[at : at + 2], 16) / 255 for at in (1, 3, 5))
    return red, green, blue, alpha


FLOOR = rgba("#ece8df")
PANEL = rgba("#d3ccbd")
LINE = rgba("#cbc4b5")
RIM = rgba("#9a907d")
WALL = rgba("#85765f")
POLE = rgba("#5b5347")

TINTS: dict[str, Rgba] = {
    "neutral": rgba("#f7f4ec"),
    "left": rgba("#0072b2"),
    "right": rgba("#e69f00"),
    "down": rgba("#a39c8f"),
}
"""The colour of a marker in each state, when the teams have their default colours."""

_GROUND = {"contype": 1, "conaffinity": 0xFFFE}
"""Collision bit of floor and walls; the robots' own bits start at 2 (docs/facts.md 2)."""

PLANE = mujoco.mjtGeom.mjGEOM_PLANE
BOX = mujoco.mjtGeom.mjGEOM_BOX
CYLINDER = mujoco.mjtGeom.mjGEOM_CYLINDER

_WALL_HEIGHT_M, _WALL_HALF_M = 0.05, 0.015


def ground(spec: mujoco.MjSpec, size_m: tuple[float, float]) -> None:
    """Add the floor and the four walls around it to a model.

    Args:
        spec: the model to add to.
        size_m: inner width (x) and depth (y) between the walls.
    """
    world = spec.worldbody
    half = (size_m[0] / 2, size_m[1] / 2)
    world.add_geom(name="floor", type=PLANE, size=[*half, 0.05], rgba=FLOOR, **_GROUND)
    s = math.sqrt(0.5)
    inward = {  # a plane's normal is its z axis: it must point into the field
        "east": ((half[0], 0.0), (s, 0.0, -s, 0.0)),
        "west": ((-half[0], 0.0), (s, 0.0, s, 0.0)),
        "north": ((0.0, half[1]), (s, s, 0.0, 0.0)),
        "south": ((0.0, -half[1]), (s, -s, 0.0, 0.0)),
    }
    for name, ((x_m, y_m), quat) in inward.items():
        world.add_geom(
            name=f"wall:{name}",
            type=PLANE,
            pos=[x_m, y_m, 0.0],
            quat=quat,
            size=[1.0, 1.0, 0.1],
            rgba=[0.0, 0.0, 0.0, 0.0],
            **_GROUND,
        )
        out = [x_m + math.copysign(_WALL_HALF_M, x_m) * (x_m != 0), y_m]
        out[1] += math.copysign(_WALL_HALF_M, y_m) * (y_m != 0)
        along = [_WALL_HALF_M, half[1] + 2 * _WALL_HALF_M] if x_m else [half[0], _WALL_HALF_M]
        shape(
            spec,
            f"rail:{name}",
            BOX,
            [*along, _WALL_HEIGHT_M / 2],
            [*out, _WALL_HEIGHT_M / 2],
            WALL,
        )


def shape(
    spec: mujoco.MjSpec,
    name: str,
    kind: mujoco.mjtGeom,
    size: Sequence[float],
    pos: Sequence[float],
    colour: Rgba,
    **more: Any,
) -> None:
    """Add a geom that can only be seen: it has no mass and no contacts."""
    spec.worldbody.add_geom(
        name=name,
        type=kind,
        size=[*size, *[0.0] * (3 - len(size))],
        pos=pos,
        rgba=colour,
        mass=0.0,
        contype=0,
        conaffinity=0,
        **more,
    )


def disc(
    spec: mujoco.MjSpec,
    name: str,
    at_m: tuple[float, float],
    radius_m: float,
    top_m: float,
    colour: Rgba,
) -> None:
    """Add a flat round plate on the floor; its upper face is `top_m` above the floor."""
    shape(spec, name, CYLINDER, [radius_m, top_m / 2], [*at_m, top_m / 2], colour)


def plate(
    spec: mujoco.MjSpec,
    name: str,
    at_m: tuple[float, float],
    half_m: tuple[float, float],
    top_m: float,
    colour: Rgba,
) -> None:
    """Add a flat rectangular plate on the floor; its upper face is `top_m` above the floor."""
    shape(spec, name, BOX, [*half_m, top_m / 2], [*at_m, top_m / 2], colour)


def marker_geom(name: str, state: int, part: str = "") -> str:
    """Return the name of a geom that is shown while a marker is in a state."""
    return f"marker:{name}:{MARKER_STATES[state]}" + (f":{part}" if part else "")
