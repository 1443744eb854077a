"""The sessions of a court: which session holds which seat, and why earlier ones ended."""

from collections.abc import Callable
from dataclasses import dataclass, field
from enum import StrEnum

import msgspec

from lacoc_shared.seal import SECRET_BYTES

_REMEMBERED = 64


class Why(StrEnum):
    """Reasons why a message was refused. The texts `count.*` show a referee the count of each."""

    BAD_BYTES = "bad-bytes"
    TOO_LONG = "too-long"
    UNKNOWN_SESSION = "unknown-session"
    REPLACED = "replaced"
    LEFT = "left"
    NOT_YOUR_SEAT = "not-your-seat"
    BAD_SEAL = "bad-seal"
    OLD = "old"
    STALE = "stale"
    OUT_OF_RANGE = "out-of-range"
    AHEAD = "ahead"
    FLOOD = "flood"
    WRONG_TOKEN = "wrong-token"
    OTHER_MATCH = "other-match"
    WRONG_VERSION = "wrong-version"
    BAD_NAME = "bad-name"
    BAD_FILES = "bad-files"
    BAD_DECISION = "bad-decision"


class AnyToken(msgspec.Struct):
    """Reads only the token of a request, of whatever kind the request is."""

    token: str


@dataclass
class _SeatHolder:
    seat: int
    secret: bytes
    newest: dict[str, int] = field(default_factory=dict)
    """Sequence number of the newest request, for each kind of request (`of` in `is_next`)."""


class Sessions:
    """The sessions of a court; a seat is held by at most one.

    Args:
        random_bytes: returns as many random bytes as asked.
    """

    def __init__(self, random_bytes: Callable[[int], bytes]) -> None:
        self._random_bytes = random_bytes
        self._held: dict[int, _SeatHolder] = {}
        """The sessions that hold a seat, by number."""
        self._ended: dict[int, tuple[int, Why]] = {}
        """Seat of each ended session and why it ended; only the newest are kept."""

    def begin(self, seat: int) -> tuple[int, bytes]:
        """Start a session that holds a seat; an older session of the seat ends as `REPLACED`.

        Returns:
            The session's number and its secret.
        """
        self.end(seat, Why.REPLACED)
        # Random, so that a restarted court does not take an old number for one of its own.
        number = 1 + int.from_bytes(self._random_bytes(4)) % (2**32 - 1)
        secret = self._random_bytes(SECRET_BYTES)
        self._held[number] = _SeatHolder(seat, secret)
        return number, secret

    def end(self, seat: int, why: Why) -> None:
        """End the session that holds a seat, if there is one, and remember why."""
        number = self.holder(seat)
        if number:
            del self._held[number]
            self._ended[number] = (seat, why)
        if len(self._ended) > _REMEMBERED:
            del self._ended[next(iter(self._ended))]

    def holder(self, seat: int) -> int:
        """Return the number of the session that holds a seat; 0: none."""
        return next((number for number, held in self._held.items() if held.seat == seat), 0)

    def secret(self, seat: int, number: int) -> bytes | Why:
        """Return the secret of a session that holds a seat, or why the session does not hold it."""
        if number in self._held:
            held = self._held[number]
            return held.secret if held.seat == seat else Why.NOT_YOUR_SEAT
        its_seat, why = self._ended.get(number, (seat, Why.UNKNOWN_SESSION))
        return why if its_seat == seat else Why.NOT_YOUR_SEAT

    def is_next(self, number: int, seq: int, of: str = "") -> bool:
        """Accept a sequence number if it is newer than all before it in the session.

        Args:
            number: number of a session that holds a seat.
            seq: sequence number of a request whose seal is proven.
            of: the kind of the request; only requests of the same kind are compared.

        Returns:
            Whether it was newer.
        """
        held = self._held[number]
        if seq <= held.newest.get(of, 0):
            return False
        held.newest[of] = seq
        return True
