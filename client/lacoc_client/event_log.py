"""The events of one match, in their order, from a stream that may begin again."""

from collections.abc import Iterator, Sequence
from typing import Generic, TypeVar

from lacoc_shared.messages import Event

T = TypeVar("T")


class EventLog(Generic[T]):
    """Keeps something for each event: the event itself, or its bytes.

    What a restarted court sends again is not new. Its events come in their order, so at the first
    one that differs, those before it are still true and those after it are not.
    """

    def __init__(self) -> None:
        self._known: dict[int, tuple[Event, T]] = {}
        self.number = 0
        """Another number: the log began anew."""

    def __iter__(self) -> Iterator[T]:
        return iter([kept for _, kept in self._known.values()])

    @property
    def lacks(self) -> bool:
        """Whether an event before the newest is not there: numbers begin at 1, without a gap."""
        return len(self._known) < max(self._known, default=0)

    def restore(self, events: Sequence[tuple[Event, T]]) -> list[Event]:
        """Take in the whole log of a match as the court has it.

        Args:
            events: all that the court had sent when it was asked, in their order.

        Returns:
            Those that were not known, also later ones, in their order.
        """
        known = list(self._known.values())
        if not events or any(event.match > events[-1][0].match for event, _ in known):
            return []  # the court has begun another match meanwhile
        whole = [*events, *(one for one in known if _follows(one[0], events[-1][0]))]
        before, self._known = self._known, {event.number: (event, kept) for event, kept in whole}
        new = [event for event, _ in whole if before.get(event.number, (None,))[0] != event]
        self.number += bool(new)
        return new

    def add(self, event: Event, kept: T) -> bool:
        """Take an event in; False if it was known."""
        known = self._known.get(event.number)
        if known is not None and known[0] == event:
            return False
        other_match = any(one.match != event.match for one, _ in self._known.values())
        if known is not None or other_match:
            self._known = (
                {}
                if other_match
                else {n: one for n, one in self._known.items() if n < event.number}
            )
            self.number += 1
        self._known[event.number] = (event, kept)
        return True


def _follows(event: Event, last: Event) -> bool:
    return event.match == last.match and event.number > last.number
