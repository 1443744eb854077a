"""The rules of Flag-Strike (workshop 5-2, rules 6).

The markers are "corner0" to "corner3" (bottom left, bottom right, top left, top right) and then
"flag0" to "flag19" in the order of the arena file. A flag's state on the board is NEUTRAL while it
stands, LEFT or RIGHT when it has fallen for that team, and DOWN when it has fallen for nobody (only
a referee sets this).

A referee may take a claim back (rules 4.1). After a capture that was taken back, the robot counts
as inside the corner without having taken it, until it leaves and comes back. If a strike is taken
back, the touch that made it is void until the robot lets go of the flag. Meanwhile the other robot
can strike the flag.

All events of one tick happen at the same time. They are listed in the order of the markers, which
does not favour a seat.
"""

from collections.abc import Iterator
from collections.abc import Set as AbstractSet
from typing import Any

import msgspec

from lacoc_arenas.game import (
    DOWN,
    LEFT,
    NEUTRAL,
    RIGHT,
    Claim,
    GameEvent,
    NoSuchState,
    Observation,
    Place,
    RobotView,
    leader,
)
from lacoc_arenas.layout import opposite
from lacoc_shared.messages import Gains, MarkerInfo
from lacoc_shared.words import Phrase, say

from .settings import Settings

CORNERS = 4
NO_CORNER = -1


class State(msgspec.Struct, frozen=True):
    """The state of a match of Flag-Strike."""

    board: tuple[int, ...]
    """(24,) the state of each corner, then of each flag."""
    inside: tuple[int, int]
    """The corner that each robot's centre is in, or `NO_CORNER`."""
    void: tuple[tuple[int, int], ...] = ()
    """(seat, marker) of each touch that a referee took back and that has not ended."""


class FlagStrike:
    """The rules of Flag-Strike with given settings."""

    state_type = State

    def __init__(self, settings: Settings) -> None:
        self.settings = settings
        corner = settings.corner_points
        self.rule = (
            say("rule.flag-strike-corners", corner=corner)
            if settings.all_corners_win
            else say("rule.flag-strike", corner=corner)
        )
        self.size_m = settings.size_m
        self.markers = (
            *(
                MarkerInfo(
                    name=f"corner{number}",
                    kind="corner",
                    x_m=x_m,
                    y_m=y_m,
                    radius_m=settings.corner_radius_m,
                    points=settings.corner_points,
                )
                for number, (x_m, y_m) in enumerate(settings.corners)
            ),
            *(
                MarkerInfo(
                    name=flag.name,
                    kind="flag",
                    x_m=flag.x_m,
                    y_m=flag.y_m,
                    radius_m=settings.pole_radius_m,
                    points=flag.colour.points,
                )
                for flag in settings.flags
            ),
        )
        self.starts = opposite(Place(x_m, y_m, 0.0) for x_m, y_m in settings.starts)
        self._points = tuple(marker.points for marker in self.markers)
        self._corner_x_m, self._corner_y_m = settings.corners[-1]
        self._radius2_m2 = settings.corner_radius_m**2

    def start(self) -> State:
        """Return the first state: corners neutral, flags standing, robots on their start places."""
        left, right = (self.corner_at(places[0].x_m, places[0].y_m) for places in self.starts)
        return State((NEUTRAL,) * len(self.markers), (left, right))

    def corner_at(self, x_m: float, y_m: float) -> int:
        """Return the corner whose circle contains a point, or `NO_CORNER`."""
        dx_m, dy_m = abs(x_m) - self._corner_x_m, abs(y_m) - self._corner_y_m
        if dx_m * dx_m + dy_m * dy_m <= self._radius2_m2:
            return (x_m > 0) + 2 * (y_m > 0)
        return NO_CORNER

    def step(
        self,
        state: State,
        observation: Observation,
        dt_s: float,
        struck: AbstractSet[Claim] = frozenset(),
    ) -> tuple[State, tuple[GameEvent, ...]]:
        """Judge one tick; see `Game.step`."""
        left, right = observation
        inside = (self.corner_at(left.x_m, left.y_m), self.corner_at(right.x_m, right.y_m))
        if (
            inside == state.inside
            and left.placed is right.placed is None
            and not (state.void or struck)
            # Touching a flag that has fallen has no effect.
            and not any(state.board[flag] == NEUTRAL for flag in left.touched + right.touched)
        ):
            return state, ()
        captures = tuple(self._captures(state, observation, inside, struck))
        void, strikes = self._strikes(state, observation, struck)
        claims = sorted((*captures, *strikes))
        board = list(state.board)
        for marker, seat in claims:
            board[marker] = seat + 1
        after = State(tuple(board), inside, void)
        return (
            state if after == state else after,
            tuple(self._event(marker, seat) for marker, seat in claims),
        )

    def _captures(
        self,
        state: State,
        observation: Observation,
        inside: tuple[int, int],
        struck: AbstractSet[Claim],
    ) -> Iterator[tuple[int, int]]:
        """Yield corner and seat for each robot that takes a corner by entering it in this tick."""
        came = [
            now if now != self._inside(was, robot) else NO_CORNER
            for now, was, robot in zip(inside, state.inside, observation, strict=True)
        ]
        if came[0] == came[1]:  # both in one tick: the corner keeps its state
            return
        for seat, corner in enumerate(came):
            if (
                corner != NO_CORNER
                and state.board[corner] != seat + 1
                and (seat, self.markers[corner].name) not in struck
            ):
                yield corner, seat

    def _inside(self, was: int, robot: RobotView) -> int:
        if robot.placed is None:
            return was
        return self.corner_at(robot.placed.x_m, robot.placed.y_m)

    def _strikes(
        self, state: State, observation: Observation, struck: AbstractSet[Claim]
    ) -> tuple[tuple[tuple[int, int], ...], list[tuple[int, int]]]:
        """Find the flags that are struck in a tick, and the touches that do not count.

        Returns:
            The touches that are void after the tick, each as (seat, flag); and the strikes, each as
            (flag, seat).
        """
        void: list[tuple[int, int]] = []
        touching: dict[int, list[int]] = {}
        for seat, robot in enumerate(observation):
            for marker in robot.touched:
                if (seat, marker) in state.void or (seat, self.markers[marker].name) in struck:
                    void.append((seat, marker))
                elif state.board[marker] == NEUTRAL:
                    touching.setdefault(marker, []).append(seat)
        strikes = [(marker, seats[0]) for marker, seats in touching.items() if len(seats) == 1]
        return tuple(sorted(void)), strikes

    def _event(self, marker: int, seat: int) -> GameEvent:
        name, points = self.markers[marker].name, self.markers[marker].points
        if marker < CORNERS:
            kind, said = "capture", say("event.capture", team="", marker=name, points=points)
        else:
            kind, said = "strike", say("event.strike", team="", marker=name, points=points)
        return GameEvent(kind=kind, seat=seat, marker=name, points=points, said=said)

    def board(self, state: State) -> tuple[int, ...]:
        """Return the state of each corner, then of each flag."""
        return state.board

    def score(self, state: State) -> tuple[int, ...]:
        """Return each seat's points, for the corners that it holds and the flags that it struck."""
        left = right = 0
        for owner, points in zip(state.board, self._points, strict=True):
            if owner == LEFT:
                left += points
            elif owner == RIGHT:
                right += points
        return left, right

    def over(self, state: State) -> Phrase | None:
        """Return why the match is over: one team has all corners (workshop 5-2 rule 4).

        None if it is not over.
        """
        holder = self._holder(state)
        return None if holder is None else say("over.all-corners", seat=("left", "right")[holder])

    def winner(self, state: State, scores: tuple[int, ...]) -> int | None:
        """Return the seat with more points; or, if `all_corners_win`, the one with all corners.

        None for a draw (workshop 5-2 rule 8).
        """
        if self.settings.all_corners_win:
            holder = self._holder(state)
            if holder is not None:
                return holder
        return leader(scores)

    @staticmethod
    def _holder(state: State) -> int | None:
        first, *others = state.board[:CORNERS]
        return first - 1 if first != NEUTRAL and others == [first] * len(others) else None

    def gains(self, state: State, seat: int) -> Gains:
        """Return what would score for this robot next: standing flags, and corners not its own.

        A corner does not count while the robot is in it.
        """
        own, inside = seat + 1, state.inside[seat]
        flags = [
            flag
            for flag, owner in enumerate(state.board)
            if flag >= CORNERS and owner == NEUTRAL and (seat, flag) not in state.void
        ]
        lacking = [corner for corner in range(CORNERS) if state.board[corner] != own]
        corners = [corner for corner in lacking if corner != inside]
        points = {self.markers[marker].name: self._points[marker] for marker in corners + flags}
        if inside in lacking:
            said = say("gains.enter-again", marker=self.markers[inside].name)
        elif len(lacking) == 1:
            said = say("gains.last-corner", marker=self.markers[lacking[0]].name)
        elif flags:
            said = say("gains.flags", flags=len(flags), points=sum(self._points[f] for f in flags))
        else:
            said = say("gains.corners")
        return Gains(said=said, points=points)

    def set(self, state: State, marker: int, value: int) -> State:
        """Set a corner or a flag, as a referee decides; see `Game.set`."""
        if marker < CORNERS and value == DOWN:
            raise NoSuchState(say("why.corner-state"))
        board = (*state.board[:marker], value, *state.board[marker + 1 :])
        return msgspec.structs.replace(state, board=board)


def make(settings: dict[str, Any]) -> FlagStrike:
    """Make the game from the table [game] of an arena file.

    Raises:
        msgspec.ValidationError: if a setting is wrong; the message names it.
    """
    return FlagStrike(msgspec.convert(settings, Settings))
