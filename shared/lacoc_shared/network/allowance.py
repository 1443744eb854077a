"""A rate limit, so that a flood of messages never costs more than a fixed amount of work."""


class Allowance:
    """Lets `rate_hz` messages a second pass in the long run, and at most `burst` at once."""

    def __init__(self, rate_hz: float, burst: int) -> None:
        self._rate_hz = rate_hz
        self._burst = burst
        self._left = float(burst)
        self._last_s = 0.0

    def left(self, now_s: float) -> int:
        """Return how many more messages may pass now."""
        grown = max(0.0, now_s - self._last_s) * self._rate_hz
        self._left = min(self._burst, self._left + grown)
        self._last_s = now_s
        return int(self._left)

    def take(self, wanted: int, now_s: float) -> int:
        """Let as many of the wanted messages pass as allowed; return how many passed."""
        allowed = min(wanted, self.left(now_s))
        self._left -= allowed
        return allowed

    def take_all(self, wanted: int, now_s: float) -> bool:
        """Let all of the wanted messages pass, or none; return whether they passed."""
        return self.left(now_s) >= wanted and bool(self.take(wanted, now_s))
