"""Mixes sounds that begin at any time into one track."""

import numpy as np


class Mixer:
    """A stereo sound track that is taken piece by piece, from its beginning.

    Where nothing sounds it is silent.

    Args:
        most_ahead: a sound that begins more samples than this after the next one that is taken has
            a wrong time.
    """

    def __init__(self, most_ahead: int) -> None:
        self._most_ahead = most_ahead
        self._taken = 0
        self._mixed = np.zeros((0, 2), np.int32)

    def add(self, at: int, samples: bytes) -> None:
        """Add a sound to the track.

        Args:
            at: number of the sample at which the sound begins. If that part of the track was taken
                already, or the time is wrong, the sound begins with the next sample that is taken.
            samples: of the left and the right side in turn, each with 16 bits, little endian.
        """
        sound = np.frombuffer(samples, "<i2").reshape(-1, 2)
        begin = at - self._taken
        if not 0 <= begin <= self._most_ahead:
            begin = 0
        self._reach(begin + len(sound))
        self._mixed[begin : begin + len(sound)] += sound

    def take(self, until: int) -> bytes:
        """Return all samples before number `until` that were not taken yet, as bytes."""
        count = max(0, until - self._taken)
        self._reach(count)
        found, self._mixed = self._mixed[:count], self._mixed[count:]
        self._taken += count
        return np.clip(found, -32_768, 32_767).astype("<i2").tobytes()

    def _reach(self, length: int) -> None:
        missing = length - len(self._mixed)
        if missing > 0:
            self._mixed = np.concatenate([self._mixed, np.zeros((missing, 2), np.int32)])
