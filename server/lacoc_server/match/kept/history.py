"""Everything that the rules saw and decided, so that an event can be taken back (rules 4.1).

A match keeps every observation since its first event that can be taken back. To take an event back,
it judges the game again from there, without the event's claim. Paths, clock and all other decisions
stay as they were, and nothing is deleted from the log.

A step is a judged tick, or a referee's change of a marker. The numbers of an observation are
kept as bytes; a step has a note only if something else happened in it. Three minutes need 1 MB.
"""

from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass
from struct import Struct
from typing import Any

import msgspec
from msgspec.structs import replace

from lacoc_arenas.game import AnyGame, Claim, GameEvent, Observation, Place, RobotView
from lacoc_shared.codec import decode, encode
from lacoc_shared.seat import BEAT_S
from lacoc_shared.words import Phrase

_VIEW_NUMBERS = 7
"""How many of the fields of a `RobotView` are numbers; the others are empty in most ticks."""
_VIEW = Struct(f"<{_VIEW_NUMBERS}d")


class SetMarker(msgspec.Struct, frozen=True):
    """A referee's change of a marker, between two ticks; if `struck`, it was taken back."""

    marker: int
    value: int
    struck: bool = False


class Note(msgspec.Struct, frozen=True):
    """What happened in a step: a tick that the rules judged, or a referee's change of a marker.

    The numbers that the rules saw in the step (the robots' motion) are kept apart.
    """

    changed: SetMarker | None = None
    """The change of a marker; None: the step is an observation."""
    placed: tuple[Place | None, ...] = ()
    """For each robot the place where it was put, or None; empty: no robot was put anywhere."""
    touched: tuple[tuple[int, ...], ...] = ()
    """For each robot the markers that it touched; empty: no robot touched any."""
    events: tuple[GameEvent, ...] = ()
    """The events that the rules decided from the observation."""
    numbers: tuple[int, ...] = ()
    """Numbers of `events` in the log; for a change of a marker, the number of its decision."""
    struck: frozenset[Claim] = frozenset()
    """Claims of events that were taken back; the rules ignore them."""
    idle: tuple[int, ...] = ()
    """Seats whose claims do not count, because no key has moved their robots yet."""


_PLAIN = Note()


class SavedHistory(msgspec.Struct, frozen=True):
    """A `History` in the form in which a match saves it; states of the game are msgpack."""

    state: msgspec.Raw
    over: Phrase | None
    first: msgspec.Raw
    first_over: Phrase | None
    views: int
    count: int
    seen: bytes
    notes: dict[int, Note]


@dataclass(frozen=True)
class Fold:
    """The result of judging a match again without one event; the match itself is unchanged."""

    notes: dict[int, Note]
    """Notes of all steps, as judged again."""
    state: Any
    over: Phrase | None
    """Why the game is over; None: it is not."""
    vanished: tuple[tuple[int, GameEvent], ...]
    """Events that disappear, with their numbers."""
    appeared: tuple[tuple[int, int, GameEvent], ...]
    """New events, with the index of their step and their index in that step."""


class History:
    """The state of a match's game, and all that the rules saw and decided, for take-backs."""

    def __init__(self, game: AnyGame) -> None:
        self._game = game
        self.state: Any = game.start()
        """The game's state now."""
        self.over: Phrase | None = None
        """Why the game was over after the newest tick; None: the game was not over. A change of a
        marker by a referee shows here from the next tick on."""
        self._judged: Any = None
        """The newest state for which `over` was computed."""
        self._keeps = True
        """False after `keep_nothing`: then no event can be taken back."""
        self._step_of: dict[int, int] = {}
        """For each event that can be taken back, the index of its step."""
        self._views = 0
        """Number of robots in an observation."""
        # The steps since `_first`, which is the state before the first of them.
        self._first: Any = self.state
        self._first_over: Phrase | None = None
        self._count = 0
        self._seen = bytearray()
        self._notes: dict[int, Note] = {}

    def observe(
        self, observation: Observation, next_number: int, idle: tuple[int, ...] = ()
    ) -> list[GameEvent]:
        """Judge one tick and return its events.

        Args:
            observation: what the rules see.
            next_number: log number of the first new event; each further event gets the next one.
            idle: seats whose claims do not count.
        """
        self.state, events = self._step(self.state, observation, frozenset(), idle)
        if self.state is not self._judged:
            self._judged, self.over = self.state, self._game.over(self.state)
        if events and self._keeps:
            numbers = tuple(range(next_number, next_number + len(events)))
            self._keep(_note(observation, events, numbers, idle), numbers)
        elif self._step_of:
            self._keep(_note(observation, idle=idle), ())
        else:
            self._forget()
            return list(events)
        self._views = len(observation)
        for view in observation:
            self._seen += _VIEW.pack(*view[:_VIEW_NUMBERS])
        return list(events)

    def set(self, marker: int, value: int, number: int) -> None:
        """Set a marker, by a referee's decision.

        Args:
            marker: index of the marker.
            value: its new state.
            number: event number of the decision.

        Raises:
            NoSuchState: if the marker has no such state.
            UserError: if another author's code is wrong.
        """
        self.state = self._game.set(self.state, marker, value)
        if self._keeps:
            self._keep(Note(SetMarker(marker, value), numbers=(number,)), (number,))
        else:
            self._forget()

    def keep_nothing(self) -> None:
        """Forget what the rules saw and decided, now and later: no event can be taken back then.

        So beats take less time, and a save of a match of three minutes has 10 kB instead of 1 MB.
        """
        self._keeps, self._step_of = False, {}
        self._forget()

    def knows(self, number: int) -> bool:
        """Return whether an event can be taken back.

        The game or `set` must have made it, and no take-back may have removed it.
        """
        return number in self._step_of

    def event(self, number: int) -> GameEvent | int:
        """Return an event that can be taken back; of a referee's change, the index of the marker.

        Raises:
            KeyError: if the event can't be taken back (see `knows`).
        """
        note = self._notes[self._step_of[number]]
        if note.changed is not None:
            return note.changed.marker
        return note.events[note.numbers.index(number)]

    def without(self, number: int) -> Fold:
        """Judge the game again without one event; this history does not change.

        Raises:
            KeyError: if the event can't be taken back (see `knows`).
        """
        first = self._step_of[number]
        state, over = self._first, self._first_over
        notes: dict[int, Note] = {}
        vanished: list[tuple[int, GameEvent]] = []
        appeared: list[tuple[int, int, GameEvent]] = []
        for index, old, observation in self._steps():
            note = _strike(old, number) if index == first else old
            if observation is None:
                assert note.changed is not None
                if not note.changed.struck:
                    state = self._game.set(state, note.changed.marker, note.changed.value)
                notes[index] = note
                continue
            events: tuple[GameEvent, ...] = ()
            if not over:
                state, events = self._step(state, observation, note.struck, note.idle)
                over = self._game.over(state)
            if events or note is not _PLAIN:
                before = dict(zip(old.events, old.numbers, strict=True))
                numbers = tuple(before.get(event, 0) for event in events)
                notes[index] = replace(note, events=events, numbers=numbers)
                appeared += [
                    (index, place, event)
                    for place, event in enumerate(events)
                    if event not in before
                ]
                vanished += [
                    (old_number, event)
                    for event, old_number in before.items()
                    if event not in events
                ]
        return Fold(notes, state, over, tuple(vanished), tuple(appeared))

    def accept(self, fold: Fold, next_number: int) -> None:
        """Carry out a take-back: use the judgement without the event from now on.

        Args:
            fold: the judgement without the event, from `without`.
            next_number: log number for the first event of `fold.appeared`; later ones follow.
        """
        self._notes = dict(fold.notes)
        for number, (index, place, _) in enumerate(fold.appeared, next_number):
            note = self._notes[index]
            numbers = (*note.numbers[:place], number, *note.numbers[place + 1 :])
            self._notes[index] = replace(note, numbers=numbers)
        self.state, self.over, self._judged = fold.state, fold.over, None
        self._find_steps()

    def save(self) -> SavedHistory:
        """Return the whole history as a value."""
        state, first = (msgspec.Raw(encode(which)) for which in (self.state, self._first))
        return SavedHistory(
            state,
            self.over,
            first,
            self._first_over,
            self._views,
            self._count,
            bytes(self._seen),
            self._notes,
        )

    def load(self, saved: SavedHistory) -> None:
        """Go on from a saved history of the same game.

        After `keep_nothing`, only the state of the game, and why it is over, are taken from it.

        Raises:
            BadMessage: if a state is not one of this game.
        """
        kind = self._game.state_type
        self.state, self.over = decode(bytes(saved.state), kind), saved.over
        self._first, self._first_over = decode(bytes(saved.first), kind), saved.first_over
        self._judged = None
        self._views, self._count = saved.views, saved.count
        self._seen, self._notes = bytearray(saved.seen), dict(saved.notes)
        self._find_steps()
        if not self._keeps:
            self.keep_nothing()

    def _step(
        self,
        state: Any,
        observation: Observation,
        struck: frozenset[Claim],
        idle: tuple[int, ...],
    ) -> tuple[Any, tuple[GameEvent, ...]]:
        """Judge one tick; ignore the claims of `struck` (events taken back), and of idle seats."""
        after, events = self._game.step(state, observation, BEAT_S, struck)
        while idle and (more := _claims(events, idle) - struck):
            struck |= more
            after, events = self._game.step(state, observation, BEAT_S, struck)
        return after, events

    def _keep(self, note: Note, numbers: tuple[int, ...]) -> None:
        """Keep the note of a step: a tick that the rules judged, or a referee's change of a marker.

        Args:
            note: what happened in the step.
            numbers: log numbers of the step's events; from now on each can be taken back.
        """
        for number in numbers:
            self._step_of[number] = self._count
        if note is not _PLAIN:
            self._notes[self._count] = note
        self._count += 1

    def _forget(self) -> None:
        """Forget the ticks that the rules have judged.

        It is called only when they have no event that can be taken back. Judging again will begin
        with the present state. So memory does not grow in a practice, which has no such events and
        may go on for days.
        """
        self._first, self._first_over = self.state, self.over
        if self._count:
            self._count, self._seen, self._notes = 0, bytearray(), {}

    def _steps(self) -> Iterator[tuple[int, Note, Observation | None]]:
        """Yield each tick that the rules judged, and each referee's change of a marker, in order.

        Each comes with its index, its note and what the rules saw (None for a change of a marker).
        """
        size = _VIEW.size * self._views
        seen = memoryview(self._seen)
        offset = 0
        for index in range(self._count):
            note = self._notes.get(index, _PLAIN)
            if note.changed is not None:
                yield index, note, None
                continue
            yield index, note, _observation(seen[offset : offset + size], self._views, note)
            offset += size

    def _find_steps(self) -> None:
        self._step_of = {
            number: index
            for index, note in self._notes.items()
            for number in note.numbers
            if note.changed is None or not note.changed.struck
        }


def _claims(events: Iterable[GameEvent], seats: Collection[int]) -> frozenset[Claim]:
    return frozenset((event.seat, event.marker) for event in events if event.seat in seats)


def _note(
    observation: Observation,
    events: tuple[GameEvent, ...] = (),
    numbers: tuple[int, ...] = (),
    idle: tuple[int, ...] = (),
) -> Note:
    """Return the note of a tick that the rules judged; `_PLAIN` if robots only moved in it.

    A note is needed if a robot was put at a place, touched a marker or is idle, or if the rules
    decided an event.
    """
    placed = touched = False
    for view in observation:
        placed = placed or view.placed is not None
        touched = touched or bool(view.touched)
    if not (placed or touched or events or idle):
        return _PLAIN
    return Note(
        None,
        tuple(view.placed for view in observation) if placed else (),
        tuple(view.touched for view in observation) if touched else (),
        events,
        numbers,
        idle=idle,
    )


def _observation(packed: memoryview, views: int, note: Note) -> Observation:
    placed = note.placed or (None,) * views
    touched = note.touched or ((),) * views
    return tuple(
        RobotView._make((*numbers, place, touch))
        for numbers, place, touch in zip(_VIEW.iter_unpack(packed), placed, touched, strict=True)
    )


def _strike(note: Note, number: int) -> Note:
    """Return a note in which an event, or a referee's change of a marker, is marked as taken back.

    Args:
        note: note of the tick in which the event happened, or of the change.
        number: number of the event, or of the decision that changed the marker.
    """
    if note.changed is not None:
        return replace(note, changed=replace(note.changed, struck=True))
    event = note.events[note.numbers.index(number)]
    return replace(note, struck=note.struck | {(event.seat, event.marker)})
