"""Compiles the models of a world: the whole one, and those that physics and touch need.

The whole model costs physics time, because MuJoCo moves its drawn geoms in each step. Without them
and without the midphase, a tick of physics takes about 0.9 of the time and has the same bits
(docs/facts.md 2). While robots are far from each other or from the walls, two more models leave out
the search for contacts that can't be there (`nearness`).
"""

import copy
from collections.abc import Callable
from typing import Any, NamedTuple

import mujoco
import numpy as np

PROBE = "probe:"
"""Beginning of the name of a geom that robots touch; the name of its marker follows."""

_UNNAMED = "unnamed:"
"""Beginning of the names that nameless geoms get, because a pair needs names."""
_MOST_PAIRS = 400
"""Most pairs of geoms for which a list of pairs takes less time than MuJoCo's search."""


class Models(NamedTuple):
    """The models of one world. Bodies and joints are the same in all; ids of geoms are not."""

    whole: Any
    """The model with all geoms. Records name it by its hash, and pictures show it."""
    stepped: Any
    """The model that MuJoCo steps, with only the geoms that can collide or have a mass. If the
    field has pairs, sensors or tendons, it has all geoms."""
    touching: Any
    """The model of `stepped` with the probes, which robots touch; None if there are no probes."""
    clear: Any
    """The model that is stepped while all robots are far from walls and other obstacles; None if
    the field has none, or this model can't be made."""
    apart: Any
    """The model that is stepped while all robots are far from each other. In it MuJoCo does not
    search for bodies that may meet: it has a list of the pairs that may, each a robot's geom and a
    fixed one. None: this model can't be made, or would save no time."""


def compile_models(spec: mujoco.MjSpec, robots: int = 0) -> Models:
    """Compile the models of a world.

    Args:
        spec: all robots on their field. It is changed.
        robots: number of robots in it.
    """
    whole = spec.compile()
    touching = None
    # These may name any geom, so with one of them all geoms stay.
    can_delete = not (spec.pairs or spec.sensors or spec.tendons)
    if can_delete:
        _delete(spec, lambda geom: not _is_solid(geom) and not geom.name.startswith(PROBE))
    if any(geom.name.startswith(PROBE) for geom in spec.geoms):
        touching = spec.compile()
    if can_delete:
        _delete(spec, lambda geom: not _is_solid(geom))
    stepped = spec.compile()
    # The midphase searches trees of geoms, but here each body has few geoms. MuJoCo sorts what it
    # finds, so that contacts have the same order with it and without it.
    stepped.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_MIDPHASE)
    clear = apart = None
    if can_delete and robots and len(_moving_trees(stepped)) == robots:
        clear = _without_obstacles(stepped)
        apart = _without_search(spec, stepped)
    return Models(whole, stepped, touching, clear, apart)


def obstacles(model: Any) -> list[int]:
    """Return the ids of the fixed geoms that robots can run against: all but level planes."""
    fixed, _ = _solids(model)
    is_level = (model.geom_type == mujoco.mjtGeom.mjGEOM_PLANE) & (
        model.geom_quat == (1.0, 0.0, 0.0, 0.0)
    ).all(axis=1)
    return [geom for geom in fixed if not is_level[geom]]


def _solids(model: Any) -> tuple[list[int], list[int]]:
    """Return the ids of the geoms that can collide: the fixed ones, and those that move."""
    collides = (model.geom_contype != 0) | (model.geom_conaffinity != 0)
    moves = model.body_weldid[model.geom_bodyid] != 0
    fixed, moving = np.flatnonzero(collides & ~moves), np.flatnonzero(collides & moves)
    return fixed.tolist(), moving.tolist()


def _moving_trees(model: Any) -> set[int]:
    """Return the ids of the bodies from which everything hangs that moves and can collide."""
    _, moving = _solids(model)
    return set(model.body_rootid[model.geom_bodyid[moving]].tolist())


def _without_obstacles(stepped: Any) -> Any:
    """Return a model whose obstacles meet nothing; None if there are no obstacles."""
    geoms = obstacles(stepped)
    if not geoms:
        return None
    clear = copy.copy(stepped)
    clear.geom_contype[geoms] = clear.geom_conaffinity[geoms] = 0
    return clear


def _without_search(spec: mujoco.MjSpec, stepped: Any) -> Any:
    """Compile a model in which robots meet only fixed geoms, by a list of pairs of geoms.

    The contacts of a pair are the same as those that MuJoCo finds by its search, because the
    robot's geom decides friction and softness (`priority`).

    Args:
        spec: the description of `stepped`. It is changed.
        stepped: the compiled model, in which only robots move.

    Returns:
        The model. None if it could have other contacts: parts of one robot meet, or a fixed geom
        has a say in a contact. None also if there are so many pairs that the search takes less
        time.
    """
    fixed, moving = _solids(stepped)
    con, aff = stepped.geom_contype, stepped.geom_conaffinity
    trees = stepped.body_rootid[stepped.geom_bodyid[moving]]
    meets = (con[moving][:, None] & aff[moving]) != 0
    if (
        len(fixed) * len(moving) > _MOST_PAIRS
        or (meets & (trees[:, None] == trees)).any()
        or stepped.geom_margin.any()
        or stepped.geom_priority[moving].min() <= stepped.geom_priority[fixed].max(initial=-1)
    ):
        return None
    geoms = {geom.id: geom for geom in spec.geoms}
    for number, geom in geoms.items():
        geom.name = geom.name or f"{_UNNAMED}{number}"
    for own in moving:
        for ground in fixed:
            if (con[own] & aff[ground]) | (con[ground] & aff[own]):
                _add_pair(spec, geoms[own], geoms[ground])
    apart = spec.compile()
    apart.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_MIDPHASE)
    bodies = apart.geom_bodyid[moving]
    apart.geom_contype[moving] = apart.geom_conaffinity[moving] = 0
    apart.body_contype[bodies] = apart.body_conaffinity[bodies] = 0
    return apart


def _add_pair(spec: mujoco.MjSpec, own: Any, ground: Any) -> None:
    """Let a robot's geom and a fixed one meet, with what the robot's geom says about contacts."""
    slide, spin, roll = own.friction
    spec.add_pair(
        geomname1=ground.name,
        geomname2=own.name,
        condim=own.condim,
        solref=own.solref,
        solimp=own.solimp,
        friction=[slide, slide, spin, roll, roll],
    )


def _is_solid(geom: Any) -> bool:
    """Return whether a geom affects how robots move: it can collide, or it has a mass."""
    return bool(geom.contype or geom.conaffinity or geom.mass != 0)


def _delete(spec: mujoco.MjSpec, is_needless: Callable[[Any], bool]) -> None:
    for geom in [geom for geom in spec.geoms if is_needless(geom)]:
        spec.delete(geom)
