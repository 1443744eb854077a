"""The events of one match, in order, although the court may restart and send some of them again."""

from collections.abc import Iterator, Sequence
from typing import Generic, TypeVar

from lacoc_shared.keyspace import EVENTS_LISTED
from lacoc_shared.messages import Event
from lacoc_shared.seat import BEATS_PER_S

T = TypeVar("T")


class EventLog(Generic[T]):
    """Keeps the events of a match, each as one object: the event itself, or its bytes.

    An event that a restarted court sends again is not new. If an event differs from the known event
    with its number, earlier events stay valid and later ones are dropped.
    """

    def __init__(self) -> None:
        self._known: dict[int, tuple[Event, T]] = {}
        self._first = 1
        """Lowest event number that the court still lists."""
        self.number = 0
        """Version of the log; a new one means that events before the newest may have changed."""

    def __iter__(self) -> Iterator[T]:
        return iter([kept for _, kept in self._known.values()])

    def differs(self, match: int, beat: int, number: int) -> bool:
        """Return whether the known events differ from the court's: some are missing, or are others.

        Args:
            match: number of the open match, from the court's `Health` message.
            beat: beat of that message.
            number: number of the newest event at that beat, counted from 1 without a gap; 0: the
                message does not say it.
        """
        newest = self._known[max(self._known)][0] if self._known else None
        if newest is not None and len(self._known) <= newest.number - self._first:
            return True
        if number == 0:
            return False
        if newest is None or newest.match != match:
            return True
        came_later = beat < newest.beat <= beat + BEATS_PER_S
        return newest.number < number or (newest.number > number and not came_later)

    def restore(self, events: Sequence[tuple[Event, T]]) -> list[Event]:
        """Replace all known events by the list of events that the court has sent.

        Returns:
            The events of the list that were not known, in order.
        """
        before, self._known = self._known, {event.number: (event, kept) for event, kept in events}
        self._first = events[0][0].number if events else 1
        new = [event for event, _ in events if before.get(event.number, (None,))[0] != event]
        self.number += bool(new) or len(before) > len(events)
        return new

    def add(self, event: Event, kept: T) -> bool:
        """Add an event that came; return False if it was known already."""
        known = self._known.get(event.number)
        if known is not None and known[0] == event:
            return False
        of_match = next((one.match for one, _ in self._known.values()), event.match)
        other_match = of_match != event.match
        if other_match:
            self._first = 1
        if known is not None or other_match:
            self._known = (
                {}
                if other_match
                else {n: one for n, one in self._known.items() if n < event.number}
            )
            self.number += 1
        self._known[event.number] = (event, kept)
        if len(self._known) > EVENTS_LISTED:
            del self._known[min(self._known)]
            self._first = min(self._known)
        return True
