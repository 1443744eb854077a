"""How well a court holds a match: measured on the wall clock and on the links of its seats.

Pure: times, counts and beats come in, the verdict comes out. A match follows from its inputs alone,
however fast it ran, so the verdict is not part of it. The record has the verdict as a message of
its own. Only the advice to play again, which the referee reads, enters the match as an input.
"""

import math
from collections import Counter
from collections.abc import Iterator, Sequence

import msgspec

from lacoc_server.court.pace import SLOW_S
from lacoc_server.doors.inbox import Door
from lacoc_server.match.match import Beat, Match
from lacoc_shared.contest.health_limits import HealthLimits
from lacoc_shared.inputs import Input, KeySeat
from lacoc_shared.messages import HealthVerdict, LinkVerdict, Refusal
from lacoc_shared.seat import BEAT_S, BEATS_PER_S, REPEATS_HZ, RESTART_KEY, Phase
from lacoc_shared.words import Phrase, say

_LEAST_FACTOR = 1e-4
"""Smallest real-time factor that is used; it avoids a division by zero."""
_STEP_M = 0.01
"""Shortest straight piece of a robot's path that counts [m]; shorter ones may be a body's sway."""
_PUT_M = 0.05
"""Distance from the last counted point [m] from which a robot did not walk: it was put there."""
_CARRIED = 2
"""Most surplus commands of a second (more than the 10 repeats) that are counted in the next one:
with jitter, one second has 11 repeats and the next has 9.
"""


class _WalkedWay:
    """Measures how far one robot walks.

    Args:
        walked_m: how far it had walked before the court was killed [m].
    """

    def __init__(self, walked_m: float) -> None:
        self.walked_m = walked_m
        self._corner: tuple[float, float] | None = None
        """The last counted point of the robot's path [m]; None: there is none since `pause`."""

    def pause(self) -> None:
        """Do not count the path from here to the robot's next position."""
        self._corner = None

    def go(self, centre_m: tuple[float, float]) -> None:
        """Add the way from the last counted point of the path to the robot, if it is long enough.

        Then the robot's present position is the last counted point.
        """
        step_m = math.dist(self._corner, centre_m) if self._corner else math.inf
        if step_m < _STEP_M:
            return
        if step_m < _PUT_M:  # else it was put somewhere
            self.walked_m += step_m
        self._corner = centre_m


class _LinkCounts:
    """Counts what arrives on the link of one seat during PLAYING, and how long the seat is silent.

    Args:
        before: the counts before the court was killed; None: there are none.
        second_beats: number of beats in a second of wall time. Controllers repeat their commands by
            the wall clock, also at a court that runs at another speed.
    """

    def __init__(self, before: LinkVerdict | None, second_beats: int) -> None:
        self._second_beats = second_beats
        self.silences = before.silences if before else 0
        self.silent_s = before.silent_s if before else 0.0
        self.expected = before.expected if before else 0
        self.arrived = before.arrived if before else 0
        self.refused = Counter(before.refused if before else {})
        self.keys = Counter(before.keys if before else {})
        self.way = _WalkedWay(before.walked_m if before else 0.0)
        self._silent = False
        self._heard: int | None = None
        """Valid commands counted when this second began; None: no second of PLAYING has begun."""
        self._counted = 0
        """Number of beats since this second began."""
        self._carried = 0

    def count(self, silent: bool, heard: int) -> None:
        """Count one beat of PLAYING.

        Args:
            silent: whether the seat is silent.
            heard: number of valid commands that the seat's door has counted so far.
        """
        self.silent_s += silent * BEAT_S
        self.silences += silent and not self._silent
        self._silent = silent
        if self._heard is None:
            self._heard, self._counted = heard, 0
            return
        self._counted += 1
        if self._counted == self._second_beats:
            came = heard - self._heard + self._carried
            self.expected += REPEATS_HZ
            self.arrived += min(came, REPEATS_HZ)
            self._carried = max(0, min(came - REPEATS_HZ, _CARRIED))
            self._heard, self._counted = heard, 0

    def pause(self) -> None:
        """Drop the counts of the unfinished second; count again from the next beat of PLAYING."""
        self._heard = None


class MatchHealth:
    """Measures how well one match is held, also across restarts of its court.

    Args:
        match: the match.
        limits: limits beyond which the match should be played again.
        doors: counts of each seat's door before this match.
        speed: speed of the court; at 2 two beats pass in 20 ms.
        before: the newest verdict before the court was killed; None: there is none.
        resumptions: how many times the match went on after its court ended and was started again.
    """

    def __init__(
        self,
        match: Match,
        limits: HealthLimits,
        doors: Sequence[Door],
        *,
        speed: float = 1.0,
        before: HealthVerdict | None = None,
        resumptions: int = 0,
    ) -> None:
        self._match = match
        self._limits = limits
        self._speed = speed
        self._resumptions = resumptions
        self._doors_before = [Counter(door.refused) for door in doors]
        self._doors = doors
        self._now_s = self._late_s = 0.0
        self._playing_since: float | None = None
        """When the last beat began [s], if it was a beat of PLAYING; else None."""
        self._beats = before.played_beats if before else 0
        factor = max(before.real_time_factor, _LEAST_FACTOR) if before else 1.0
        # Scaled to speed 1, so that a court of another speed can go on with it.
        self._took_s = self._beats * BEAT_S / factor
        self._slow_beats = before.slow_beats if before else 0
        self._worst_late_s = before.worst_late_ms / 1000 if before else 0.0
        self._faults = before.faults if before else 0
        seats = before.seats if before else [None] * len(match.seats)
        second_beats = max(1, round(BEATS_PER_S * speed))
        self._links = [_LinkCounts(seat, second_beats) for seat in seats]

    def begin(self, now_s: float, late_s: float, doors: Sequence[Door]) -> None:
        """Note that a beat begins.

        Args:
            now_s: monotonic time.
            late_s: how late the beat begins.
            doors: counts of each seat's door so far.
        """
        self._now_s, self._late_s, self._doors = now_s, late_s, doors

    def measure(self, inputs: Sequence[Input], beat: Beat) -> HealthVerdict | None:
        """Count a beat and the outcomes of its inputs.

        Returns:
            The verdict, if one is due for the record: once a second in PLAYING, and in a beat with
            a result. Otherwise None.
        """
        self._count(inputs, beat)
        playing = beat.frame.phase == Phase.PLAYING
        due = playing and beat.frame.beat % BEATS_PER_S == 0
        return self.verdict() if due or beat.result is not None else None

    def _count(self, inputs: Sequence[Input], beat: Beat) -> None:
        self._faults += sum(event.kind == "fault" for event in beat.events)
        for item, outcome in zip(inputs, beat.outcomes, strict=True):
            if isinstance(item, KeySeat) and isinstance(outcome, Refusal):
                why = outcome.why.code.removeprefix("key.")  # `count.*` has the same names
                self._links[item.seat].refused[why] += 1
            elif isinstance(item, KeySeat):
                self._links[item.seat].keys[_key_name(item)] += 1
        if self._match.phase is not Phase.PLAYING:
            self._playing_since = None
            for link in self._links:
                link.pause()
                link.way.pause()
            return
        # The first beat of PLAYING, also after a halt, does not count: it began before PLAYING.
        if self._playing_since is not None:
            self._beats += 1
            self._took_s += (self._now_s - self._playing_since) * self._speed
            self._slow_beats += self._late_s > SLOW_S
            self._worst_late_s = max(self._worst_late_s, self._late_s)
        self._playing_since = self._now_s
        for seat, link, door in zip(self._match.seats, self._links, self._doors, strict=True):
            link.way.go(self._match.staging.centre_m(seat.index))
            if seat.left:  # the contestant has left: silence is expected
                link.pause()
            else:
                link.count(seat.silent, door.heard)

    def verdict(self) -> HealthVerdict:
        """Return the verdict on the match so far."""
        took_s = self._took_s
        verdict = HealthVerdict(
            played_beats=self._beats,
            real_time_factor=round(self._beats * BEAT_S / took_s, 4) if took_s else 1.0,
            slow_beats=self._slow_beats,
            worst_late_ms=round(self._worst_late_s * 1000, 1),
            faults=self._faults,
            resumptions=self._resumptions,
            seats=tuple(
                LinkVerdict(
                    id=seat.id,
                    silences=link.silences,
                    silent_s=round(link.silent_s, 2),
                    expected=link.expected,
                    arrived=link.arrived,
                    refused=dict(link.refused + Counter(door.refused) - before),
                    walked_m=round(link.way.walked_m, 2),
                    keys=dict(link.keys),
                )
                for seat, link, door, before in zip(
                    self._match.seats, self._links, self._doors, self._doors_before, strict=True
                )
            ),
            advice=(),
        )
        return msgspec.structs.replace(verdict, advice=tuple(advice(verdict, self._limits)))


def _key_name(item: KeySeat) -> str:
    """Return a key's name in `LinkVerdict.keys`: "x", or level and digit, such as "A2"."""
    return "x" if item.key == RESTART_KEY else f"{'AB'[item.level]}{item.key}"


def advice(verdict: HealthVerdict, limits: HealthLimits) -> Iterator[Phrase]:
    """Yield a sentence for each limit of the contest that the match exceeded."""
    if verdict.real_time_factor < limits.real_time_factor:
        yield say(
            "health.real-time", factor=verdict.real_time_factor, least=limits.real_time_factor
        )
    slow_percent = 100 * verdict.slow_beats / max(1, verdict.played_beats)
    if slow_percent > limits.slow_beats_percent:
        yield say("health.slow-beats", percent=slow_percent, most=limits.slow_beats_percent)
    if verdict.worst_late_ms > limits.worst_late_ms:
        yield say("health.late-beat", late_ms=verdict.worst_late_ms, most_ms=limits.worst_late_ms)
    for seat in verdict.seats:
        if seat.silent_s > limits.silent_s:
            yield say(
                "health.silent-seat", seat=seat.id, seconds=seat.silent_s, most_s=limits.silent_s
            )
        heard_percent = 100 * seat.arrived / max(1, seat.expected)
        if seat.expected and heard_percent < limits.heard_percent:
            yield say(
                "health.lost-commands",
                seat=seat.id,
                percent=heard_percent,
                least=limits.heard_percent,
            )
    if verdict.faults > limits.faults:
        yield say("health.faults", times=verdict.faults, most=limits.faults)
    if verdict.resumptions > limits.resumptions:
        yield say("health.restarts", times=verdict.resumptions, most=limits.resumptions)
