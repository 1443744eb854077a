"""Sentences as earlier versions logged them, so that their records can be compared.

Until decisions said what they changed for whom, a log had only the number of the event that was
taken back, and no score.
"""

from collections.abc import Sequence

import msgspec

from lacoc_shared.messages import Event
from lacoc_shared.words import Phrase, say


def in_earlier_words(recorded: Sequence[Event], again: Sequence[Event]) -> tuple[Event, ...]:
    """Return events in the words of the recorded ones, where those have earlier words."""
    if len(recorded) != len(again):
        return (*again,)
    pairs = zip(recorded, again, strict=True)
    return tuple(
        _earlier(now) if _did(then) in _EARLIER and _did(now) in _NOW else now
        for then, now in pairs
    )


_EARLIER = ("decision.take-back", "decision.set")
_NOW = ("decision.took-back", "decision.set-for", "decision.set-so")


def _did(event: Event) -> str:
    did = event.said.values.get("did")
    return did.code if isinstance(did, Phrase) else ""


def _earlier(event: Event) -> Event:
    given = event.data["arguments"]
    if event.data["decision"] == "take-back":
        did = say("decision.take-back", event=given["event"])
    else:
        did = say("decision.set", marker=given["marker"], state=given["state"])
    said = event.said.with_values(did=did)
    return msgspec.structs.replace(event, said=said)
