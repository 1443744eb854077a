"""The tokens of a contest's teams: each team has one for the whole contest."""

import hashlib
import os
import threading
from pathlib import Path

import msgspec

from lacoc_server.contest.kept.replacing import write
from lacoc_shared import seal
from lacoc_shared.contest.tokens import new_token
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say


def lasting_hash(token: str) -> str:
    """Hash a team's token with a salt that is made from the token.

    So the hash is the same after each restart. A team that has the same hash in the next match of a
    court keeps its seat.
    """
    return seal.hash_token(token, hashlib.blake2b(token.encode(), digest_size=16).digest())


class TeamTokens:
    """The file of all tokens; only its owner can read it. Any thread may use it.

    Args:
        path: the file; it is made with the first token.

    Raises:
        UserError: if it can't be read.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._lock = threading.Lock()
        self._read_at: tuple[int, int] | None = None
        """State of the file (`_state`) when it was read."""
        self._tokens: dict[str, str] = {}
        self._refresh(again=True)

    def of(self, team: str) -> str:
        """Return a team's token; the first call for a team makes it.

        Raises:
            UserError: if the file can't be read, or a new token can't be written.
        """
        with self._lock:
            self._refresh()
            if team not in self._tokens:
                self._write({**self._tokens, team: new_token()})
            return self._tokens[team]

    def team_of(self, token: str) -> str | None:
        """Return the team that has a token; None: nobody has it.

        Raises:
            UserError: if the file can't be read.
        """
        shown = _digest(token)
        with self._lock:
            self._refresh()
            # Digests are compared, so the time that this takes tells nothing of a token.
            return next((team for team, one in self._tokens.items() if _digest(one) == shown), None)

    def forget(self, *teams: str) -> None:
        """Forget the tokens of teams: their links open nothing any more.

        Raises:
            UserError: if the file can't be read or written.
        """
        with self._lock:
            self._refresh()
            self._write({name: one for name, one in self._tokens.items() if name not in teams})

    def _refresh(self, again: bool = False) -> None:
        """Read the file if it has changed since it was last read; with `again`, in any case."""
        try:
            now = _state(self._path)
            if again or now != self._read_at:
                data = b"{}" if now is None else self._path.read_bytes()
                self._tokens = msgspec.json.decode(data, type=dict[str, str])
                self._read_at = now
        except (OSError, msgspec.MsgspecError) as error:
            raise UserError(
                say("command.cannot-read", path=str(self._path), why=str(error))
            ) from None

    def _write(self, tokens: dict[str, str]) -> None:
        before = os.umask(0o077)
        try:
            write(self._path, msgspec.json.encode(tokens))
        except OSError as error:
            why = error.strerror or str(error)
            raise UserError(say("command.cannot-write", path=str(self._path), why=why)) from None
        finally:
            os.umask(before)
        self._tokens, self._read_at = tokens, _state(self._path)


def _state(path: Path) -> tuple[int, int] | None:
    """Return numbers that differ each time the file is replaced; None: there is no file."""
    try:
        found = path.stat()
    except FileNotFoundError:
        return None
    return found.st_ino, found.st_mtime_ns


def _digest(token: str) -> bytes:
    return hashlib.blake2b(token.encode("utf-8", "surrogatepass"), digest_size=16).digest()
