"""Bots for Flag-Strike: `straight`, `nearest` (to the nearest flag) and `planner` (of routes)."""

import math
from abc import ABC, abstractmethod

from lacoc_arenas.bot import BotFactory, Brain, Key
from lacoc_arenas.game import NEUTRAL
from lacoc_arenas.routes import Route, best_route
from lacoc_arenas.steering import Eyes, Pilot, Pose, straight
from lacoc_shared.codec import unpack_states
from lacoc_shared.messages import Frame, Sheet
from lacoc_shared.seat import BEATS_PER_S

from .rules import CORNERS, State, make

_NOWHERE = -1
_FLAG_REACH_M, _CORNER_REACH_M = 0.13, 0.12
"""Distance from the marker's middle at which a robot strikes a flag, or takes a corner."""

_DEPTH, _BEAM = 4, 14
"""How many targets a route has at most, and how many routes are kept at each step of the search."""
_PATIENCE_S = 30.0
"""A point gained this much later is worth 1 / e of a point now, because plans often fail."""
_RIVAL = 0.8
"""The worth of a flag is multiplied by this if the other robot will be there first."""
_DECISIVE = 100.0
"""Worth of a corner that ends the match with a win."""
_REPLAN_TICKS = 4 * BEATS_PER_S


class _Hunter(ABC):
    """A brain that walks from marker to marker; subclasses choose the next one."""

    def __init__(self, sheet: Sheet, seat: int) -> None:
        self.game = make(sheet.settings["game"])
        self.seat = seat
        self.places = [(marker.x_m, marker.y_m) for marker in self.game.markers]
        self._eyes = Eyes(sheet)
        self._pilot = Pilot(sheet, seat, self.game.size_m)
        self._seen: tuple[int, bytes] | None = None
        self._target = _NOWHERE

    def __call__(self, frame: Frame) -> Key | None:
        poses = self._eyes.poses(frame)
        seen = (frame.clock_ticks // _REPLAN_TICKS, frame.markers)
        if seen != self._seen:
            self._seen = seen
            board = unpack_states(frame.markers, len(self.places))
            scores = tuple(seat.score for seat in frame.seats)
            self._target = self.choose(board, scores, poses)
        target_m = None if self._target == _NOWHERE else self.places[self._target]
        return self._pilot.toward(frame, poses, target_m)

    def open(self, board: tuple[int, ...], marker: int) -> bool:
        """Say whether this seat can score at a marker: a standing flag, or a corner not its own."""
        return board[marker] == NEUTRAL or (marker < CORNERS and board[marker] != self.seat + 1)

    @abstractmethod
    def choose(self, board: tuple[int, ...], scores: tuple[int, ...], poses: list[Pose]) -> int:
        """Return the index of the marker to go to, or `_NOWHERE` if none is worth it.

        Args:
            board: the state of each marker.
            scores: points of each seat.
            poses: the poses of all robots, by seat.
        """


class NearestFlag(_Hunter):
    """Goes to the nearest standing flag; if all have fallen, to the nearest corner not its own."""

    def choose(self, board: tuple[int, ...], scores: tuple[int, ...], poses: list[Pose]) -> int:
        """Return the nearest standing flag; without one, the nearest corner that can be gained."""
        pose = poses[self.seat]
        targets = [marker for marker in range(len(board)) if self.open(board, marker)]
        flags = [marker for marker in targets if marker >= CORNERS]
        return min(
            flags or targets, key=lambda m: pose.distance_m(*self.places[m]), default=_NOWHERE
        )


class FlagPlanner(_Hunter):
    """Chooses a route over flags and corners by its points and by the time that it takes."""

    def choose(self, board: tuple[int, ...], scores: tuple[int, ...], poses: list[Pose]) -> int:
        """Return the first marker of the best route that was found."""
        worths = self._worths(board, scores, poses)
        start = Route(pose=poses[self.seat])
        best = best_route(start, lambda route: self._grow(route, worths), _DEPTH, _BEAM)
        return best.markers[0] if best.markers else _NOWHERE

    def _worths(
        self, board: tuple[int, ...], scores: tuple[int, ...], poses: list[Pose]
    ) -> dict[int, float]:
        """Return, for each marker that this seat can gain, how much it is worth, if above 0."""
        pose, other = poses[self.seat], poses[1 - self.seat]
        worths = {}
        for marker, info in enumerate(self.game.markers):
            if not self.open(board, marker):
                continue
            worth = float(info.points if board[marker] == NEUTRAL else 2 * info.points)
            place_m = self.places[marker]
            if marker < CORNERS and self._ends(board, marker):
                worth = self._decisive(board, scores, marker)
            elif marker >= CORNERS and other.travel_s(*place_m) < pose.travel_s(*place_m):
                worth *= _RIVAL
            if worth > 0:
                worths[marker] = worth
        return worths

    def _ends(self, board: tuple[int, ...], corner: int) -> bool:
        """Say whether the match ends if this seat takes a corner, because it then has all four."""
        own = self.seat + 1
        return all(board[other] == own for other in range(CORNERS) if other != corner)

    def _decisive(self, board: tuple[int, ...], scores: tuple[int, ...], corner: int) -> float:
        """Return the worth of a corner that ends the match: high if this seat then wins, else 0."""
        points = self.game.markers[corner].points
        lost = points if board[corner] != NEUTRAL else 0
        finals = tuple(
            score + points if seat == self.seat else score - lost
            for seat, score in enumerate(scores)
        )
        after = State((*board[:corner], self.seat + 1, *board[corner + 1 :]), (-1, -1))
        return _DECISIVE if self.game.winner(after, finals) == self.seat else 0.0

    def _grow(self, route: Route, worths: dict[int, float]) -> list[Route]:
        grown = []
        for marker, gain in worths.items():
            if marker in route.markers:
                continue
            x_m, y_m = self.places[marker]
            reach_m = _CORNER_REACH_M if marker < CORNERS else _FLAG_REACH_M
            time_s = route.time_s + route.pose.travel_s(x_m, y_m, reach_m)
            worth = route.worth + gain * math.exp(-time_s / _PATIENCE_S)
            heading_rad = math.atan2(y_m - route.pose.y_m, x_m - route.pose.x_m)
            pose = Pose(x_m, y_m, heading_rad, 1.0)
            grown.append(Route(worth, time_s, pose, (*route.markers, marker)))
        return grown


def nearest(sheet: Sheet, seat: int) -> Brain:
    """Make a brain that goes to the nearest flag (`NearestFlag`)."""
    return NearestFlag(sheet, seat)


def planner(sheet: Sheet, seat: int) -> Brain:
    """Make a brain that plans routes over flags and corners (`FlagPlanner`)."""
    return FlagPlanner(sheet, seat)


BOTS: dict[str, BotFactory] = {"straight": straight, "nearest": nearest, "planner": planner}
