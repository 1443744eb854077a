"""Bots for Robot-Othello: `straight`, `nearest` (to the nearest disc) and `planner` (of routes)."""

import math
from abc import ABC, abstractmethod

from lacoc_arenas.bot import BotFactory, Brain, Key
from lacoc_arenas.game import NEUTRAL
from lacoc_arenas.routes import Route, best_route
from lacoc_arenas.steering import Eyes, Pilot, Pose, straight
from lacoc_shared.codec import unpack_states
from lacoc_shared.messages import Frame, Sheet
from lacoc_shared.seat import BEATS_PER_S

from .rules import NO_CELL, SIDE, make

_DEPTH, _BEAM = 7, 20
"""How many cells a route has at most, and how many routes are kept at each step of the search."""
_PATIENCE_S = 25.0
"""A disc gained this much later is worth 1 / e of a disc now, because plans often fail."""
_BLOCKED_M, _BLOCKED_S = 0.35, 12.0
"""If the other robot is this near to a disc, the disc is blocked: the bot assumes that going there
takes this much longer."""
_REPLAN_TICKS = 4 * BEATS_PER_S


class _Walker(ABC):
    """A brain that walks from cell to cell of the board; subclasses choose the next cell."""

    def __init__(self, sheet: Sheet, seat: int) -> None:
        self.game = make(sheet.settings["game"])
        self.seat = seat
        self.discs = [(disc.x_m, disc.y_m) for disc in self.game.markers]
        self._eyes = Eyes(sheet)
        self._pilot = Pilot(sheet, seat, self.game.size_m)
        self._last = self.game.start().last[seat]
        self._seen: tuple[int, int, bytes] | None = None
        self._target = NO_CELL

    def __call__(self, frame: Frame) -> Key | None:
        poses = self._eyes.poses(frame)
        pose = poses[self.seat]
        cell = self.game.cell_at(pose.x_m, pose.y_m)
        if cell != NO_CELL:
            self._last = cell
        seen = (frame.clock_ticks // _REPLAN_TICKS, self._last, frame.markers)
        if seen != self._seen:
            self._seen = seen
            cells = unpack_states(frame.markers, len(self.discs))
            self._target = self.choose(cells, self._last, poses)
        target_m = None if self._target == NO_CELL else self.discs[self._target]
        return self._pilot.toward(frame, poses, target_m)

    def blocked(self, cell: int, poses: list[Pose]) -> bool:
        """Say whether another robot is near the disc of this cell."""
        return any(
            other.distance_m(*self.discs[cell]) < _BLOCKED_M
            for seat, other in enumerate(poses)
            if seat != self.seat
        )

    @abstractmethod
    def choose(self, cells: tuple[int, ...], last: int, poses: list[Pose]) -> int:
        """Return the cell of the board to go to, or `NO_CELL`.

        Args:
            cells: the board.
            last: this robot's last cell.
            poses: where all robots are.
        """


class NearestDisc(_Walker):
    """Goes to the nearest disc that it can flip.

    If there is none, it goes to the nearest own disc from which it can flip a disc beside it.
    """

    def choose(self, cells: tuple[int, ...], last: int, poses: list[Pose]) -> int:
        """Return the nearest cell worth going to; a cell that is not blocked comes first."""
        own, pose = self.seat + 1, poses[self.seat]
        flips = [n for n in self.game.neighbours[last] if cells[n] != own == cells[last]]
        starts = [
            cell
            for cell, colour in enumerate(cells)
            if colour == own
            and cell != last
            and any(cells[n] != own for n in self.game.neighbours[cell])
        ]
        useful = next(
            (free for some in (flips, starts) if (free := self._free(some, poses))), flips or starts
        )
        return min(useful, key=lambda c: pose.distance_m(*self.discs[c]), default=NO_CELL)

    def _free(self, cells: list[int], poses: list[Pose]) -> list[int]:
        return [cell for cell in cells if not self.blocked(cell, poses)]


class DiscPlanner(_Walker):
    """Chooses a route over several cells by the discs that it gains and the time that it takes."""

    def choose(self, cells: tuple[int, ...], last: int, poses: list[Pose]) -> int:
        """Return the first cell of the best route that was found."""
        start = Route(pose=poses[self.seat], board=cells)
        best = best_route(start, lambda route: self._grow(route, last, poses), _DEPTH, _BEAM)
        return best.markers[0] if best.markers else NO_CELL

    def _grow(self, route: Route, last: int, poses: list[Pose]) -> list[Route]:
        grown = []
        before = route.markers[-1] if route.markers else last
        for cell in _around(before):
            x_m, y_m = self.discs[cell]
            time_s = route.time_s + route.pose.travel_s(x_m, y_m)
            if not route.markers and self.blocked(cell, poses):
                time_s += _BLOCKED_S
            worth, cells = route.worth, route.board
            flips = self.game.flips(cells, self.seat, before, cell)
            if flips:
                # A disc of the other team counts twice: one more for us, one less for them.
                gain = sum(1 if cells[flip] == NEUTRAL else 2 for flip in flips)
                worth += gain * math.exp(-time_s / _PATIENCE_S)
                after = list(cells)
                for flip in flips:
                    after[flip] = self.seat + 1
                cells = tuple(after)
            heading_rad = math.atan2(y_m - route.pose.y_m, x_m - route.pose.x_m)
            pose = Pose(x_m, y_m, heading_rad, 1.0)
            grown.append(Route(worth, time_s, pose, (*route.markers, cell), cells))
        return grown


def _around(cell: int) -> list[int]:
    """Return the cells next to a cell (at most eight), including the diagonal ones."""
    row, column = divmod(cell, SIDE)
    return [
        SIDE * r + c
        for r in range(max(0, row - 1), min(SIDE, row + 2))
        for c in range(max(0, column - 1), min(SIDE, column + 2))
        if (r, c) != (row, column)
    ]


def nearest(sheet: Sheet, seat: int) -> Brain:
    """Make a brain that goes to the nearest disc to flip (`NearestDisc`)."""
    return NearestDisc(sheet, seat)


def planner(sheet: Sheet, seat: int) -> Brain:
    """Make a brain that plans routes over several discs (`DiscPlanner`)."""
    return DiscPlanner(sheet, seat)


BOTS: dict[str, BotFactory] = {"straight": straight, "nearest": nearest, "planner": planner}
