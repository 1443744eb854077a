"""Who holds which seat: sessions, each a number with a secret, and why one ended."""

from enum import StrEnum

from lacoc_shared import seal

_REMEMBERED = 64


class Why(StrEnum):
    """Why something was not believed; the words are what a referee sees counted."""

    BAD_BYTES = "bad bytes"
    TOO_LONG = "too long"
    UNKNOWN_SESSION = "unknown session"
    REPLACED = "replaced"
    LEFT = "left"
    NOT_YOUR_SEAT = "not your seat"
    BAD_SEAL = "bad seal"
    OLD = "old"
    OUT_OF_RANGE = "out of range"
    AHEAD = "ahead"
    FLOOD = "flood"
    WRONG_TOKEN = "wrong token"
    WRONG_VERSION = "wrong version"
    BAD_NAME = "bad name"
    BAD_FILES = "bad files"
    BAD_DECISION = "bad decision"


class Sessions:
    """The sessions of a court: at most one holds a seat."""

    def __init__(self) -> None:
        self._secrets: dict[int, tuple[int, bytes]] = {}
        """Seat and secret of each session that holds a seat."""
        self._ended: dict[int, tuple[int, Why]] = {}
        """Seat of each ended session and why it ended; the oldest are forgotten."""

    def begin(self, seat: int) -> tuple[int, bytes]:
        """Let a new session hold a seat; an older one is replaced.

        Returns:
            The session's number and its secret.
        """
        self.end(seat, Why.REPLACED)
        number, secret = seal.new_session(), seal.new_secret()
        self._secrets[number] = (seat, secret)
        return number, secret

    def end(self, seat: int, why: Why) -> None:
        """End the session that holds a seat, if there is one."""
        number = self.holder(seat)
        if number:
            del self._secrets[number]
            self._ended[number] = (seat, why)
        if len(self._ended) > _REMEMBERED:
            del self._ended[next(iter(self._ended))]

    def holder(self, seat: int) -> int:
        """Number of the session that holds a seat; 0: none."""
        return next((n for n, (held, _) in self._secrets.items() if held == seat), 0)

    def secret(self, seat: int, number: int) -> bytes | Why:
        """The secret of a session that holds a seat, or why it does not hold it."""
        if number in self._secrets:
            held, secret = self._secrets[number]
            return secret if held == seat else Why.NOT_YOUR_SEAT
        held, why = self._ended.get(number, (seat, Why.UNKNOWN_SESSION))
        return why if held == seat else Why.NOT_YOUR_SEAT
