"""Tests of pauses and breaks as everybody sees them, and of what ends with the contest."""

import pytest
from cup import Cup

from lacoc_server.contest.league.contest import end_ms
from lacoc_server.contest.league.facts import (
    Announced,
    Closed,
    Drawn,
    Moved,
    Paused,
    Planned,
    Replay,
    Resumed,
)
from lacoc_server.contest.league.formats.installed import FORMATS
from lacoc_server.contest.league.sheet import sheet
from lacoc_server.contest.league.timetable.breaks import Break
from lacoc_server.contest.league.timetable.schedule import due
from lacoc_shared.words import render


def pause_of(cup: Cup) -> Break | None:
    """Return the pause in the sheet."""
    return sheet("Cup", cup.contest).pause


def test_a_pause_says_until_when_and_what_comes_after_it() -> None:
    """In a pause the sheet names its end, if there is one, and the next match."""
    cup = Cup(teams=3)
    assert pause_of(cup) is None
    cup.add(Paused, reason="a cable")
    pause = pause_of(cup)
    assert pause is not None
    assert (pause.until_ms, pause.who) != (0, None)
    assert pause.until_ms == 0
    assert pause.who is not None
    assert [render(who) for who in pause.who] == ["t002", "t003"]
    cup.add(Paused, until_ms=cup.now_ms + 60_000)
    pause = pause_of(cup)
    assert pause is not None
    assert pause.until_ms == cup.now_ms + 60_000
    cup.add(Resumed)
    assert pause_of(cup) is None


def test_a_break_before_a_stage_is_a_pause_too() -> None:
    """Between two stages the sheet says when the break ends; a called game ends it."""
    cup = Cup(teams=2)
    cup.add(Planned, stage="finals", format="single-knockout", after="cup", break_s=600.0)
    cup.add(Closed)
    (match,) = cup.contest.stages[0].matches
    assert match.next_seats is not None
    cup.won(match.pairing.id, match.next_seats)
    draw = due(cup.contest, FORMATS)
    assert isinstance(draw, Drawn)
    cup.append(draw)
    pause = pause_of(cup)
    assert pause is not None
    assert pause.fixture is not None
    assert (pause.until_ms, render(pause.fixture)) == (cup.now_ms + 600_000, "Final")
    (final,) = cup.contest.stages[1].matches
    assert final.next_seats is not None
    cup.call(final.pairing.id, "north", final.next_seats)
    assert pause_of(cup) is None


@pytest.mark.parametrize("is_pause", [True, False])
def test_a_match_that_was_moved_to_a_later_time_does_not_follow_a_break(*, is_pause: bool) -> None:
    """What follows a break or a pause with an end is the match that is called then."""
    cup = Cup("single-knockout", teams=4)
    first, second = cup.contest.stages[0].matches[:2]
    until_ms = cup.now_ms + 60_000
    cup.add(Moved, pairing=first.pairing.id, not_before_ms=until_ms + 60_000)
    if is_pause:
        cup.add(Paused, until_ms=until_ms)
    else:
        cup.add(Moved, pairing=second.pairing.id, not_before_ms=until_ms)
    pause = pause_of(cup)
    assert pause is not None
    assert pause.fixture is not None
    assert (pause.until_ms, render(pause.fixture)) == (until_ms, "Semi-final 2")


@pytest.mark.parametrize(
    ("length_ms", "ends_ms"), [(59_999, 90_010), (60_000, 120_000), (89_989, 120_000)]
)
def test_a_pause_of_minutes_ends_at_a_full_minute(length_ms: int, ends_ms: int) -> None:
    """Pages tell the end of a pause in minutes, so nobody is called in the minute before."""
    assert end_ms(30_011, length_ms) == ends_ms


def test_a_line_and_a_pause_end_with_the_contest() -> None:
    """What was said before the end is over with it; a line after the end stays.

    A match that is played again opens the contest, and the line with it.
    """
    cup = Cup(teams=2)
    cup.add(Announced, text="Lunch until one")
    cup.add(Paused, reason="lunch")
    (match,) = cup.contest.stages[0].matches
    assert match.next_seats is not None
    cup.won(match.pairing.id, match.next_seats)
    assert cup.contest.over
    assert (cup.contest.announced, cup.contest.day.paused, pause_of(cup)) == (None, False, None)
    cup.add(Announced, text="Prizes at five")
    assert cup.contest.announced is not None
    assert cup.contest.announced.text == "Prizes at five"
    cup.add(
        Replay, pairing=match.pairing.id, game=1, teams=match.next_seats, reason="a wrong robot"
    )
    assert not cup.contest.over
    assert cup.contest.day.paused
