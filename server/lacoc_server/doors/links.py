"""The links of a court's seats: their round trips, and the delay that makes them equal.

Pure: the court's clock comes in as arguments. A command names the newest frame that its sender had,
and the court knows when it sent that frame. So round trips are measured without a client's clock.

A contest may make its links equal: then an answer to a frame takes effect a fixed delay after the
frame was sent. The delay is the same for every seat. Commands that arrive earlier are held until
then; commands that arrive later take effect at once and are counted
(docs/decisions/0010-equal-links.md).
"""

import math
from collections import deque
from dataclasses import dataclass, field
from typing import NamedTuple

from lacoc_shared.inputs import KeySeat
from lacoc_shared.messages import Command
from lacoc_shared.seat import BEAT_S, BEATS_PER_S, FRESH_BEATS

WINDOW_BEATS = 10 * BEATS_PER_S
"""A link is judged by its round trips in this many newest beats."""
MEASURE_BEATS = BEATS_PER_S // 2
"""Beats between two measurements of a link."""
CHANGE_BEATS = 3 * BEATS_PER_S
"""Beats between two changes of the common delay."""
LOWER_BEATS = 2
"""Smallest step down of the common delay [beats]: a delay that wavers is worse than a long one."""
TRUST_S = 2 * BEAT_S
"""Added to the p95 of a seat's round trips [s]: a command whose frame was sent longer ago than the
sum is treated as an answer to a newer frame."""


_NONE = (0, 0)
"""Match and beat that a command names if its sender had no frame."""


class Trip(NamedTuple):
    """Round trip of a seat: from a frame to the beat that has the answer to it."""

    p50_s: float
    p95_s: float


class _SentFrame(NamedTuple):
    sent_s: float
    delay_s: float
    """Time from sending the frame to the effect of answers to it [s]; 0: no common delay."""

    @property
    def due_s(self) -> float:
        # Half a beat of tolerance: a beat may begin a little early.
        return self.sent_s + self.delay_s - BEAT_S / 2


class _HeldCommand(NamedTuple):
    due_s: float
    tick: int
    command: Command
    upon: _SentFrame | None


@dataclass
class _LinkState:
    samples: deque[tuple[int, float]] = field(default_factory=deque)
    """Round trips [s], each with its tick."""
    newest: tuple[int, int] = _NONE
    """Match and beat of the newest frame that a command named."""
    trip: Trip | None = None
    held: deque[_HeldCommand] = field(default_factory=deque)
    """Held commands, in the order in which they arrived and take effect."""
    late: int = 0


class Links:
    """The links of all seats.

    Args:
        seats: number of seats.
        most_ms: longest common delay; 0: commands are not held.
    """

    def __init__(self, seats: int, most_ms: int = 0) -> None:
        self._links = [_LinkState() for _ in range(seats)]
        self._most_beats = round(most_ms / 1000 / BEAT_S)
        self._delay_beats = 0
        self._match, self._beat = 1, 0
        self._tick = 0
        """Number of beats so far, in all matches of the court."""
        self._begun_s: deque[float] = deque([0.0, 0.0], maxlen=2)
        self._frames: deque[_SentFrame] = deque(maxlen=WINDOW_BEATS)

    @property
    def delay_ms(self) -> int:
        """The common delay [ms]; 0: none."""
        return round(self._delay_beats * BEAT_S * 1000)

    def trip(self, seat: int) -> Trip | None:
        """Return a seat's round trip over the last 10 s; None if it is not known."""
        return self._links[seat].trip

    def late(self, seat: int) -> int:
        """Return how many of a seat's keys arrived too late for the common delay."""
        return self._links[seat].late

    def begin(self, now_s: float, match: int, beat: int) -> None:
        """Note that a beat of a match begins; when it is time, measure links and set the delay."""
        self._match, self._beat = match, beat
        self._tick += 1
        self._begun_s.append(now_s)
        if self._tick % MEASURE_BEATS == 0:
            for link in self._links:
                self._measure(link)
        if self._tick % CHANGE_BEATS == 0:
            self._agree()

    def sent(self, now_s: float) -> None:
        """Note when the beat's frame is sent, and the common delay of keys that answer it."""
        self._frames.append(self._frame(now_s))

    def is_ahead(self, command: Command) -> bool:
        """Return whether a command names a frame that did not exist yet."""
        return (command.match, command.seen) > (self._match, self._beat - 1)

    def heard(self, seat: int, command: Command) -> bool:
        """Measure a round trip, if a command names a newer frame than all commands before it.

        Returns:
            Whether the command proves that its sender is connected. It does if it names a newer
            frame than all commands before it, or again the newest frame that was named, while that
            frame is recent. So a recorded command proves nothing if somebody sends it again later.
        """
        link, seen = self._links[seat], (command.match, command.seen)
        if seen <= link.newest:
            is_fresh = command.match == self._match and self._beat - command.seen <= FRESH_BEATS
            return seen == link.newest and (is_fresh or seen == _NONE)
        link.newest = seen
        frame = self._seen(command)
        if frame is not None:
            link.samples.append((self._tick, self._begun_s[-1] - frame.sent_s))
        return True

    def hold(self, seat: int, command: Command) -> None:
        """Hold a new key until it takes effect; `release` then returns it."""
        link, now_s = self._links[seat], self._begun_s[-1]
        frame = self._seen(command)
        upon = frame or (self._frames[-1] if self._frames else _SentFrame(now_s, 0.0))
        # A sender could name an older frame than it had, so that its keys are held for less time.
        # Its p95 limits that.
        believed_s = TRUST_S + (link.trip.p95_s if link.trip else 0.0)
        if upon.sent_s < now_s - believed_s:
            upon = self._frame(now_s - believed_s)
        last_s = link.held[-1].due_s if link.held else 0.0
        link.held.append(_HeldCommand(max(upon.due_s, last_s), self._tick, command, frame))

    def release(self, seat: int) -> list[KeySeat]:
        """Return the keys that take effect in this beat, in their order."""
        link, released = self._links[seat], []
        while link.held and link.held[0].due_s <= self._begun_s[-1]:
            _, tick, command, frame = link.held.popleft()
            late = self._late(frame)
            link.late += late > 0
            released.append(
                KeySeat(
                    seat,
                    command.seq,
                    command.level,
                    command.key,
                    seen=command.seen if frame else 0,
                    held=self._tick - tick,
                    late=late,
                )
            )
        return released

    def drop(self, seat: int) -> None:
        """Forget the link of a seat and its held commands, because its contestant left."""
        self._links[seat] = _LinkState()

    def _frame(self, sent_s: float) -> _SentFrame:
        return _SentFrame(sent_s, self._delay_beats * BEAT_S)

    def _seen(self, command: Command) -> _SentFrame | None:
        """Find the frame that a command names, or the oldest known frame if it names an older one.

        None if the command names a frame of another match, or if no frame is known.
        """
        if command.match != self._match or not self._frames:
            return None
        return self._frames[-min(self._beat - command.seen, len(self._frames))]

    def _late(self, frame: _SentFrame | None) -> int:
        """Count the beats by which an answer to a frame is late; 0: it is in time."""
        if frame is None or not frame.delay_s or frame.due_s > self._begun_s[-2]:
            return 0
        return max(1, int((self._begun_s[-1] - frame.due_s) / BEAT_S))

    def _measure(self, link: _LinkState) -> None:
        samples = link.samples
        while samples and samples[0][0] <= self._tick - WINDOW_BEATS:
            samples.popleft()
        if not samples:
            link.trip = None
            return
        trips_s = sorted(trip_s for _, trip_s in samples)
        p50, p95 = (math.ceil(part * len(trips_s)) - 1 for part in (0.5, 0.95))
        link.trip = Trip(trips_s[p50], trips_s[p95])

    def _agree(self) -> None:
        """Set the common delay to the longest p95 of the seats' round trips, up to the limit.

        A change that would lower the delay by less than `LOWER_BEATS` is not made.
        """
        longest_s = max((link.trip.p95_s for link in self._links if link.trip), default=0.0)
        wanted = min(math.ceil(longest_s / BEAT_S), self._most_beats)
        if not self._delay_beats - LOWER_BEATS < wanted <= self._delay_beats:
            self._delay_beats = wanted
