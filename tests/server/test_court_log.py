"""Tests of the court's log: events of a match, and lines on refusals, slow beats and the disk."""

import msgspec
import pytest
from structlog.testing import capture_logs

from lacoc_server.court.log import CourtLog
from lacoc_shared.messages import Event, Health, SeatHealth
from lacoc_shared.words import say

pytestmark = pytest.mark.usefixtures("loud")

LEFT = SeatHealth(id="left", joined=True, heard_ms=9.0, commands_hz=10.0, refused={"flood": 2})
HEALTH = Health(
    match=1,
    beat=25,
    real_time_factor=1.0,
    slow_beats=0,
    worst_late_ms=2.0,
    seats=(LEFT,),
    dropped={},
    decisions={},
)
TROUBLE = say("record.no-room", file="m.mcap", why="disk full")


def test_an_event_is_a_line_with_all_it_has() -> None:
    """Each event is one line with all its fields and the match id; "silent" is a warning.

    If the length of the match is given, the line also has the ticks that are left.
    """
    said = say("event.back", team="Ants")
    flip = Event(number=7, match=1, beat=99, clock_ticks=12, kind="flip", said=said, seat=0)
    with capture_logs() as lines:
        log = CourtLog("main")
        log.event("m-1", flip)
        log.event("m-1", msgspec.structs.replace(flip, kind="silent"), 9000)
    assert lines[0] == {
        "event": "Ants is back.",
        "code": "event.back",
        "log_level": "info",
        "court": "main",
        "match_id": "m-1",
        **{name: getattr(flip, name) for name in flip.__struct_fields__ if name != "said"},
    }
    assert lines[1]["log_level"] == "warning"
    assert lines[1]["left_ticks"] == 8988


def test_what_went_wrong_is_said_once() -> None:
    """Refusals, slow beats and disk trouble are logged when they change, not in every report."""
    flooded = msgspec.structs.replace(LEFT, refused={"flood": 5, "bad-seal": 1})
    worse = msgspec.structs.replace(
        HEALTH,
        seats=(flooded,),
        dropped={"wrong-token": 1},
        slow_beats=3,
        worst_late_ms=61.0,
        record_trouble=TROUBLE,
    )
    with capture_logs() as lines:
        log = CourtLog("main")
        for health in (
            HEALTH,
            HEALTH,
            worse,
            worse,
            msgspec.structs.replace(worse, record_trouble=None),
        ):
            log.health("m-1", health)
    assert [line["event"] for line in lines] == [
        "left seat: 2 messages refused (too many at once).",
        "left seat: 3 messages refused (too many at once).",
        "left seat: 1 message refused (wrong signature).",
        "Desk of referee and office: 1 message refused (wrong token).",
        "Slow beats: 3 new, 3 in all. The worst of all began 61 ms late.",
        "The record m.mcap can't be written: disk full. Make room on its disk.",
        "The record can be written again.",
    ]
    assert [line["code"] for line in lines][-2:] == ["record.no-room", "log.record-again"]
    assert {line["match_id"] for line in lines} == {"m-1"}
    assert {line["log_level"] for line in lines} == {"warning"}


def test_slow_beats_are_told_now_and_then() -> None:
    """If each second has a slow beat, the first is logged at once, then a line for each 30 more."""
    with capture_logs() as lines:
        log = CourtLog("main")
        for second in range(100):
            slow = msgspec.structs.replace(HEALTH, beat=50 * second, slow_beats=second + 1)
            log.health("m-1", slow)
    told = [line for line in lines if line["kind"] == "slow"]
    assert [line["count"] for line in told] == [1, 30, 30, 30]
    assert told[1]["event"].startswith("Slow beats: 30 new, 31 in all")


def test_refusals_of_the_next_team_are_logged() -> None:
    """If the refusals of a seat are counted from zero for another team, the new count is logged."""
    after = msgspec.structs.replace(LEFT, refused={"flood": 1})
    with capture_logs() as lines:
        log = CourtLog("main")
        for seat in (LEFT, after, after):
            log.health("m-1", msgspec.structs.replace(HEALTH, seats=(seat,)))
    assert [line["count"] for line in lines if line["kind"] == "refused"] == [2, 1]
