"""Says which picture of a stream is due, and skips pictures for which there was no time."""

import math


class PicturePace:
    """Counts the pictures of a stream: picture `n` is due `n / fps` seconds after the beginning."""

    def __init__(self, fps: int, began_s: float) -> None:
        self._fps = fps
        self._began_s = began_s
        self._next = 0
        self.taken = 0
        """Number of pictures that were taken."""
        self.left_out = 0
        """Number of pictures that were skipped."""

    def wait_s(self, now_s: float) -> float:
        """Return how long it is until the next picture is due [s]; 0: it is due now."""
        return max(0.0, self._began_s + self._next / self._fps - now_s)

    def take(self, now_s: float) -> int:
        """Return the number of the picture of the stream to take now.

        Skip the pictures between it and the last one that was taken.

        Args:
            now_s: the time [s]; the next picture must be due.
        """
        # A clock's last bits must not make picture 3 picture 2.
        due = math.floor((now_s - self._began_s) * self._fps + 1e-6)
        number = max(due, self._next)
        self.left_out += number - self._next
        self.taken += 1
        self._next = number + 1
        return number

    def time_s(self, number: int) -> float:
        """Return the time at which a picture of the stream is due [s], by the stream's clock."""
        return self._began_s + number / self._fps
