"""Tests that records whose log has earlier sentences are still compared, in those sentences."""

from pathlib import Path

import pytest

from lacoc_server.journal.replay import verify
from lacoc_server.journal.verdict import Verdict, VerdictKind
from lacoc_shared.messages import Event
from lacoc_shared.record.earlier_words import in_earlier_words
from lacoc_shared.record.reader import Record
from lacoc_shared.words import Phrase, say

SCORE = say("score.two", left="Ants", points=9, conceded=27, right="Bees")
STRUCK = say("struck.event", kind="flip", marker="c2r3", team="Ants")
TAKE_BACK = {"type": "take-back", "event": 20}
SET = {"type": "set", "marker": "c2r3", "state": "left"}
ADJUST = {"type": "adjust", "seat": "left", "points": 5}


def decided(did: Phrase, arguments: dict[str, object]) -> Event:
    """Return the event of a decision."""
    said = say("event.decided", by="Kim", did=did, reason="rule")
    data = {"decision": arguments["type"], "by": "Kim", "arguments": arguments}
    return Event(number=30, match=1, beat=4, clock_ticks=3, kind="decision", said=said, data=data)


@pytest.mark.parametrize(
    ("earlier", "now", "arguments"),
    [
        (
            say("decision.take-back", event=20),
            say("decision.took-back", what=STRUCK, score=SCORE),
            TAKE_BACK,
        ),
        (
            say("decision.set", marker="c2r3", state="left"),
            say("decision.set-for", marker="c2r3", team="Ants", score=SCORE),
            SET,
        ),
        (
            say("decision.adjust", points=5, team="Ants"),
            say("decision.adjust", points=5, team="Ants", score=SCORE),
            ADJUST,
        ),
    ],
)
def test_a_decision_in_earlier_words_is_the_same(
    earlier: Phrase, now: Phrase, arguments: dict[str, object]
) -> None:
    """A recorded decision without its effect equals the one that says it; nothing else does."""
    recorded, again = decided(earlier, arguments), decided(now, arguments)
    assert in_earlier_words([recorded], [again]) == (recorded,)
    assert in_earlier_words([again], [again]) == (again,)
    other = decided(now, {**arguments, "event": 21, "marker": "c0r0"})
    assert in_earlier_words([recorded], [other]) != (recorded,)
    assert in_earlier_words([], [again]) == (again,)


def test_a_record_of_an_earlier_version_gives_the_same_match() -> None:
    """A whole match of an earlier version, with most decisions, is proven."""
    record = Record.read(Path(__file__).with_name("earlier.mcap"))
    *_, verdict = verify(record, processes=1)
    assert isinstance(verdict, Verdict)
    assert verdict.kind is not VerdictKind.DIFFERS  # another processor has other last bits
