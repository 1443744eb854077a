"""A leg: three links on three hinges (workshop Fig. 3-2, rules 1).

The body frame has +x right, +y forward and +z up; its origin is the middle of the body's box. A
link is a capsule. Its length is measured from hinge to hinge; for the last link, from hinge to tip.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import msgspec


class Point(NamedTuple):
    """A point in the body frame [m]."""

    x: float
    y: float
    z: float


class Capsule(NamedTuple):
    """All points within a radius of a segment, in the body frame [m]."""

    start: Point
    end: Point
    radius_m: float


class LegSpec(msgspec.Struct, frozen=True, kw_only=True):
    """One leg as its robot file describes it."""

    label: str
    """The leg's name in tables, such as "R,F"."""
    position_m: Point
    """The root hinge in the body frame."""
    outward_rad: float
    """Direction of the leg at root angle 0: 0 = right, pi/2 = forward, pi = left."""
    lengths_m: tuple[float, float, float]
    """Root link (L0), 1st link (L1), 2nd link (L2), from hinge to hinge."""
    radius_m: float
    masses_kg: tuple[float, float, float]
    """Masses of the root link, the 1st and the 2nd link."""
    range_rad: tuple[float, float]
    """Lowest and highest angle of each of the three joints."""
    accent: bool = False
    """Whether the leg has another colour, to show where the front is (workshop 3-1)."""

    @property
    def range_deg(self) -> tuple[float, float]:
        """The range of the leg's joints in degrees, rounded as in the file: 60, not 59.9999999."""
        low, high = self.range_rad
        return round(math.degrees(low), 9), round(math.degrees(high), 9)

    @property
    def side(self) -> int:
        """+1 for a leg on the right, -1 for a leg on the left: the sign of its root axis.

        With this sign a positive root angle swings the leg forward on both sides (rules 1).
        """
        return 1 if math.cos(self.outward_rad) > 0 else -1

    def points(self, root: float, first: float, second: float) -> tuple[Point, Point, Point, Point]:
        """Compute the positions of the leg's hinges and its tip.

        Args:
            root: angle [rad]; a positive one swings the leg forward.
            first: angle [rad]; a positive one lifts the 1st link, 0 is horizontal.
            second: angle [rad]; a positive one swings the 2nd link outward and up, 0 is square to
                the 1st link.

        Returns:
            Root hinge, 1st hinge, 2nd hinge and tip, in the body frame [m].
        """
        heading = self.outward_rad + self.side * root
        out_x, out_y = math.cos(heading), math.sin(heading)
        shank = first + second
        steps = (
            (self.lengths_m[0], 0.0),
            (self.lengths_m[1] * math.cos(first), self.lengths_m[1] * math.sin(first)),
            (self.lengths_m[2] * math.sin(shank), -self.lengths_m[2] * math.cos(shank)),
        )
        points = [self.position_m]
        for out, up in steps:
            last = points[-1]
            points.append(Point(last.x + out * out_x, last.y + out * out_y, last.z + up))
        return points[0], points[1], points[2], points[3]

    def capsules(self, root: float, first: float, second: float) -> tuple[Capsule, ...]:
        """Compute the shapes of the three links; a shape is as long as its link, ends included.

        The root link's shape also reaches one radius behind the root hinge. The workshop's root
        link is as long as its radius, so its shape is a sphere around that hinge.
        """
        points = self.points(root, first, second)
        return tuple(self.capsule(level, points) for level in range(len(points) - 1))

    def capsule(self, level: int, points: Sequence[Point]) -> Capsule:
        """Compute the shape of one link of the leg.

        Args:
            level: Root 0, 1st 1, 2nd 2.
            points: what `points` computes.
        """
        start, end = points[level], points[level + 1]
        part = self.radius_m / self.lengths_m[level]
        near = 0.0 if level == 0 else part
        return Capsule(_between(start, end, near), _between(start, end, 1.0 - part), self.radius_m)


def _between(start: Point, end: Point, part: float) -> Point:
    x, y, z = (a + part * (b - a) for a, b in zip(start, end, strict=True))
    return Point(x, y, z)
