"""Reads what a court advised about a match from the match's events."""

from collections.abc import Iterable

from lacoc_shared.messages import Event
from lacoc_shared.words import Phrase


def advice(events: Iterable[Event]) -> tuple[Phrase, ...]:
    """Return why the court advised to play a match again at last; empty: it did not."""
    reasons: object = ()
    for event in events:
        if event.kind == "advice":
            reasons = event.said.values.get("reasons", ())
    listed = reasons if isinstance(reasons, list | tuple) else ()
    return tuple(one for one in listed if isinstance(one, Phrase))
