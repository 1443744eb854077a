"""The links of a court's seats: how long each takes, and the delay that makes them equal.

Pure: beats and their times come in. A command names the frame that its sender had newest, and
the court knows itself when it made that frame: so a round trip is counted by the court's clock
alone. Where a contest equalises its links, what was done upon the frame of beat b takes effect at
beat b + D, for every seat: commands that are there earlier are held until then, commands that come
later take effect at once and are counted (docs/decisions/0010-equal-links.md).
"""

import math
from collections import deque
from dataclasses import dataclass, field
from typing import NamedTuple

from lacoc_shared.inputs import KeySeat
from lacoc_shared.messages import Command
from lacoc_shared.seat import BEAT_S, BEATS_PER_S

WINDOW_BEATS = 10 * BEATS_PER_S
"""A link is judged by its last round trips."""
MEASURE_BEATS = BEATS_PER_S // 2
"""How often it is."""
CHANGE_BEATS = 3 * BEATS_PER_S
"""The common delay changes at most so often."""
LOWER_BEATS = 2
"""It is only lowered by so much or more: a delay that wavers is worse than a long one."""
TRUST_BEATS = 2
"""A command is believed to have been under way for its seat's p95 and so much more, at most."""


class Trip(NamedTuple):
    """How long a seat's commands take: from a frame to the beat that has the answer to it."""

    p50_ms: float
    p95_ms: float
    p95_beats: int


class _Sample(NamedTuple):
    tick: int
    beats: int
    ms: float


@dataclass
class _Link:
    samples: deque[_Sample] = field(default_factory=deque)
    newest: tuple[int, int] = (0, 0)
    """Match and beat of the newest frame that a command named."""
    trip: Trip | None = None
    held: deque[tuple[int, KeySeat]] = field(default_factory=deque)
    """Each with the tick in which it takes effect; in the order of their arrival."""
    late: int = 0


class Links:
    """The links of all seats.

    Args:
        seats: number of seats.
        most_ms: the common delay is never longer; 0: commands are not held.
    """

    def __init__(self, seats: int, most_ms: int = 0) -> None:
        self._links = [_Link() for _ in range(seats)]
        self._most_beats = round(most_ms / 1000 / BEAT_S)
        self._match, self._beat = 1, 0
        self._tick = 0
        """Counts beats over all matches."""
        self._begun_s: deque[float] = deque(maxlen=WINDOW_BEATS)
        self._delays = deque([(0, 0)], maxlen=WINDOW_BEATS // CHANGE_BEATS + 2)
        """The common delay by the tick of the first frame that it holds for: those who saw the
        same frame have the same delay, also while it changes."""

    @property
    def delay_ms(self) -> int:
        """The common delay; 0: none."""
        return round(self._delays[-1][1] * BEAT_S * 1000)

    def trip(self, seat: int) -> Trip | None:
        """How long a seat's commands took lately; None: not known."""
        return self._links[seat].trip

    def late(self, seat: int) -> int:
        """How many of a seat's commands came too late for the common delay."""
        return self._links[seat].late

    def begin(self, now_s: float, match: int, beat: int) -> None:
        """A beat of a match begins; frames of earlier ones may have been seen."""
        self._match, self._beat = match, beat
        self._tick += 1
        self._begun_s.append(now_s)
        if self._tick % MEASURE_BEATS == 0:
            for link in self._links:
                self._measure(link)
        if self._tick % CHANGE_BEATS == 0:
            self._agree()

    def is_ahead(self, command: Command) -> bool:
        """Whether it names a frame that was not there yet."""
        return (command.match, command.seen) > (self._match, self._beat - 1)

    def heard(self, seat: int, command: Command) -> None:
        """Take a round trip; one that names no newer frame than the last says nothing new."""
        link, seen = self._links[seat], (command.match, command.seen)
        if command.match != self._match or seen <= link.newest:
            return
        link.newest = seen
        beats = self._beat - command.seen
        begun_s = self._begun_s[-1 - min(beats, len(self._begun_s) - 1)]
        link.samples.append(_Sample(self._tick, beats, (self._begun_s[-1] - begun_s) * 1000))

    def hold(self, seat: int, command: Command) -> None:
        """Take a new key; `release` gives it back when it takes effect."""
        link, tick = self._links[seat], self._tick
        is_of_match = command.match == self._match
        seen = tick - (self._beat - command.seen if is_of_match else 0)
        # Who names an older frame than it had would be held for less: its own p95 bounds that.
        believed = max(seen, tick - TRUST_BEATS - (link.trip.p95_beats if link.trip else 0))
        delay = self._delay(believed)
        last = link.held[-1][0] if link.held else 0
        due = max(tick, believed + delay, last)
        late = max(0, due - seen - delay) if delay else 0
        link.late += late > 0
        key = KeySeat(
            seat,
            command.seq,
            command.level,
            command.key,
            seen=command.seen if is_of_match else 0,
            held=due - tick,
            late=late,
        )
        link.held.append((due, key))

    def release(self, seat: int) -> list[KeySeat]:
        """The keys that take effect in this beat, in their order."""
        held, released = self._links[seat].held, []
        while held and held[0][0] <= self._tick:
            released.append(held.popleft()[1])
        return released

    def drop(self, seat: int) -> None:
        """Forget what is held for a seat that was left."""
        self._links[seat].held.clear()

    def _measure(self, link: _Link) -> None:
        samples = link.samples
        while samples and samples[0].tick <= self._tick - WINDOW_BEATS:
            samples.popleft()
        if not samples:
            link.trip = None
            return
        ms, beats = sorted(one.ms for one in samples), sorted(one.beats for one in samples)
        p95 = math.ceil(0.95 * len(samples)) - 1
        link.trip = Trip(ms[(len(ms) - 1) // 2], ms[p95], beats[p95])

    def _agree(self) -> None:
        longest = max((link.trip.p95_beats for link in self._links if link.trip), default=0)
        wanted, delay = min(longest, self._most_beats), self._delays[-1][1]
        if wanted > delay or wanted <= delay - LOWER_BEATS:
            self._delays.append((self._tick, wanted))

    def _delay(self, tick: int) -> int:
        oldest = self._delays[0][1]
        return next((beats for since, beats in reversed(self._delays) if since <= tick), oldest)
