"""Reads and compares records of protocol 1, whose sentences are English texts.

All other modules handle only protocol 2 (docs/decisions/0016-words.md).
"""

from collections.abc import Sequence
from typing import Any

import msgspec

from lacoc_shared import codec
from lacoc_shared.messages import Event
from lacoc_shared.record.earlier_words import in_earlier_words
from lacoc_shared.record.schema import Header, Result
from lacoc_shared.words import Phrase, say

_WORDS = ("words", "changes", "vanished")
"""Entries of an event's data that contain words, or that exist only in protocol 2."""


class _OldEvent(msgspec.Struct, frozen=True, kw_only=True):
    """An event of a match, as records of protocol 1 have it."""

    number: int
    match: int
    beat: int
    clock_ticks: int
    kind: str
    text: str
    seat: int = -1
    data: dict[str, Any] = {}


def read_event(data: bytes, max_bytes: int) -> Event:
    """Decode an event from a record of protocol 1 or 2.

    Raises:
        BadMessage: if it is not an event of either protocol.
    """
    try:
        return codec.decode(data, Event, max_bytes)
    except codec.BadMessage as error:
        try:
            old = codec.decode(data, _OldEvent, max_bytes)
        except codec.BadMessage:
            raise error from None
    fields = msgspec.structs.asdict(old)
    return Event(said=say("plain.text", text=fields.pop("text")), **fields)


def fault_of(event: Event) -> Phrase:
    """Return the reason why physics stopped, as a recorded event gives it."""
    why = event.said.values.get("why")
    return why if isinstance(why, Phrase) else say("plain.text", text=str(event.data.get("words")))


def same_events(header: Header, recorded: Sequence[Event], again: Sequence[Event]) -> bool:
    """Return whether a replay's events of a beat equal the recorded ones.

    In a record of protocol 1, differences between sentences do not count. The sentence about rules
    that failed never counts: it names a file, which is elsewhere on another machine.
    """
    if _is_old(header):
        return list(map(_bare, recorded)) == list(map(_bare, again))
    again = in_earlier_words(recorded, again)
    return list(map(_compared, recorded)) == list(map(_compared, again))


def same_result(header: Header, recorded: Result, again: Result) -> bool:
    """Return whether the result of a replay equals the recorded one.

    In a record of protocol 1, the two may give different reasons why the match ended.
    """
    if _is_old(header):
        again = msgspec.structs.replace(again, reason=recorded.reason)
    return recorded == again


def _is_old(header: Header) -> bool:
    return header.versions.get("protocol") == "1"


def _compared(event: Event) -> bytes:
    return _bare(event) if event.kind == "rules" else codec.encode(event)


def _bare(event: Event) -> bytes:
    """Encode an event without its sentences, to compare it with another one."""
    data = {name: value for name, value in event.data.items() if name not in _WORDS}
    return codec.encode(msgspec.structs.replace(event, said=say("plain.text", text=""), data=data))
