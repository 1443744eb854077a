"""The rules of practice (rules 4): a place to walk, with nothing to win."""

import math
from collections.abc import Set as AbstractSet
from typing import Annotated, Any

import msgspec

from lacoc_arenas.game import Claim, GameEvent, NoSuchState, Observation, Place
from lacoc_arenas.layout import Length, Point
from lacoc_shared.messages import MarkerInfo
from lacoc_shared.words import Phrase, say


class Settings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The table [game] of the arena file."""

    size_m: tuple[Length, Length]
    start: Point
    heading_deg: Annotated[float, msgspec.Meta(ge=-360, le=360)]

    def __post_init__(self) -> None:
        if any(abs(at) >= size / 2 for at, size in zip(self.start, self.size_m, strict=True)):
            raise ValueError(f"start {list(self.start)} is outside the walls")


class State(msgspec.Struct, frozen=True):
    """Nothing is kept: there is nothing to win."""


class Practice:
    """The game for one choice of settings."""

    state_type = State
    markers: tuple[MarkerInfo, ...] = ()

    def __init__(self, settings: Settings) -> None:
        self.size_m = settings.size_m
        self.starts = ((Place(*settings.start, math.radians(settings.heading_deg)),),)

    def start(self) -> State:
        """The one state there is."""
        return State()

    def step(
        self,
        state: State,
        observation: Observation,
        dt_s: float,
        struck: AbstractSet[Claim] = frozenset(),
    ) -> tuple[State, tuple[GameEvent, ...]]:
        """Nothing happens."""
        return state, ()

    def board(self, state: State) -> tuple[int, ...]:
        """There are no markers."""
        return ()

    def score(self, state: State) -> tuple[int, ...]:
        """Always 0."""
        return (0,)

    def over(self, state: State) -> Phrase | None:
        """Never."""
        return None

    def winner(self, state: State, scores: tuple[int, ...]) -> int | None:
        """Nobody wins in practice."""
        return None

    def set(self, state: State, marker: int, value: int) -> State:
        """There is nothing to set.

        Raises:
            NoSuchState: always.
        """
        raise NoSuchState(say("why.no-markers"))


def make(settings: dict[str, Any]) -> Practice:
    """The game of an arena file's table [game].

    Raises:
        msgspec.ValidationError: if a setting is wrong; the message names it.
    """
    return Practice(msgspec.convert(settings, Settings))
