"""Round trips on the court's clock, and the delay that makes links equal."""

from typing import NamedTuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lacoc_server.doors.links import CHANGE_BEATS, MEASURE_BEATS, TRUST_S, WINDOW_BEATS, Links, Trip
from lacoc_shared.inputs import KeySeat
from lacoc_shared.messages import Command

LEFT, RIGHT = 0, 1
BEAT_S = 0.02
SENT_S = 0.002
"""Time from the beginning of a beat until its frame is sent [s]."""
TRUST = round(TRUST_S / BEAT_S)
MOST_MS = 400
MOST = 20
WARM = 2 * CHANGE_BEATS


class Effect(NamedTuple):
    seq: int
    seen: int
    arrived: int
    beat: int
    late: int


class Clock:
    """`Links` that the test runs beat by beat (20 ms), with commands that name earlier frames."""

    def __init__(self, most_ms: int = MOST_MS) -> None:
        self.links = Links(2, most_ms)
        self.now_s = 100.0
        self.beat = -1
        self.seqs = [0, 0]
        self.effects: list[list[Effect]] = [[], []]

    def begin(self, match: int = 1) -> None:
        self.beat += 1
        self.now_s += BEAT_S
        self.links.begin(self.now_s, match, self.beat)

    def sign(self, seat: int, lag: int) -> None:
        """Send a sign of life that names the frame of `lag` beats ago."""
        self.links.heard(seat, Command(7, 0, 1, 2, 1, self.beat - lag, b""))

    def key(self, seat: int, lag: int, match: int = 1) -> None:
        self.seqs[seat] += 1
        command = Command(7, self.seqs[seat], 1, 2, match, self.beat - lag, b"")
        self.links.heard(seat, command)
        self.links.hold(seat, command)

    def end(self) -> None:
        for seat in (LEFT, RIGHT):
            for key in self.links.release(seat):
                arrived = self.beat - key.held
                effect = Effect(key.seq, key.seen, arrived, self.beat, key.late)
                self.effects[seat].append(effect)
        self.links.sent(self.now_s + SENT_S)

    def run(self, beats: int, left: int, right: int) -> None:
        """Let beats pass; in each, the two seats name frames `left` and `right` beats old."""
        for _ in range(beats):
            self.begin()
            for seat, lag in ((LEFT, left), (RIGHT, right)):
                if self.beat >= lag:
                    self.sign(seat, lag)
            self.end()


def warm(left: int, right: int, most_ms: int = MOST_MS) -> Clock:
    clock = Clock(most_ms)
    clock.run(WARM, left, right)
    return clock


def test_a_round_trip_is_counted_by_the_courts_own_beats() -> None:
    """A round trip lasts from the sending of a frame to the beat that receives the answer."""
    clock = warm(3, 11, most_ms=0)
    for seat, beats in ((LEFT, 3), (RIGHT, 11)):
        trip_s = beats * BEAT_S - SENT_S
        assert clock.links.trip(seat) == pytest.approx(Trip(trip_s, trip_s))
    assert clock.links.delay_ms == 0


def test_a_slow_court_counts_the_time_that_passed() -> None:
    """If beats take 50 ms, a round trip is still measured in real time."""
    links = Links(1)
    for beat in range(MEASURE_BEATS + 1):
        links.begin(beat * 0.05, 1, beat)
        if beat >= 2:
            links.heard(0, Command(7, 0, 1, 2, 1, beat - 2, b""))
        links.sent(beat * 0.05 + 0.01)
    assert links.trip(0) == pytest.approx(Trip(0.09, 0.09))


def test_p95_is_the_longest_but_one_of_twenty() -> None:
    """If one round trip in twenty is longer, the 95th percentile stays the same."""
    clock = Clock()
    for number in range(WINDOW_BEATS):
        clock.begin()
        if clock.beat >= 30 and number % 5 == 0:  # each names a newer frame than the one before
            clock.sign(LEFT, 4 if number % 100 else 7)
        clock.end()
    trip = clock.links.trip(LEFT)
    assert trip == pytest.approx(Trip(0.078, 0.078))


def test_the_same_frame_again_is_no_new_round_trip() -> None:
    """A command that names the same frame again, or an older one, gives no new round trip."""
    clock = warm(2, 2)
    for ago in range(1, 200):
        clock.begin()
        clock.sign(LEFT, 2)
        clock.sign(LEFT, 2 + ago % 50)
        clock.end()
    assert clock.links.trip(LEFT) == pytest.approx(Trip(0.038, 0.038))


def test_a_link_that_is_not_heard_is_not_known() -> None:
    """A seat that was not heard in the last ten seconds has no known round trip."""
    clock = warm(5, 5)
    for _ in range(WINDOW_BEATS + MEASURE_BEATS):
        clock.begin()
        clock.end()
    assert clock.links.trip(LEFT) is None


def test_a_frame_that_was_not_there_can_not_have_been_seen() -> None:
    """A frame of the current beat, or of a later match, counts as not sent yet."""
    links = Links(1)
    links.begin(1.0, 2, 10)

    def ahead(match: int, seen: int) -> bool:
        return links.is_ahead(Command(7, 1, 1, 2, match, seen, b""))

    assert not ahead(2, 9)
    assert not ahead(1, 5000)
    assert not ahead(0, 0)
    assert ahead(2, 10)
    assert ahead(3, 0)


def test_both_links_get_the_delay_of_the_slower() -> None:
    """With equal links, keys of both seats that answer the same frame act in the same beat."""
    clock = warm(1, 12)
    assert clock.links.delay_ms == 240
    for _ in range(40):
        clock.begin()
        clock.key(LEFT, 1)
        clock.key(RIGHT, 12)
        clock.end()
    assert all(one.beat == one.seen + 12 and one.late == 0 for one in clock.effects[LEFT])
    assert all(one.beat == one.seen + 12 and one.late == 0 for one in clock.effects[RIGHT])


def test_without_the_setting_nothing_is_held() -> None:
    """If the court does not make links equal, no key waits, and no key counts as late."""
    clock = warm(1, 12, most_ms=0)
    for _ in range(40):
        clock.begin()
        clock.key(LEFT, 1)
        clock.key(RIGHT, 12)
        clock.end()
    for seat in (LEFT, RIGHT):
        assert len(clock.effects[seat]) == 40
        assert all(one.beat == one.arrived and one.late == 0 for one in clock.effects[seat])
        assert clock.links.late(seat) == 0


def test_the_delay_is_capped_and_a_slower_link_is_late() -> None:
    """The common delay has a maximum, and each key over a slower link is counted as late."""
    clock = warm(1, 30)
    assert clock.links.delay_ms == MOST_MS
    clock.begin()
    clock.key(LEFT, 1)
    clock.key(RIGHT, 30)
    clock.end()
    assert clock.effects[RIGHT] == [Effect(1, clock.beat - 30, clock.beat, clock.beat, 30 - MOST)]
    assert [clock.links.late(seat) for seat in (LEFT, RIGHT)] == [0, 1]
    clock.run(MOST, 1, 30)
    assert [one.beat - one.seen for one in clock.effects[LEFT]] == [MOST]


def test_the_delay_follows_seldom_and_falls_only_by_much() -> None:
    """The common delay falls only by two beats or more, and changes at most every three seconds."""
    clock = warm(1, 12)
    clock.run(WARM + WINDOW_BEATS, 1, 11)
    assert clock.links.delay_ms == 240
    clock.run(WARM + WINDOW_BEATS, 1, 6)
    assert clock.links.delay_ms == 120
    delays = []
    for _ in range(WARM):
        clock.run(1, 1, 15)
        delays.append(clock.links.delay_ms)
    assert set(delays) == {120, 300}


def test_an_old_frame_gains_no_more_than_two_beats() -> None:
    """A key that names a frame older than its seat's round trip gains at most two beats.

    The key also counts as late.
    """
    clock = warm(2, 12)
    for claim in (2, 5, 12, 200):
        clock.begin()
        clock.key(LEFT, claim)
        clock.end()
        clock.run(20, 2, 12)
    totals = [one.beat - one.arrived for one in clock.effects[LEFT]]
    assert totals == [12 - 2, *[12 - 2 - TRUST] * 3]
    assert clock.links.late(LEFT) == 3


def test_a_link_that_was_never_measured_is_not_believed() -> None:
    """Without a known round trip, a key that names an old frame gains at most two beats."""
    clock = warm(1, 12)
    for _ in range(WINDOW_BEATS + MEASURE_BEATS):
        clock.begin()
        clock.sign(RIGHT, 12)
        clock.end()
    clock.begin()
    clock.key(LEFT, 12)
    clock.run(12, 1, 12)
    assert [one.beat - one.arrived for one in clock.effects[LEFT]] == [12 - TRUST]


def test_a_key_of_the_match_before_is_held_as_a_new_one() -> None:
    """A key that names a frame of the last match is held for the whole delay."""
    clock = warm(1, 12)
    clock.beat = -1
    clock.begin(2)
    clock.links.hold(LEFT, Command(7, 1, 1, 2, 1, 900, b""))
    for _ in range(11):
        assert clock.links.release(LEFT) == []
        clock.begin(2)
    assert clock.links.release(LEFT) == [KeySeat(LEFT, 1, 1, 2, seen=0, held=11, late=0)]


def test_a_stall_of_the_court_delays_both_alike() -> None:
    """If the court stalls, keys that answer the same frame still take effect in the same beat."""
    clock = warm(1, 12)
    clock.run(20, 1, 12)
    clock.now_s += 0.1
    clock.run(1, 1, 12)
    seen = clock.beat
    for ago in range(1, 20):  # the court catches up: five beats come at once
        clock.now_s -= BEAT_S if ago <= 5 else 0.0
        clock.begin()
        if ago == 6:  # 20 ms after the frame
            clock.key(LEFT, ago)
        if ago == 16:  # 220 ms after the frame
            clock.key(RIGHT, ago)
        clock.end()
    assert {one.seen for seat in (LEFT, RIGHT) for one in clock.effects[seat]} == {seen}
    assert clock.effects[LEFT][0].beat == clock.effects[RIGHT][0].beat
    assert [clock.links.late(seat) for seat in (LEFT, RIGHT)] == [0, 0]


def test_what_is_held_for_a_seat_that_was_left_is_forgotten() -> None:
    """When a seat becomes free, its held keys are dropped."""
    clock = warm(1, 12)
    clock.begin()
    clock.key(LEFT, 1)
    clock.links.drop(LEFT)
    clock.run(20, 1, 12)
    assert clock.effects[LEFT] == []


LAGS = st.lists(st.tuples(st.integers(1, 30), st.integers(1, 30)), min_size=20, max_size=200)


@given(st.integers(1, 25), st.integers(1, 25), LAGS, st.sampled_from([0, 20, 100, 400, 1000]))
def test_held_keys_keep_their_order_and_are_never_early_nor_held_too_long(
    left: int, right: int, lags: list[tuple[int, int]], most_ms: int
) -> None:
    """Held keys keep their order, and none is held for longer than the maximum.

    Two keys that answer the same frame in time take effect in the same beat.
    """
    clock = warm(left, right, most_ms)
    for one, other in lags:
        clock.begin()
        clock.key(LEFT, one)
        clock.key(RIGHT, other)
        clock.end()
    clock.run(2 * MOST + 60, left, right)
    most = most_ms // 20
    for seat in (LEFT, RIGHT):
        effects = clock.effects[seat]
        assert [one.seq for one in effects] == list(range(1, len(lags) + 1))
        for one in effects:
            assert one.arrived <= one.beat <= one.arrived + most
            assert one.late == 0 or most_ms
        beats = [one.beat for one in effects]
        assert beats == sorted(beats)
        assert clock.links.late(seat) == sum(one.late > 0 for one in effects)
    if not most_ms:
        return
    by_seen = [{one.seen: one for one in effects} for effects in clock.effects]
    for seen in by_seen[LEFT].keys() & by_seen[RIGHT].keys():
        pair = [by_seen[seat][seen] for seat in (LEFT, RIGHT)]
        on_time = {one.beat for one in pair if one.late == 0}
        assert len(on_time) <= 1
        assert all(one.beat - one.late in on_time or not on_time for one in pair)
