"""The tokens of a contest's teams: each team has one for the whole contest."""

import hashlib
import os
import threading
from pathlib import Path

import msgspec

from lacoc_server.contest.publish import write
from lacoc_shared import seal
from lacoc_shared.contest.tokens import new_token
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say


def lasting_hash(token: str) -> str:
    """Hash a team's token with a salt of its own, so that it has the same hash after any restart.

    A court lets a team stay that has the same hash in its next match.
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
        self._tokens = self._read()

    def of(self, team: str) -> str:
        """Return a team's token; it is made when it is asked for the first time.

        Raises:
            UserError: if a new one can't be written.
        """
        with self._lock:
            if team not in self._tokens:
                self._tokens = self._read()  # another program may have made it
            if team not in self._tokens:
                self._write({**self._tokens, team: new_token()})
            return self._tokens[team]

    def team_of(self, token: str) -> str | None:
        """Return the team that has a token; None: nobody has it."""
        shown = _digest(token)
        with self._lock:
            # Digests differ from their first letter on, so the time tells nothing of a token.
            return next((team for team, one in self._tokens.items() if _digest(one) == shown), None)

    def forget(self, team: str) -> None:
        """Forget a team's token: its link opens nothing any more.

        Raises:
            UserError: if that can't be written.
        """
        with self._lock:
            self._write({name: one for name, one in self._read().items() if name != team})

    def _read(self) -> dict[str, str]:
        try:
            data = self._path.read_bytes() if self._path.exists() else b"{}"
            return msgspec.json.decode(data, type=dict[str, str])
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
        self._tokens = tokens


def _digest(token: str) -> bytes:
    return hashlib.blake2b(token.encode("utf-8", "surrogatepass"), digest_size=16).digest()
