"""Compiles the MuJoCo models of a world: a whole one, one for physics, one to find touches.

The whole model costs physics time, because MuJoCo moves its drawn geoms in each step. Without them
and without the midphase, a tick of physics takes about 0.9 of the time and has the same bits
(docs/facts.md 2).
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import mujoco

PROBE = "probe:"
"""Beginning of the name of a geom that robots touch; the name of its marker follows."""


class Models(NamedTuple):
    """The models of one world. Bodies and joints are the same in all; ids of geoms are not."""

    whole: Any
    """The model with all geoms. Records name it by its hash, and pictures show it."""
    stepped: Any
    """The model that MuJoCo steps, with only the geoms that exert forces."""
    touching: Any
    """The model of `stepped` with the probes, which robots touch; None if there are no probes."""


def compile_models(spec: mujoco.MjSpec) -> Models:
    """Compile the models of a world.

    Args:
        spec: all robots on their field. It is changed.
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
    return Models(whole, stepped, touching)


def _is_solid(geom: Any) -> bool:
    """Return whether a geom affects how robots move: it can collide, or it has a mass."""
    return bool(geom.contype or geom.conaffinity or geom.mass != 0)


def _delete(spec: mujoco.MjSpec, is_needless: Callable[[Any], bool]) -> None:
    for geom in [geom for geom in spec.geoms if is_needless(geom)]:
        spec.delete(geom)
