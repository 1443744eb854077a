"""The rules of Robot-Othello (workshop 5-1, rules 5).

Column 0 has the smallest x, row 0 the smallest y; a disc is named "c2r3" by column and row, and its
index is 6 * row + column. A robot's *last cell* is the disc it entered most recently; walking off a
disc does not change it.

If a referee strikes out a claim (rules 4.1), the disc keeps its colour, and so do the runs (lines
of discs) that would flip with it. The disc still becomes the robot's last cell, because the robot
has walked there.

All flips of one tick happen at the same time. Their events are listed in the order of the discs'
indices, which does not favour a seat.
"""

from collections.abc import Set as AbstractSet
from typing import Annotated, Any, Literal

import msgspec

from lacoc_arenas.game import (
    LEFT,
    NEUTRAL,
    RIGHT,
    Claim,
    GameEvent,
    NoSuchState,
    Observation,
    Place,
    RobotView,
    WrongSetting,
    leader,
)
from lacoc_arenas.layout import Length, opposite
from lacoc_shared.messages import Gains, MarkerInfo
from lacoc_shared.words import Phrase, say

SIDE = 6
"""Cells along a row and along a column (workshop 5-1 rule 1)."""

NO_CELL = -1


class Settings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The table [game] of the arena file of Robot-Othello."""

    pitch_m: Length
    disc_radius_m: Length
    wall_m: Length
    opening: Literal["halves", "neutral", "checkers", "reversi"]
    start_cells: Annotated[
        tuple[
            tuple[
                Annotated[int, msgspec.Meta(ge=0, lt=SIDE // 2)],
                Annotated[int, msgspec.Meta(ge=0, lt=SIDE)],
            ],
            ...,
        ],
        msgspec.Meta(min_length=1),
    ]
    """(column, row) of the left team's start places, the best first."""
    flank: bool

    def __post_init__(self) -> None:
        if 2 * self.disc_radius_m > self.pitch_m:
            radius_m, pitch_m = self.disc_radius_m, self.pitch_m
            raise WrongSetting(say("setting.discs-overlap", radius_m=radius_m, pitch_m=pitch_m))
        if len(set(self.start_cells)) != len(self.start_cells):
            raise WrongSetting(say("setting.cell-twice"))


class State(msgspec.Struct, frozen=True):
    """The state of a match of Robot-Othello."""

    cells: tuple[int, ...]
    """(36,) NEUTRAL, LEFT or RIGHT, by disc index."""
    last: tuple[int, int]
    """The last cell of each robot, by disc index."""


class Othello:
    """The rules of Robot-Othello with given settings."""

    state_type = State

    def __init__(self, settings: Settings) -> None:
        self.settings = settings
        self.rule = say("rule.othello") if settings.flank else say("rule.othello-single")
        self._pitch_m = settings.pitch_m
        self._half_m = SIDE / 2 * settings.pitch_m
        self._radius2_m2 = settings.disc_radius_m**2
        self.markers = tuple(
            MarkerInfo(
                name=f"c{column}r{row}",
                kind="disc",
                x_m=(column - (SIDE - 1) / 2) * settings.pitch_m,
                y_m=(row - (SIDE - 1) / 2) * settings.pitch_m,
                radius_m=settings.disc_radius_m,
                points=1,
            )
            for row in range(SIDE)
            for column in range(SIDE)
        )
        starts = (self.markers[SIDE * row + column] for column, row in settings.start_cells)
        self.starts = opposite(Place(disc.x_m, disc.y_m, 0.0) for disc in starts)
        side_m = (SIDE - 1) * settings.pitch_m + 2 * (settings.disc_radius_m + settings.wall_m)
        self.size_m = (side_m, side_m)
        self._rays = tuple(_rays(cell) for cell in range(SIDE * SIDE))
        self.neighbours = tuple(tuple(ray[0] for ray in rays) for rays in self._rays)
        """For each disc, the discs next to it in its row and its column."""

    def start(self) -> State:
        """Return the first state: the opening board, and the robots on their start cells."""
        left, right = (self.cell_at(places[0].x_m, places[0].y_m) for places in self.starts)
        return State(_opening(self.settings.opening, left, right), (left, right))

    def cell_at(self, x_m: float, y_m: float) -> int:
        """Return the disc that a point lies on, or `NO_CELL`.

        If discs touch (the pitch is twice the radius), a point between two discs counts for the
        outer one, and a point on the field's middle line for neither. So the board is the same when
        the field is turned by 180 degrees.
        """
        ax_m, ay_m = abs(x_m), abs(y_m)
        if not (0.0 < ax_m < self._half_m and 0.0 < ay_m < self._half_m):
            return NO_CELL
        pitch_m = self._pitch_m
        column, row = int(ax_m / pitch_m), int(ay_m / pitch_m)  # counted from the middle
        dx_m, dy_m = ax_m - (column + 0.5) * pitch_m, ay_m - (row + 0.5) * pitch_m
        if dx_m * dx_m + dy_m * dy_m > self._radius2_m2:
            return NO_CELL
        half = SIDE // 2
        return SIDE * (half + row if y_m > 0 else half - 1 - row) + (
            half + column if x_m > 0 else half - 1 - column
        )

    def flips(self, cells: tuple[int, ...], seat: int, origin: int, cell: int) -> tuple[int, ...]:
        """Return the discs that flip when a robot enters one (workshop 5-1 rules 4 and 5).

        Args:
            cells: the board before the flip.
            seat: the robot's seat.
            origin: the robot's last cell.
            cell: the disc that it enters.

        Returns:
            The entered disc, then the discs of its row and column that flip too; empty if nothing
            flips.
        """
        own = seat + 1
        if (
            origin == NO_CELL
            or cells[cell] == own
            or cells[origin] != own
            or cell not in self.neighbours[origin]
        ):
            return ()
        flipped = [cell]
        if self.settings.flank:
            for ray in self._rays[cell]:
                for length, end in enumerate(ray):
                    if cells[end] == own:
                        flipped += ray[:length]
                        break
                    if cells[end] == NEUTRAL:
                        break
        return tuple(flipped)

    def step(
        self,
        state: State,
        observation: Observation,
        dt_s: float,
        struck: AbstractSet[Claim] = frozenset(),
    ) -> tuple[State, tuple[GameEvent, ...]]:
        """Judge one tick; see `Game.step`."""
        left, right = observation
        here = (self.cell_at(left.x_m, left.y_m), self.cell_at(right.x_m, right.y_m))
        last = state.last
        walked = left.placed is None and right.placed is None
        if walked and here[0] in (NO_CELL, last[0]) and here[1] in (NO_CELL, last[1]):
            return state, ()
        return self._judge(state, observation, here, struck)

    def _judge(
        self,
        state: State,
        observation: Observation,
        here: tuple[int, int],
        struck: AbstractSet[Claim],
    ) -> tuple[State, tuple[GameEvent, ...]]:
        origins = [self._origin(*pair) for pair in zip(state.last, observation, strict=True)]
        entered = [
            cell if cell != origin else NO_CELL for cell, origin in zip(here, origins, strict=True)
        ]
        cells = list(state.cells)
        events: dict[int, GameEvent] = {}
        contested = entered[0] == entered[1] != NO_CELL and cells[entered[0]] == NEUTRAL
        for seat, cell in enumerate(entered):
            if cell == NO_CELL or contested or (seat, self.markers[cell].name) in struck:
                continue
            flipped = self.flips(state.cells, seat, origins[seat], cell)
            if flipped:
                events[cell] = self._event(seat, flipped)
                for flip in flipped:
                    cells[flip] = seat + 1
        last = tuple(
            origin if cell == NO_CELL else cell for origin, cell in zip(origins, here, strict=True)
        )
        after = State(tuple(cells), (last[0], last[1]))
        return state if after == state else after, tuple(events[cell] for cell in sorted(events))

    def _origin(self, last: int, robot: RobotView) -> int:
        if robot.placed is None:
            return last
        return self.cell_at(robot.placed.x_m, robot.placed.y_m)

    def _event(self, seat: int, flipped: tuple[int, ...]) -> GameEvent:
        entered, *run = (self.markers[cell].name for cell in flipped)
        return GameEvent(
            kind="flip",
            seat=seat,
            marker=entered,
            also=tuple(run),
            points=len(flipped),
            said=say("event.flip", team="", marker=entered, also=run),
        )

    def board(self, state: State) -> tuple[int, ...]:
        """Return the state of each disc, by its index."""
        return state.cells

    def score(self, state: State) -> tuple[int, ...]:
        """Return the number of discs of each team (workshop 5-1 rule 6)."""
        return state.cells.count(LEFT), state.cells.count(RIGHT)

    def over(self, state: State) -> Phrase | None:
        """Return why the match is over: a team has no disc left (rules 5).

        None if it is not over.
        """
        for colour, seat in ((LEFT, "left"), (RIGHT, "right")):
            if colour not in state.cells:
                return say("over.no-disc", seat=seat)
        return None

    def winner(self, state: State, scores: tuple[int, ...]) -> int | None:
        """Return the seat with more points; None for a draw (workshop 5-1 rule 7)."""
        return leader(scores)

    def gains(self, state: State, seat: int) -> Gains:
        """Return the discs beside the robot's last cell that would score if it walked onto them."""
        last = state.last[seat]
        if last == NO_CELL:
            return Gains()
        disc, owner = self.markers[last].name, state.cells[last]
        if owner == NEUTRAL:
            return Gains(said=say("gains.neutral-disc", marker=disc))
        if owner != seat + 1:
            return Gains(said=say("gains.their-disc", marker=disc))
        points = {
            self.markers[cell].name: len(flipped)
            for cell in self.neighbours[last]
            if (flipped := self.flips(state.cells, seat, last, cell))
        }
        said = say("gains.flip", marker=disc) if points else say("gains.inside", marker=disc)
        return Gains(said=said, points=points)

    def set(self, state: State, marker: int, value: int) -> State:
        """Set the colour of a disc, as a referee decides; see `Game.set`."""
        if value not in (NEUTRAL, LEFT, RIGHT):
            raise NoSuchState(say("why.disc-state"))
        cells = (*state.cells[:marker], value, *state.cells[marker + 1 :])
        return State(cells, state.last)


def make(settings: dict[str, Any]) -> Othello:
    """Make the game from the table [game] of an arena file.

    Raises:
        msgspec.ValidationError: if a setting is wrong; the message names it.
    """
    return Othello(msgspec.convert(settings, Settings))


def _rays(cell: int) -> tuple[tuple[int, ...], ...]:
    """Return the discs on each side (right, left, above, below) of a disc, the nearest first.

    A side without discs is left out.
    """
    row, column = divmod(cell, SIDE)
    rays = (
        tuple(SIDE * row + c for c in range(column + 1, SIDE)),
        tuple(SIDE * row + c for c in reversed(range(column))),
        tuple(SIDE * r + column for r in range(row + 1, SIDE)),
        tuple(SIDE * r + column for r in reversed(range(row))),
    )
    return tuple(ray for ray in rays if ray)


def _opening(name: str, left_start: int, right_start: int) -> tuple[int, ...]:
    """Return the board at the start of a match: one of the four openings of rules 5."""
    half = SIDE // 2
    cells = []
    for cell in range(SIDE * SIDE):
        row, column = divmod(cell, SIDE)
        side, other = (LEFT, RIGHT) if column < half else (RIGHT, LEFT)
        if name == "halves":
            cells.append(side)
        elif name == "checkers":
            cells.append(side if (column + row) % 2 == 0 else other)
        elif cell in (left_start, right_start):
            cells.append(LEFT if cell == left_start else RIGHT)
        else:
            centre = name == "reversi" and {row, column} <= {half - 1, half}
            cells.append(side if centre else NEUTRAL)
    return tuple(cells)
