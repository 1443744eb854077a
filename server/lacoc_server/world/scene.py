"""Makes the scene: a description of a compiled model that pages can draw without MuJoCo."""

from collections.abc import Sequence
from typing import Any

import mujoco
import numpy as np

from lacoc_arenas.checked_game import marker_of_geom
from lacoc_arenas.game import AnyGame
from lacoc_shared.messages import Scene, SceneBody, SceneGeom
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

_TYPES = {
    mujoco.mjtGeom.mjGEOM_PLANE: "plane",
    mujoco.mjtGeom.mjGEOM_SPHERE: "sphere",
    mujoco.mjtGeom.mjGEOM_CAPSULE: "capsule",
    mujoco.mjtGeom.mjGEOM_CYLINDER: "cylinder",
    mujoco.mjtGeom.mjGEOM_BOX: "box",
    mujoco.mjtGeom.mjGEOM_ELLIPSOID: "ellipsoid",
}


def make_scene(model: Any, game: AnyGame, seats: Sequence[str]) -> Scene:
    """Describe a model for drawing; invisible geoms are left out.

    Args:
        model: the compiled `MjModel`; a robot's names begin with its seat and a slash.
        game: the game; geoms named `marker:NAME:STATE` show its markers.
        seats: ids of the seats.

    Raises:
        UserError: if pages can't draw the model, or a geom's marker or state does not exist. Pages
            know free roots, one hinge of a robot through a body's origin, and the geom types in
            `_TYPES`.
    """
    bodies = tuple(_body(model, index, seats) for index in range(model.nbody))
    geoms = []
    for index in range(model.ngeom):
        if model.geom_rgba[index, 3] == 0:  # walls and probes are invisible
            continue
        geom = model.geom(index)
        marker, state = marker_of_geom(game, geom.name)
        kind = _TYPES.get(mujoco.mjtGeom(int(geom.type[0])))
        if kind is None:
            raise UserError(say("scene.geom", name=geom.name))
        body = int(geom.bodyid[0])
        geoms.append(
            SceneGeom(
                body=body,
                type=kind,
                size=_floats(geom.size),
                pos=_floats(geom.pos),
                quat=_floats(geom.quat),
                rgba=_floats(geom.rgba),
                marker=marker,
                state=state,
                seat=_team_colour(model, index, seats),
            )
        )
    return Scene(bodies=bodies, geoms=tuple(geoms))


def _body(model: Any, index: int, seats: Sequence[str]) -> SceneBody:
    body = model.body(index)
    seat, joint, axis = -1, -1, (0.0, 0.0, 1.0)
    if int(body.jntnum[0]) > 1:
        raise UserError(say("scene.joints", name=body.name))
    if int(body.jntnum[0]):
        described = model.joint(int(body.jntadr[0]))
        joint = _hinge(described, seats)
        if described.type[0] == mujoco.mjtJoint.mjJNT_FREE:
            seat = _seat(body.name, seats)
        elif joint >= 0:
            axis = _floats(described.axis)
        else:
            raise UserError(say("scene.joint", name=described.name))
    return SceneBody(
        name=body.name,
        parent=int(body.parentid[0]) if index else -1,
        pos=_floats(body.pos),
        quat=_floats(body.quat),
        seat=seat,
        joint=joint,
        axis=axis,
    )


def _hinge(joint: Any, seats: Sequence[str]) -> int:
    """Return the joint id of a robot's hinge through a body's origin; -1: it is another joint."""
    seat, _, number = joint.name.partition("/j")
    is_hinge = joint.type[0] == mujoco.mjtJoint.mjJNT_HINGE and not np.any(joint.pos)
    return int(number) if is_hinge and seat in seats and number.isdecimal() else -1


def _seat(name: str, seats: Sequence[str]) -> int:
    prefix = name.partition("/")[0]
    return seats.index(prefix) if "/" in name and prefix in seats else -1


def _team_colour(model: Any, geom: int, seats: Sequence[str]) -> int:
    """Return the seat of the robot whose colour a geom has; -1: it has another, or is no robot's.

    The colour of a robot is the colour of its body's first geom.
    """
    body = model.geom_bodyid[geom]
    root = model.body_rootid[body]
    plain = model.geom_rgba[model.body_geomadr[root]]
    return _seat(model.body(body).name, seats) if (model.geom_rgba[geom] == plain).all() else -1


def _floats(array: Any) -> Any:
    return tuple(array.tolist())
