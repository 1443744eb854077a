"""The rules of practice (rules 7): a robot walks; there is nothing to win."""

import math
from collections.abc import Set as AbstractSet
from typing import Annotated, Any

import msgspec

from lacoc_arenas.game import Claim, GameEvent, NoSuchState, Observation, Place, WrongSetting
from lacoc_arenas.layout import Length, Point
from lacoc_shared.messages import Gains, MarkerInfo
from lacoc_shared.words import Phrase, say


class Settings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The table [game] of the arena file of practice."""

    size_m: tuple[Length, Length]
    start: Point
    heading_deg: Annotated[float, msgspec.Meta(ge=-360, le=360)]

    def __post_init__(self) -> None:
        if any(abs(at) >= size / 2 for at, size in zip(self.start, self.size_m, strict=True)):
            x_m, y_m = map(str, self.start)
            raise WrongSetting(say("setting.start-outside", x_m=x_m, y_m=y_m))


class State(msgspec.Struct, frozen=True):
    """The state of a practice match: empty, because there is nothing to win."""


class Practice:
    """The rules of practice with given settings."""

    rule = say("rule.practice")
    state_type = State
    markers: tuple[MarkerInfo, ...] = ()

    def __init__(self, settings: Settings) -> None:
        self.size_m = settings.size_m
        self.starts = ((Place(*settings.start, math.radians(settings.heading_deg)),),)

    def start(self) -> State:
        """Return the only state that a practice match has."""
        return State()

    def step(
        self,
        state: State,
        observation: Observation,
        dt_s: float,
        struck: AbstractSet[Claim] = frozenset(),
    ) -> tuple[State, tuple[GameEvent, ...]]:
        """Return the same state and no events, because practice has no rules to apply."""
        return state, ()

    def board(self, state: State) -> tuple[int, ...]:
        """Return no states: there are no markers."""
        return ()

    def score(self, state: State) -> tuple[int, ...]:
        """Return 0 points for the only seat."""
        return (0,)

    def over(self, state: State) -> Phrase | None:
        """Return None: practice has no early end."""
        return None

    def winner(self, state: State, scores: tuple[int, ...]) -> int | None:
        """Return None: nobody wins in practice."""
        return None

    def gains(self, state: State, seat: int) -> Gains:
        """Return no gains: nothing scores in practice."""
        return Gains()

    def set(self, state: State, marker: int, value: int) -> State:
        """Raise an error: there is no marker to set.

        Raises:
            NoSuchState: always.
        """
        raise NoSuchState(say("why.no-markers"))


def make(settings: dict[str, Any]) -> Practice:
    """Make the game from the table [game] of an arena file.

    Raises:
        msgspec.ValidationError: if a setting is wrong; the message names it.
    """
    return Practice(msgspec.convert(settings, Settings))
