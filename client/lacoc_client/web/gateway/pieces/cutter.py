"""Collects the messages that a page would get into pieces of one second. No I/O."""

import secrets
from collections import deque
from collections.abc import Callable

import msgspec

from lacoc_client.web.gateway import wire
from lacoc_client.web.gateway.backlog import Backlog
from lacoc_client.web.gateway.files import PIECES_TYPE, PageFile, page_file
from lacoc_shared.codec import encode

PIECE_MS = 1000
"""Length of a piece [ms]."""
PIECES_KEPT = 30
"""Number of newest pieces that the gateway still serves; pages and caches keep older ones."""


class Piece(msgspec.Struct, array_like=True, frozen=True):
    """The messages of one second; each message has its kind and its payload."""

    start: tuple[bytes, ...]
    """The messages that a page needs first if it begins to watch with this piece."""
    then: tuple[tuple[int, bytes], ...]
    """The messages of this second: each with its time in the second [ms]."""


class Cutter:
    """Takes the place of a page's WebSocket, and collects each second's messages into a piece.

    A run begins when the cutter is made: piece `n` has the messages of the run's second `n`. The
    bytes of a piece never change. Each run has a random name, so no cache can confuse two runs.

    Args:
        clock: returns the time [s].
    """

    drained: Callable[[], None] | None = None
    """Never called: a cutter takes every message at once."""

    def __init__(self, clock: Callable[[], float]) -> None:
        self.run = secrets.token_hex(6)
        self._clock = clock
        self._began_s = self.heard_s = clock()
        self._backlog = Backlog()
        self._start: tuple[bytes, ...] = ()
        self._then: list[tuple[int, bytes]] = []
        self._pieces: deque[PageFile] = deque(maxlen=PIECES_KEPT)
        self._closed = 0

    @property
    def keeps_up(self) -> bool:
        """Always true: pieces take every message at once."""
        return True

    def watch_closely(self) -> None:
        """Do nothing: pages that fetch pieces steer no robot."""

    def write(self, framed: bytes) -> None:
        """Add a message to the piece of the present second."""
        now_ms = self._close()
        self._then.append((now_ms - self._closed * PIECE_MS, wire.inside(framed)))
        self._backlog.take(framed)

    def closed(self) -> int:
        """Return how many pieces are complete; the number of the newest of them is one less."""
        self._close()
        return self._closed

    def find(self, number: int) -> PageFile | None:
        """Return a piece by its number; None if it is not complete yet, or is no longer kept."""
        self._close()
        index = number - self._closed + len(self._pieces)
        return self._pieces[index] if 0 <= index < len(self._pieces) else None

    def _close(self) -> int:
        """Complete each piece whose second is over; return the time since this run began [ms]."""
        now_ms = int(1000 * (self._clock() - self._began_s))
        # After a long silence only the newest of the empty pieces are worth their bytes.
        first = max(self._closed, now_ms // PIECE_MS - PIECES_KEPT)
        if first > self._closed:
            self._begin(first)
            self._pieces.clear()
        while now_ms >= (self._closed + 1) * PIECE_MS:
            data = encode(Piece(self._start, tuple(self._then)))
            self._pieces.append(page_file(data, PIECES_TYPE))
            self._begin(self._closed + 1)
        return now_ms

    def _begin(self, number: int) -> None:
        self._closed, self._then = number, []
        self._start = tuple(wire.inside(framed) for framed in self._backlog.all())
