"""Reads what a court advised about a match from the match's events."""

from collections.abc import Iterable

from lacoc_shared.messages import Event
from lacoc_shared.words import Phrase, faults

_MOST = 20
"""Most reasons that are read: a court has fewer, but a program in its place may send any number."""


def advice(events: Iterable[Event]) -> tuple[Phrase, ...]:
    """Return the reasons of the court's newest advice to play the match again; empty: it gave none.

    Only reasons that a court can give count: texts `health.*`, with the values that they need.
    """
    reasons: object = ()
    for event in events:
        if event.kind == "advice":
            reasons = event.said.values.get("reasons", ())
    listed = reasons if isinstance(reasons, list | tuple) else ()
    return tuple(one for one in listed[:_MOST] if isinstance(one, Phrase) and _is_reason(one))


def _is_reason(phrase: Phrase) -> bool:
    return phrase.code.startswith("health.") and not faults(phrase)
