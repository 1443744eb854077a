"""Counts keys that a bot presses in vain: its gait does not have them, or their level is closed."""

from lacoc_shared.messages import Frame
from lacoc_shared.seat import No

_IN_VAIN = (No.NO_SUCH_KEY, No.LEVEL_CLOSED)
"""Reasons that last for the whole match; only refusals for these are counted. Refusals after an [x]
and in a freeze are part of the game.
"""


class RefusedKeys:
    """Counts for each seat the pressed keys that every beat of the match would refuse.

    Args:
        seats: number of seats.
    """

    def __init__(self, seats: int) -> None:
        self._counts = [0] * seats
        self._seen = [0] * seats

    @property
    def counts(self) -> tuple[int, ...]:
        """Number of keys that were pressed in vain, by seat."""
        return tuple(self._counts)

    def see(self, frame: Frame) -> None:
        """Count the keys that were refused in the beat of a frame; frames come in their order."""
        for index, seat in enumerate(frame.seats):
            if seat.refused_seq != self._seen[index]:
                self._seen[index] = seat.refused_seq
                self._counts[index] += seat.refused_why in _IN_VAIN
