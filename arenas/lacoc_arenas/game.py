"""The interface of a game: pure rules over numbers (docs/architecture.md).

A game is a value made from its settings. It never changes: the state of a match goes into `step`,
and the new state comes out. A game uses no physics engine, network or clock, so the same
observations give the same match on any machine.
"""

from collections.abc import Set as AbstractSet
from typing import Any, NamedTuple, Protocol, TypeVar

import msgspec

from lacoc_shared.messages import Gains, MarkerInfo
from lacoc_shared.words import Phrase, render, say

NEUTRAL, LEFT, RIGHT, DOWN = range(4)
"""States of a marker, in the order of `MARKER_STATES`. A marker that a seat has claimed has the
seat's index + 1 as its state."""

Claim = tuple[int, str]
"""(seat, marker): an event gives the marker to the seat. A referee may strike the claim out (rules
4.1)."""


class NoSuchState(ValueError):
    """Raised when a marker can't have the state that somebody wants to set.

    Args:
        why: the states that the marker can have (`why.*`).
    """

    def __init__(self, why: Phrase) -> None:
        super().__init__(why)
        self.why = why

    def __str__(self) -> str:
        return render(self.why)


class WrongSetting(ValueError):
    """Raised when entries of the table [game] of an arena file are wrong.

    Args:
        mistakes: each entry, and what is wrong with it (`setting.*`).
    """

    def __init__(self, *mistakes: Phrase) -> None:
        super().__init__(*mistakes)
        self.mistakes = mistakes

    def __str__(self) -> str:
        return render(say("join.semicolon")).join(map(render, self.mistakes))


class Place(NamedTuple):
    """A place on the floor at which a robot can start, in the world frame."""

    x_m: float
    y_m: float
    heading_rad: float
    """Direction of the body's +y (forward), counter-clockwise from the world's +x."""


class RobotView(NamedTuple):
    """The data of one robot that the rules see after a tick, in the world frame."""

    x_m: float
    """Origin of the body frame (x, y, z) [m]."""
    y_m: float
    z_m: float
    qw: float
    """Orientation of the body as a quaternion (w, x, y, z)."""
    qx: float
    qy: float
    qz: float
    placed: Place | None = None
    """Where the robot was put at the beginning of this tick; None if nothing put it anywhere."""
    touched: tuple[int, ...] = ()
    """Indices of the markers whose probe any part of the robot touches."""


Observation = tuple[RobotView, ...]
"""What the rules see after a tick: one `RobotView` for each seat."""


class GameEvent(msgspec.Struct, frozen=True, kw_only=True):
    """Something that the rules decided in a tick, such as a flip or a strike."""

    kind: str
    """The game's own word for what happened, such as flip, capture or strike."""
    seat: int
    marker: str
    """The marker that was claimed; with `seat` it names the claim."""
    also: tuple[str, ...] = ()
    """Further markers that changed with the claimed one, such as the runs of discs in rules 5."""
    points: int = 0
    """Points that the seat gains."""
    said: Phrase
    """What happened, as a whole sentence. The game leaves its value `team` as ""; the match fills
    it in. A game that is not part of LACOC uses `event.other`."""


S = TypeVar("S", bound=msgspec.Struct)


class Game(Protocol[S]):
    """The rules of a game, made by its arena's `rules.make(settings)`."""

    rule: Phrase | None
    """What the game is about and how one scores, in a sentence for players and spectators
    (`rule.*`); None: pages show no such sentence."""
    state_type: type[S]
    """The struct that holds the state of a match; msgpack must be able to encode it."""
    markers: tuple[MarkerInfo, ...]
    """The board: discs, corners, flags; empty for a game without a board."""
    starts: tuple[tuple[Place, ...], ...]
    """The start places of each seat, the best first."""
    size_m: tuple[float, float]
    """Inner width (x) and depth (y) of the field between its walls."""

    def start(self) -> S:
        """Return the state before the first tick: robots stand on their first start places."""

    def step(
        self,
        state: S,
        observation: Observation,
        dt_s: float,
        struck: AbstractSet[Claim] = frozenset(),
    ) -> tuple[S, tuple[GameEvent, ...]]:
        """Judge one tick.

        Args:
            state: the state before the tick.
            observation: one view of each robot after the tick, by seat.
            dt_s: length of the tick [s].
            struck: claims of this tick that a referee struck out; they have no effect.

        Returns:
            The state after the tick (the same object if nothing changed) and what happened, in
            an order that does not depend on which seat is evaluated first.
        """

    def board(self, state: S) -> tuple[int, ...]:
        """Return the state of each marker: NEUTRAL, LEFT, RIGHT or DOWN."""

    def score(self, state: S) -> tuple[int, ...]:
        """Return the points of each seat."""

    def over(self, state: S) -> Phrase | None:
        """Return why the match is over before its time is up (`over.*`); None if it is not over."""

    def winner(self, state: S, scores: tuple[int, ...]) -> int | None:
        """Return who wins if the match ends now.

        Args:
            state: the state at the end.
            scores: points with the referee's adjustments.

        Returns:
            The seat's index, or None for a draw.
        """

    def gains(self, state: S, seat: int) -> Gains:
        """Return which points a robot could gain next, to show its player; no rule uses the answer.

        Args:
            state: the present state.
            seat: the robot's seat.
        """

    def set(self, state: S, marker: int, value: int) -> S:
        """Set a marker, as a referee decides.

        Raises:
            NoSuchState: if a marker of this kind has no such state.
        """


def leader(scores: tuple[int, ...]) -> int | None:
    """Return the seat with the most points; None if two share the most (rules 5 and 6: a draw)."""
    best = max(scores)
    leaders = [seat for seat, score in enumerate(scores) if score == best]
    return leaders[0] if len(leaders) == 1 else None


AnyGame = Game[Any]
