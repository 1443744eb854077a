"""Puts sentences into the form in which earlier versions logged them, to compare old records.

In old logs, the sentence about a take-back has only the number of the event, and that about a set
marker has no team; sentences about points have no score.
"""

from collections.abc import Sequence

import msgspec

from lacoc_shared.messages import Event
from lacoc_shared.words import Phrase, say


def in_earlier_words(recorded: Sequence[Event], again: Sequence[Event]) -> tuple[Event, ...]:
    """Return a replay's events, with older forms of sentences where the record has these.

    Args:
        recorded: the events of the record.
        again: the events of its replay.
    """
    if len(recorded) != len(again):
        return (*again,)
    pairs = zip(recorded, again, strict=True)
    return tuple(_earlier(now) if _had_fewer_words(then, now) else now for then, now in pairs)


_EARLIER = ("decision.take-back", "decision.set")
_NOW = ("decision.took-back", "decision.set-for", "decision.set-so")
_ADJUST = "decision.adjust"


def _had_fewer_words(then: Event, now: Event) -> bool:
    before, after = _did(then), _did(now)
    if before is None or after is None:
        return False
    if before.code == after.code == _ADJUST:
        return "score" not in before.values and "score" in after.values
    return before.code in _EARLIER and after.code in _NOW


def _did(event: Event) -> Phrase | None:
    did = event.said.values.get("did")
    return did if isinstance(did, Phrase) else None


def _earlier(event: Event) -> Event:
    given = event.data["arguments"]
    match event.data["decision"]:
        case "take-back":
            did = say("decision.take-back", event=given["event"])
        case "adjust":
            now = _did(event)
            assert now is not None
            values = {name: value for name, value in now.values.items() if name != "score"}
            did = Phrase(now.code, values)
        case _:
            did = say("decision.set", marker=given["marker"], state=given["state"])
    return msgspec.structs.replace(event, said=event.said.with_values(did=did))
