"""Types of lengths for all fields, and how a place moves if a field is turned by 180 degrees."""

import math
from collections.abc import Iterable
from typing import Annotated

import msgspec

from lacoc_arenas.game import Place

Length = Annotated[float, msgspec.Meta(gt=0, le=20)]
"""A length in an arena file [m]; above 0 and at most 20."""

Point = tuple[
    Annotated[float, msgspec.Meta(ge=-20, le=20)], Annotated[float, msgspec.Meta(ge=-20, le=20)]
]
"""A point of the floor in an arena file: x, y [m]."""


def turned(place: Place) -> Place:
    """Return the place to which a place moves when the field is turned by 180 degrees (rules 4)."""
    heading_rad = math.remainder(place.heading_rad + math.pi, math.tau)
    return Place(0.0 - place.x_m, 0.0 - place.y_m, heading_rad)


def opposite(places: Iterable[Place]) -> tuple[tuple[Place, ...], tuple[Place, ...]]:
    """Return the start places of both seats: the left seat's, and these turned by 180 degrees."""
    left = tuple(places)
    return left, tuple(map(turned, left))
