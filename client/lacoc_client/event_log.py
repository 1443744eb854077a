"""The events of one match, in their order, from a stream that may begin again."""

from collections.abc import Iterator
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
