"""Measures balance: how far the centre of mass is inside the polygon of the standing feet."""

import math
from collections.abc import Sequence

import numpy as np

from lacoc_server.trial.walk import Bools, Floats

Point = tuple[float, float]


def hull(points: Sequence[Point]) -> list[Point]:
    """Return the corners of the convex hull, counter-clockwise; for points on a line, both ends."""
    ordered = sorted(set(points))
    if len(ordered) < 3:
        return ordered
    halves = []
    for way in (ordered, ordered[::-1]):
        half: list[Point] = []
        for point in way:
            while len(half) > 1 and _left(half[-2], half[-1], point) <= 0:
                half.pop()
            half.append(point)
        halves.append(half[:-1])
    return halves[0] + halves[1]


def margin_m(feet: Sequence[Point], centre: Point) -> float | None:
    """Return the support margin: the distance of a centre of mass from the polygon's edge [m].

    Args:
        feet: places of the standing feet [m].
        centre: centre of mass in the plane of the floor [m].

    Returns:
        The margin, positive inside the polygon and negative outside. One or two feet enclose no
        area, so their margin is never positive. None without feet.
    """
    corners = hull(feet)
    if not corners:
        return None
    if len(corners) < 3:
        return -_apart_m(centre, corners[0], corners[-1])
    edges = list(zip(corners, [*corners[1:], corners[0]], strict=True))
    nearest_m = min(_apart_m(centre, start, end) for start, end in edges)
    inside = all(_left(start, end, centre) >= 0 for start, end in edges)
    return nearest_m if inside else -nearest_m


def margins_m(down: Bools, contact_w_m: Floats, centre_w_m: Floats) -> Floats:
    """Return the support margin of each tick [m]; NaN where no foot is down.

    Args:
        down: (ticks, legs) whether the foot is down.
        contact_w_m: (ticks, legs, 2) where each foot touches the floor.
        centre_w_m: (ticks, 2) centre of mass.
    """
    found = np.full(len(down), np.nan)
    for tick, stands in enumerate(down):
        feet = [(float(x), float(y)) for x, y in contact_w_m[tick, stands]]
        margin = margin_m(feet, (float(centre_w_m[tick, 0]), float(centre_w_m[tick, 1])))
        if margin is not None:
            found[tick] = margin
    return found


def _left(start: Point, end: Point, point: Point) -> float:
    """Return twice the area of a triangle: positive if `point` is left of the line to `end`."""
    return (end[0] - start[0]) * (point[1] - start[1]) - (end[1] - start[1]) * (point[0] - start[0])


def _apart_m(point: Point, start: Point, end: Point) -> float:
    """Return the distance of a point from a segment [m]."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    length2 = dx * dx + dy * dy
    share = 0.0
    if length2 > 0:
        along = (point[0] - start[0]) * dx + (point[1] - start[1]) * dy
        share = min(1.0, max(0.0, along / length2))
    return math.dist(point, (start[0] + share * dx, start[1] + share * dy))
