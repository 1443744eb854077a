"""Tests of what an office takes from a court's advice."""

import pytest

from lacoc_server.contest.league.advice import advice
from lacoc_shared.messages import Event
from lacoc_shared.words import Phrase, say

LATE = say("health.late-beat", late_ms=300.0, most_ms=200.0)
SILENT = say("health.silent-seat", seat="left", seconds=9.0, most_s=5.0)


def told(*said: Phrase, kind: str = "advice") -> list[Event]:
    """Return events with these sentences."""
    numbered = enumerate(said, 1)
    return [
        Event(number=n, match=1, beat=n, clock_ticks=0, kind=kind, said=one) for n, one in numbered
    ]


def test_the_newest_advice_counts() -> None:
    """A court may change its advice as long as the result is not official, and take it back."""
    assert advice([]) == ()
    assert advice(told(say("event.advised", reasons=(LATE, SILENT)))) == (LATE, SILENT)
    both = told(say("event.advised", reasons=(LATE,)), say("event.not-advised"))
    assert advice(both) == ()
    assert advice(told(say("event.advised", reasons=(LATE,)), kind="decision")) == ()


@pytest.mark.parametrize(
    "reasons",
    [
        (),
        "late",
        ("late", 3),
        (say("event.wins", team="Ants", scores=(1, 2)),),
        (Phrase("health.late-beat"),),
        (Phrase("health.late-beat", {"late_ms": LATE, "most_ms": 200.0}),),
        (Phrase("health.nothing"),),
    ],
)
def test_what_no_court_says_is_left_out(reasons: object) -> None:
    """Reasons that no health verdict has are left out, and more than a court has too."""
    phrase = Phrase("event.advised", {"reasons": reasons})  # type: ignore[dict-item]
    assert advice(told(phrase)) == ()
    assert len(advice(told(say("event.advised", reasons=(LATE,) * 1000)))) == 20
