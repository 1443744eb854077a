"""Reads what a court advised about a match from the match's events."""

from collections.abc import Iterable

from lacoc_shared.messages import Event
from lacoc_shared.words import Phrase


def advice(events: Iterable[Event]) -> tuple[Phrase, ...]:
    """Return the reasons of a court's newest advice to play a match again; empty: it gave none."""
    reasons: object = ()
    for event in events:
        if event.kind == "advice":
            reasons = event.said.values.get("reasons", ())
    listed = reasons if isinstance(reasons, list | tuple) else ()
    return tuple(one for one in listed if isinstance(one, Phrase))
