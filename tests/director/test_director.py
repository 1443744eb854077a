"""Tests of the director: its rules hold for any courts, and it shows what matters."""

from bisect import bisect_right
from collections.abc import Callable, Sequence
from itertools import pairwise
from pathlib import Path

import msgspec
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lacoc_client.web.director.courts import CourtNow
from lacoc_client.web.director.director import AHEAD_S, RESULT_S, Director
from lacoc_client.web.director.moments import Track
from lacoc_client.web.director.plan import CUTS_MOST, MINUTE_S
from lacoc_client.web.director.results import Results, ShownResult
from lacoc_client.web.director.stakes import USUAL, stake
from lacoc_shared.seat import BEAT_S, Phase
from lacoc_shared.words import Phrase, say

LINES = Path(__file__).with_name("lines.json")
"""Four matches of bots: the length of each, and each beat at which its phase or scores change."""
LOOK_S = 0.5
LENGTH_S = 45.0


class Shown(msgspec.Struct, frozen=True):
    """What was on air from a time on."""

    at_s: float
    court: str
    why: str


Event = Callable[[float], Sequence[CourtNow]]
"""How all courts stand at a time."""


def direct(event: Event, end_s: float, ahead_s: float) -> list[Shown]:
    """Let a director watch the courts; return each court that was on air, from when, and why.

    Each time is when the pictures were played: `ahead_s` before they were on air.
    """
    director = Director(ahead_s)
    shown: list[Shown] = []
    for look in range(round((end_s + ahead_s) / LOOK_S)):
        now_s = look * LOOK_S
        shot = director.look(now_s, event(now_s))
        if shot is not None and (not shown or shown[-1].court != shot.court):
            shown.append(Shown(now_s - ahead_s, shot.court, shot.why))
    return shown


def at(event: Event, time_s: float, court: str) -> CourtNow | None:
    """Return how a court stands at a time; None: the court is not there."""
    return next((one for one in event(max(0.0, time_s)) if one.name == court), None)


class Script(msgspec.Struct, frozen=True):
    """An invented court: matches follow each other, with 15 s for each result."""

    begins_s: float
    swings: tuple[tuple[float, int], ...]
    """Times after the first beginning [s], and what the first seat gains then."""
    gone: tuple[float, float]
    """It is not there between these times [s]."""
    stake: float

    def now(self, name: str, time_s: float) -> CourtNow | None:
        """Return how the court stands at a time; None: the court is not there."""
        if self.gone[0] <= time_s < self.gone[1]:
            return None
        since_s = time_s - self.begins_s
        if since_s < 0:
            return CourtNow(name, "0", Phase.LOBBY, LENGTH_S, (0, 0), self.stake)
        match, played_s = divmod(since_s, LENGTH_S + 15)
        gained = [
            size for when_s, size in self.swings if match * (LENGTH_S + 15) <= when_s <= since_s
        ]
        scores = (10 + sum(one for one in gained if one > 0), 10 - sum(min(0, g) for g in gained))
        phase = Phase.PLAYING if played_s < LENGTH_S else Phase.OFFICIAL
        left_s = max(0.0, LENGTH_S - played_s)
        return CourtNow(name, f"{match}", phase, left_s, scores, self.stake)


TIMES = st.floats(0, 150, allow_nan=False).map(lambda time_s: round(time_s / LOOK_S) * LOOK_S)
SCRIPTS = st.lists(
    st.builds(
        Script,
        begins_s=TIMES,
        swings=st.lists(st.tuples(TIMES, st.integers(-10, 10)), max_size=25).map(tuple),
        gone=st.one_of(
            st.just((0.0, 0.0)), st.tuples(TIMES, TIMES).map(lambda two: tuple(sorted(two)))
        ),
        stake=st.sampled_from([USUAL, 1.5, 3.0]),
    ),
    min_size=2,
    max_size=8,
)
AHEAD = st.sampled_from([0.0, 2.0, AHEAD_S])


def invented(scripts: Sequence[Script]) -> Event:
    """Return a function that tells how the courts stand at a time; each script is one court."""

    def event(time_s: float) -> Sequence[CourtNow]:
        there = (one.now(f"court-{index}", time_s) for index, one in enumerate(scripts))
        return [one for one in there if one is not None]

    return event


@settings(max_examples=25, deadline=None)
@given(SCRIPTS, AHEAD)
def test_the_rules_hold_for_any_courts(scripts: list[Script], ahead_s: float) -> None:
    """The director cuts at most four times a minute, and never from a close end or a new result.

    The same courts give the same cuts.
    """
    event = invented(scripts)
    shown = direct(event, 160.0, ahead_s)
    assert direct(event, 160.0, ahead_s) == shown

    cuts = [one.at_s for one in shown[1:]]
    for index, at_s in enumerate(cuts):
        assert bisect_right(cuts, at_s + MINUTE_S) - index <= CUTS_MOST

    for before, after in pairwise(shown):
        left = at(event, after.at_s, before.court)
        if left is None:
            continue  # it has vanished
        assert not left.is_closing
        if left.is_over:
            earlier = at(event, after.at_s - RESULT_S + 2 * LOOK_S, before.court)
            assert earlier is None or earlier.is_over


@settings(max_examples=25, deadline=None)
@given(SCRIPTS, AHEAD)
def test_the_second_picture_shows_another_court(scripts: list[Script], ahead_s: float) -> None:
    """The second picture shows a court that is there and not on air; each stays two seconds.

    It shows a moment from at most 1 s before it to at most 3 s after it.
    """
    event = invented(scripts)
    director = Director(ahead_s)
    before, since_s = None, 0.0
    for look in range(round((160.0 + ahead_s) / LOOK_S)):
        now_s = look * LOOK_S
        shot = director.look(now_s, event(now_s))
        shown_s, aside = now_s - ahead_s, director.aside
        assert shot is not None or aside is None
        there = [one.name for one in event(max(0.0, shown_s))]
        if aside is not None and shot is not None:
            assert aside.court != shot.court
            assert aside.court in there
            assert aside.at_s - 1.0 - LOOK_S <= shown_s <= aside.at_s + 3.0
        if aside is None or before is None or aside.court != before.court:
            if before is not None and shot is not None and before.court in there:
                assert shown_s - since_s >= 2.0 or before.court == shot.court
            since_s = shown_s
        before = aside


@settings(max_examples=25, deadline=None)
@given(SCRIPTS, AHEAD)
def test_a_court_that_vanishes_is_left(scripts: list[Script], ahead_s: float) -> None:
    """A court that is not there is left as soon as the rules allow another cut."""
    event = invented(scripts)
    director = Director(ahead_s)
    cuts: list[float] = []
    on_air = ""
    for look in range(round((160.0 + ahead_s) / LOOK_S)):
        now_s = look * LOOK_S
        shot = director.look(now_s, event(now_s))
        if shot is None:
            continue
        if on_air and shot.court != on_air:
            cuts.append(now_s)
        on_air = shot.court
        there = [one.name for one in event(now_s - ahead_s)] if now_s >= ahead_s else [on_air]
        recent = [one for one in cuts if now_s - one <= MINUTE_S + LOOK_S]
        has_cut = len(recent) < CUTS_MOST and not (cuts and now_s - cuts[-1] < 3.0)
        assert on_air in there or not there or not has_cut


def recorded() -> Event:
    """Give each recorded match a court of its own; each begins 20 s after the one before it."""
    found = msgspec.json.decode(LINES.read_bytes())
    beats = [[point[0] for point in one["points"]] for one in found]

    def event(time_s: float) -> list[CourtNow]:
        courts = []
        for index, one in enumerate(found):
            beat = round((time_s - 20 * index) / BEAT_S)
            place = bisect_right(beats[index], beat) - 1
            since, phase, clock_ticks, scores = one["points"][max(0, place)]
            if place < 0:
                phase = Phase.LOBBY
            ticks = clock_ticks + (beat - since) * (phase == Phase.PLAYING)
            left_s = one["duration_s"] - ticks * BEAT_S
            courts.append(CourtNow(f"court-{index}", "1", Phase(phase), left_s, tuple(scores)))
        return courts

    return event


@pytest.mark.parametrize("ahead_s", [0.0, AHEAD_S])
def test_recorded_matches(ahead_s: float) -> None:
    """At least three of the four largest swings in all matches are on air, 0.5 s late at most."""
    event = recorded()
    shown = direct(event, 250.0, ahead_s)
    swings: list[tuple[int, float, str]] = []
    for look in range(1, round(250.0 / LOOK_S)):
        for before, after in zip(event((look - 1) * LOOK_S), event(look * LOOK_S), strict=True):
            if before.is_played and before.ahead != after.ahead:
                swings.append((abs(after.ahead - before.ahead), look * LOOK_S, after.name))
    largest = sorted(swings, reverse=True)[:4]
    times = [one.at_s for one in shown]

    def on_air(at_s: float) -> str:
        return shown[max(0, bisect_right(times, at_s) - 1)].court

    seen = [court in (on_air(at_s), on_air(at_s + 0.5)) for _, at_s, court in largest]
    assert sum(seen) >= 3
    assert {one.why for one in shown} >= {"swing"}


def test_stakes() -> None:
    """A final counts more than a semi-final, and the last game of a match more than the first."""
    final, semi = say("fixture.final", stage=None), say("fixture.semi-final", stage=None, number=1)
    codes = [final, semi, say("fixture.quarter-final", stage=None, number=1), None]
    weights = [stake(one) for one in codes]
    assert weights == sorted(weights, reverse=True)
    assert weights[-1] == stake(say("fixture.round", stage="all", group=None, round=1)) == USUAL

    def game(number: int) -> Phrase:
        return say("fixture.game", match=semi, game=number, games=3)

    assert stake(semi) == stake(game(1)) < stake(game(3)) < stake(final)


def test_the_final_is_on_air() -> None:
    """A match with more at stake comes on air when it begins, though nothing has happened."""
    scripts = [
        Script(0.0, (), (0.0, 0.0), USUAL),
        Script(10.0, (), (0.0, 0.0), 3.0),
    ]
    shown = direct(invented(scripts), 60.0, AHEAD_S)
    assert [(one.court, one.why) for one in shown][:2] == [
        ("court-0", "first"),
        ("court-1", "stake"),
    ]


def halted(time_s: float) -> list[CourtNow]:
    """Return two courts: a close final that is halted at its end, and a match with a large swing.

    The final begins at 5 s, is halted from 30 s to 40 s, and resumes after a countdown of 5 s.
    """
    played = [(5.0, Phase.PLAYING), (30.0, Phase.HALTED), (40.0, Phase.COUNTDOWN)]
    phases = [(0.0, Phase.LOBBY), *played, (45.0, Phase.PLAYING)]
    phase = [phase for begins_s, phase in phases if begins_s <= time_s][-1]
    final = CourtNow("final", "1", phase, 20.0, (10, 10), 3.0, has_begun=time_s > 5.0)
    other = CourtNow("other", "1", Phase.PLAYING, 150.0, (30 if time_s < 41.0 else 60, 0))
    return [final, other]


def test_what_is_not_worth_a_cut_is_in_the_second_picture() -> None:
    """A large swing during the close end of the court on air comes into the second picture."""
    director = Director(AHEAD_S)
    pictures = set()
    for look in range(160):
        now_s = look * LOOK_S
        shot = director.look(now_s, halted(now_s))
        pictures.add((shot and shot.court, director.aside and director.aside.court))
    assert ("final", "other") in pictures
    assert ("other", "final") not in pictures


@pytest.mark.parametrize("ahead_s", [0.0, AHEAD_S])
def test_a_halted_match_goes_on(ahead_s: float) -> None:
    """In the countdown after a halt, a close end stays on air; the match does not count as new."""
    shown = direct(halted, 60.0, ahead_s)
    assert [one.court for one in shown if one.at_s > 6.0] == []
    assert shown[-1].court == "final"

    track = Track(halted(0.0)[0])
    moments = [
        one for look in range(1, 120) for one in track.see(look * LOOK_S, halted(look * LOOK_S)[0])
    ]
    assert [one.why for one in moments] == ["stake", "closing"]


def test_results_are_as_late_as_all_else() -> None:
    """Results are as late as their courts' pictures; if a match goes on, its result is dropped."""

    def result(court: str, match: str, *scores: int) -> ShownResult:
        return ShownResult(court, match, "Robot-Othello", None, ("A", "B"), scores, Phase.FINISHED)

    first, other = result("east", "1", 3, 4), result("west", "7", 9, 1)
    corrected, second = result("east", "1", 5, 4), result("east", "2", 2, 2)
    results = Results(10.0)
    results.see(0.0, [first], [])
    results.see(1.0, [first, other], [])
    results.see(2.0, [corrected, other], [])
    assert results.shown(9.9) == ()
    assert results.shown(10.0) == (first,)
    assert results.shown(11.0) == (other, first)
    assert results.shown(12.0) == (other, corrected)
    results.see(13.0, [other], [("east", "2")])
    assert results.shown(30.0) == (other, corrected)
    results.see(31.0, [second, other], [])
    assert results.shown(41.0) == (second, other)
    results.see(42.0, [other], [("east", "2")])
    assert results.shown(52.0) == (other,)
