"""Cuts what a page is sent into pieces of a second. No I/O."""

import secrets
from collections import deque
from collections.abc import Callable

import msgspec

from lacoc_client.web.gateway import wire
from lacoc_client.web.gateway.backlog import Backlog
from lacoc_client.web.gateway.files import PIECES_TYPE, PageFile, page_file
from lacoc_shared.codec import encode

PIECE_MS = 1000
"""How much of a match is in a piece [ms]."""
PIECES_KEPT = 30
"""Number of pieces that can still be asked for; pages and caches keep older ones."""


class Piece(msgspec.Struct, array_like=True, frozen=True):
    """What a page is sent in a second; each message is its kind and its payload."""

    start: tuple[bytes, ...]
    """All that a page needs which begins with this piece."""
    then: tuple[tuple[int, bytes], ...]
    """What comes then: when in this second [ms], and the message."""


class Cutter:
    """Stands where the socket of a page would be, and keeps what it is sent as pieces.

    Piece `n` has what came in second `n` of the run. Its bytes never change: a run has a random
    name, so no cache can confuse it with another one.

    Args:
        clock: returns the time [s].
    """

    drained: Callable[[], None] | None = None
    """Never called: nothing has to wait."""

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
        """True: it takes all that comes."""
        return True

    def watch_closely(self) -> None:
        """Do nothing: nobody steers a robot from here."""

    def write(self, framed: bytes) -> None:
        """Take in a message."""
        now_ms = self._close()
        self._then.append((now_ms - self._closed * PIECE_MS, wire.inside(framed)))
        self._backlog.take(framed)

    def closed(self) -> int:
        """Count the pieces that are whole: the newest has this number less one."""
        self._close()
        return self._closed

    def find(self, number: int) -> PageFile | None:
        """Return a piece; None if it is not whole yet, or no longer kept."""
        self._close()
        index = number - self._closed + len(self._pieces)
        return self._pieces[index] if 0 <= index < len(self._pieces) else None

    def _close(self) -> int:
        """Close the pieces whose second is over; return the time of the run [ms]."""
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
