"""The pace of a court: when the next beat is due, and how late beats begin.

Pure: the caller passes times of the monotonic clock. Only the court's loop reads that clock.
"""

from collections import deque

from lacoc_shared.seat import BEAT_S

CATCH_UP_BEATS = 5
"""Most beats by which the court catches up after a stall; time lost beyond them is not made up."""
SLOW_S = BEAT_S
"""A beat that begins later than it was due by more than this [s] is a slow beat."""
_WINDOW_BEATS = 250


class Pace:
    """Computes when beats are due.

    Args:
        now_s: monotonic time.
        speed: at 2 two beats pass in 20 ms.
        offset_s: shift of the beats [s] against multiples of 20 ms on the machine's monotonic
            clock. All processes share that clock, so different offsets keep courts from working at
            the same moment.
    """

    def __init__(self, now_s: float, speed: float = 1.0, offset_s: float = 0.0) -> None:
        self._beat_s = BEAT_S / speed
        self._due_s = now_s + (offset_s - now_s) % self._beat_s
        self._starts_s: deque[float] = deque(maxlen=_WINDOW_BEATS)
        self.late_s = 0.0
        """How late the newest beat began [s]; negative: early."""
        self.slow_beats = 0
        self.worst_late_s = 0.0

    def wait_s(self, now_s: float) -> float:
        """Return the time to wait for the next beat [s]; 0 if it is due."""
        return max(0.0, self._due_s - now_s)

    def begin(self, now_s: float) -> None:
        """Note that a beat begins now."""
        self.late_s = late_s = now_s - self._due_s
        self.worst_late_s = max(self.worst_late_s, late_s)
        if late_s > SLOW_S:
            self.slow_beats += 1
        self._due_s = max(self._due_s, now_s - CATCH_UP_BEATS * self._beat_s) + self._beat_s
        self._starts_s.append(now_s)

    @property
    def real_time_factor(self) -> float:
        """Speed of the last 250 beats divided by the wanted speed; 1: the court is on time."""
        if len(self._starts_s) < 2:
            return 1.0
        took_s = self._starts_s[-1] - self._starts_s[0]
        return (len(self._starts_s) - 1) * self._beat_s / took_s if took_s > 0 else 1.0
