"""What every game is: pure rules over numbers (docs/architecture.md).

A game is a value made from its settings. It holds nothing that changes: the state of
a match goes in and comes out of `step`. It knows no physics, network or clock, so the
same observations give the same match anywhere.
"""

from collections.abc import Set as AbstractSet
from typing import Any, NamedTuple, Protocol, TypeVar

import msgspec

from lacoc_shared.messages import MarkerInfo
from lacoc_shared.words import Phrase, render

NEUTRAL, LEFT, RIGHT, DOWN = range(4)
"""States of a marker; a seat's own state is its index + 1. Same order as `MARKER_STATES`."""

Claim = tuple[int, str]
"""(seat, marker): what a referee strikes out (rules 4, take-back)."""


class NoSuchState(ValueError):
    """A marker can't be set to a state.

    Args:
        why: which states it has (`why.*`).
    """

    def __init__(self, why: Phrase) -> None:
        super().__init__(why)
        self.why = why

    def __str__(self) -> str:
        return render(self.why)


class Place(NamedTuple):
    """A start place on the floor, in the world's frame."""

    x_m: float
    y_m: float
    heading_rad: float
    """Direction of the body's +y (forward), counter-clockwise from the world's +x."""


class RobotView(NamedTuple):
    """What the rules see of a robot after a tick."""

    x_m: float
    """Body frame's origin in the world."""
    y_m: float
    z_m: float
    qw: float
    """Quaternion of the body in the world."""
    qx: float
    qy: float
    qz: float
    placed: Place | None = None
    """Where it was put at the beginning of this tick; None if it walked."""
    touched: tuple[int, ...] = ()
    """Indices of the markers whose probe any part of it touches."""


Observation = tuple[RobotView, ...]
"""One view for each seat."""


class GameEvent(msgspec.Struct, frozen=True, kw_only=True):
    """Something that the rules decided in a tick."""

    kind: str
    """flip, capture, strike: a game's own word."""
    seat: int
    marker: str
    """The marker that was claimed; with the seat it names the claim."""
    also: tuple[str, ...] = ()
    """Markers that changed with it (the runs of rules 5)."""
    points: int = 0
    """What the seat gains by it."""
    said: Phrase
    """What happened, as a whole sentence; its value `team` is "", and the match fills it in. A game
    that is no part of LACOC says `event.other`."""


S = TypeVar("S", bound=msgspec.Struct)


class Game(Protocol[S]):
    """The rules of a game, made by its arena's `rules.make(settings)`."""

    state_type: type[S]
    """The struct that holds a match of this game; can be encoded (snapshots)."""
    markers: tuple[MarkerInfo, ...]
    """The board: discs, corners, flags; empty for a game without one."""
    starts: tuple[tuple[Place, ...], ...]
    """For each seat its start places, the best first."""
    size_m: tuple[float, float]
    """Inner width (x) and depth (y) of the field between its walls."""

    def start(self) -> S:
        """The state before the first tick: robots stand on their first start places."""

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
            observation: what the robots did in it, one view a seat.
            dt_s: length of the tick [s].
            struck: claims of this tick that a referee struck out; they have no effect.

        Returns:
            The state after the tick (the same object if nothing changed) and what happened, in
            an order that does not depend on which seat is evaluated first.
        """

    def board(self, state: S) -> tuple[int, ...]:
        """State of each marker: NEUTRAL, LEFT, RIGHT or DOWN."""

    def score(self, state: S) -> tuple[int, ...]:
        """Points of each seat."""

    def over(self, state: S) -> Phrase | None:
        """Why the match is over before its time is up (`over.*`); None while it is not."""

    def winner(self, state: S, scores: tuple[int, ...]) -> int | None:
        """Who has won if the match ends now.

        Args:
            state: the state at the end.
            scores: points with the referee's adjustments.

        Returns:
            The seat's index, or None for a draw.
        """

    def set(self, state: S, marker: int, value: int) -> S:
        """Set a marker, as a referee decides.

        Raises:
            NoSuchState: if a marker of this kind has no such state.
        """


def leader(scores: tuple[int, ...]) -> int | None:
    """The seat with the most points; None where two share the most (rules 5 and 6: a draw)."""
    best = max(scores)
    leaders = [seat for seat, score in enumerate(scores) if score == best]
    return leaders[0] if len(leaders) == 1 else None


AnyGame = Game[Any]
