"""What the rules saw and decided, so that one event can be taken back (rules 4.1).

A match keeps every observation since its first event that can be taken back. To take an event back,
it judges the game again from the event's tick, without the event's claim. Paths, clock and all
other decisions stay as they were, and nothing is deleted from the log.
"""

from dataclasses import dataclass
from typing import Any

import msgspec
from msgspec.structs import replace

from lacoc_arenas.game import AnyGame, Claim, GameEvent, Observation
from lacoc_shared.seat import BEAT_S
from lacoc_shared.words import Phrase


class SetMarker(msgspec.Struct, frozen=True):
    """A referee's change of a marker, between two ticks; `struck`: it was taken back."""

    marker: int
    value: int
    struck: bool = False


class Step(msgspec.Struct, frozen=True):
    """One observation or change of a marker, and what the rules made of it."""

    seen: Observation | SetMarker
    before: Any
    """The game's state before the step."""
    events: tuple[GameEvent, ...] = ()
    numbers: tuple[int, ...] = ()
    """Numbers of those events in the log; for a `SetMarker`, the number of its decision."""
    struck: frozenset[Claim] = frozenset()
    over: Phrase | None = None
    """Why the game was over after this step; None: it was not. When the game is judged again,
    observations after it are kept, but not judged.
    """


@dataclass(frozen=True)
class Fold:
    """Result of a take-back, before it is accepted."""

    steps: list[Step]
    """All steps, as judged again."""
    state: Any
    over: Phrase | None
    """Why the game is over; None: it is not."""
    vanished: tuple[tuple[int, GameEvent], ...]
    """Events that disappear, with their numbers."""
    appeared: tuple[tuple[int, int, GameEvent], ...]
    """New events, with the index of their step and their index in that step."""


class History:
    """The judged ticks of a match, and the state of its game."""

    def __init__(self, game: AnyGame) -> None:
        self._game = game
        self.state: Any = game.start()
        """The game's state now."""
        self._steps: list[Step] = []
        """All steps from the one before the first event that can be taken back."""
        self._step_of: dict[int, int] = {}
        self._judged: tuple[Any, Phrase | None] = (None, None)
        """The newest state after a tick, and why the game was over in it; None: it was not."""

    def observe(self, observation: Observation, next_number: int) -> list[GameEvent]:
        """Judge one tick and return its events; they get the numbers from `next_number` on."""
        before = self.state
        self.state, events = self._game.step(before, observation, BEAT_S)
        numbers = tuple(range(next_number, next_number + len(events))) if events else ()
        if self.state is not self._judged[0]:
            self._judged = (self.state, self._game.over(self.state))
        self._append(Step(observation, before, events, numbers, over=self._judged[1]))
        return list(events)

    @property
    def over(self) -> Phrase | None:
        """Why the game is over; None: it is not."""
        return self._steps[-1].over if self._steps else None

    def set(self, marker: int, value: int, number: int) -> None:
        """Set a marker, by a referee's decision.

        Args:
            marker: index of the marker.
            value: its new state.
            number: event number of the decision.

        Raises:
            NoSuchState: if the marker has no such state.
        """
        before = self.state
        self.state = self._game.set(before, marker, value)
        step = Step(SetMarker(marker, value), before, (), (number,), over=self.over)
        self._append(step)

    def knows(self, number: int) -> bool:
        """Return whether an event can be taken back.

        The game or `set` must have made it, and no take-back may have removed it.
        """
        return number in self._step_of

    def without(self, number: int) -> Fold:
        """Judge the game again without one event; the history stays as it is.

        Raises:
            KeyError: if the event can't be taken back (see `knows`).
        """
        first = self._step_of[number]
        steps = self._steps[:first]
        state = self._steps[first].before
        over = self._steps[first - 1].over if first else None
        vanished: list[tuple[int, GameEvent]] = []
        appeared: list[tuple[int, int, GameEvent]] = []
        for index in range(first, len(self._steps)):
            old = self._steps[index]
            seen, struck = old.seen, old.struck
            if index == first:
                seen, struck = _strike(old, number)
            after = state
            events: tuple[GameEvent, ...] = ()
            numbers: tuple[int, ...] = ()
            if isinstance(seen, SetMarker):
                numbers = old.numbers
                if not seen.struck:
                    after = self._game.set(state, seen.marker, seen.value)
            elif not over:
                after, events = self._game.step(state, seen, BEAT_S, struck)
                over = self._game.over(after)
                before = dict(zip(old.events, old.numbers, strict=True))
                numbers = tuple(before.get(event, 0) for event in events)
                appeared += [
                    (index, place, event)
                    for place, event in enumerate(events)
                    if event not in before
                ]
            vanished += [
                (old_number, event)
                for event, old_number in zip(old.events, old.numbers, strict=False)
                if event not in events
            ]
            steps.append(Step(seen, state, events, numbers, struck, over))
            state = after
        return Fold(steps, state, over, tuple(vanished), tuple(appeared))

    def accept(self, fold: Fold, next_number: int) -> None:
        """Replace the history by a fold; number its new events from `next_number` on."""
        self._steps = list(fold.steps)
        for number, (index, place, _) in enumerate(fold.appeared, next_number):
            step = self._steps[index]
            numbers = (*step.numbers[:place], number, *step.numbers[place + 1 :])
            self._steps[index] = replace(step, numbers=numbers)
        self.state = fold.state
        self._step_of = {
            number: index
            for index, step in enumerate(self._steps)
            for number in step.numbers
            if not (isinstance(step.seen, SetMarker) and step.seen.struck)
        }

    def _append(self, step: Step) -> None:
        if not (step.numbers or self._step_of):
            # Judging again begins at an event; without one only the newest step is needed. A
            # practice has no events and may go on for days.
            self._steps.clear()
        for number in step.numbers:
            self._step_of[number] = len(self._steps)
        self._steps.append(step)


def _strike(step: Step, number: int) -> tuple[Observation | SetMarker, frozenset[Claim]]:
    """Return a step's observation or change, and its struck claims, with one more event struck."""
    if isinstance(step.seen, SetMarker):
        return SetMarker(step.seen.marker, step.seen.value, struck=True), step.struck
    event = step.events[step.numbers.index(number)]
    return step.seen, step.struck | {(event.seat, event.marker)}
