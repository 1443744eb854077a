"""The robots of a match on their field: build them, put them back, observe them."""

import math
import struct
from collections.abc import Sequence
from typing import Any, NamedTuple

from lacoc_arenas.arena import Arena
from lacoc_arenas.game import Observation, Place, RobotView
from lacoc_server.match.physics import MakePhysics, Physics, Restorable
from lacoc_server.match.seat import Seat
from lacoc_shared.record.schema import Touch

MIN_START_DISTANCE_M = 0.35
"""Least distance of a free start place from another robot's centre [m]; if the sum of both robots'
radii is larger, that sum is used instead.
"""

_BODY = struct.Struct("<7f")


class Places(NamedTuple):
    """Where the robots of a match were put."""

    placed: tuple[Place | None, ...]
    """By seat: where its robot was put since the rules last saw it; None: it was not put."""
    starts: tuple[Place, ...]
    """By seat: where its robot was last put."""


class Staging:
    """Holds the physics of a match, and reads from it what the rules and the frames need.

    Args:
        arena: the field and its game.
        make_physics: builds the field, with or without robots.
    """

    def __init__(self, arena: Arena, make_physics: MakePhysics) -> None:
        self._arena = arena
        self.make_physics = make_physics
        self.clear()

    def clear(self) -> None:
        """Empty the field."""
        self.physics: Physics = self.make_physics(self._arena, ())
        self.poses = b""
        """Poses in the form of `Frame.poses`: exactly the numbers that everybody sees."""
        self._bodies: list[tuple[Any, ...]] = []
        """For each seat the first 7 fields of `RobotView`."""
        self._offsets: tuple[int, ...] = ()
        self._radii_m: tuple[float, ...] = ()
        self._placed: list[Place | None] = []
        self._starts: list[Place] = []

    def build(self, seats: Sequence[Seat]) -> None:
        """Compile the model of the field with the robots of all seats."""
        entries = [seat.entry for seat in seats if seat.entry]
        self.physics = self.make_physics(self._arena, entries)
        sizes = [4 * (7 + entry.robot.joints) for entry in entries]
        self._offsets = tuple(sum(sizes[:seat]) for seat in range(len(sizes)))
        self._radii_m = tuple(entry.robot.radius_m for entry in entries)
        self._placed = [None] * len(entries)
        self._starts = [self._arena.game.starts[seat][0] for seat in range(len(entries))]
        self.look()

    def look(self) -> None:
        """Read the present poses of all robots from physics, and keep them."""
        self.poses = self.physics.poses()
        self._bodies = [_BODY.unpack_from(self.poses, offset) for offset in self._offsets]

    def from_start_m(self, seat: int) -> float:
        """Return how far a robot's centre is from where it was last put, seen from above [m]."""
        return math.dist(self._starts[seat][:2], self._bodies[seat][:2])

    def centre_m(self, seat: int) -> tuple[float, float]:
        """Return where a robot's centre is, seen from above [m]."""
        x_m, y_m = self._bodies[seat][:2]
        return x_m, y_m

    def observe(self) -> tuple[Observation, Touch | None]:
        """Observe a tick for the rules.

        Returns:
            The observation; and its touches and new places, which the poses do not show, or None
            if it has none.
        """
        touched, placed = self.physics.touched(), self._placed
        if not (any(touched) or any(placed)):
            return tuple([RobotView(*body) for body in self._bodies]), None
        self._placed = [None] * len(placed)
        seen = tuple(
            RobotView._make((*body, place, touch))
            for body, place, touch in zip(self._bodies, placed, touched, strict=True)
        )
        return seen, Touch(tuple(touched), tuple(placed))

    def save(self) -> Places:
        """Return the places of the robots, which a saved match needs besides the physics."""
        return Places(tuple(self._placed), tuple(self._starts))

    def load(self, places: Places, physics: bytes) -> None:
        """Go on from saved places and the saved state of the same robots.

        Raises:
            ValueError: if the physics is a record's, or the state has another length than its own.
        """
        if not isinstance(self.physics, Restorable):
            raise ValueError("the poses of a record take the place of physics; they can't change")
        self.physics.load(physics)
        self._placed, self._starts = list(places.placed), list(places.starts)
        self.look()

    def put_back(self, seats: Sequence[Seat]) -> None:
        """Put robots at start places, if their seats are marked as restarting."""
        going = [seat for seat in seats if seat.restarting]
        if not going:
            return
        # Robots that are put back in the same beat do not block each other: each goes to its own
        # side. So no seat has an advantage.
        staying = [seat for seat in seats if not seat.restarting]
        for seat in going:
            place = self._free_place(seat, staying)
            self.physics.place(seat.index, place)
            self._placed[seat.index] = self._starts[seat.index] = place
            seat.restarting = False
        self.look()

    def _free_place(self, seat: Seat, others: Sequence[Seat]) -> Place:
        """Return the seat's first start place that is free (rules 3), or the one with most room.

        Args:
            seat: the seat whose robot is put back.
            others: seats whose robots stay where they are.
        """

        def room_m(place: Place) -> float:
            gaps_m = (
                math.dist(place[:2], self._bodies[other.index][:2])
                - max(MIN_START_DISTANCE_M, self._radii_m[seat.index] + self._radii_m[other.index])
                for other in others
            )
            return min(gaps_m, default=math.inf)

        places = self._arena.game.starts[seat.index]
        return next((place for place in places if room_m(place) >= 0), max(places, key=room_m))
