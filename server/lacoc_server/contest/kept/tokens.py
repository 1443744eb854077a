"""The tokens of a contest's teams: each team has one for the whole contest."""

import hashlib
import os
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
    """The file of all tokens; only its owner can read it.

    Args:
        path: the file; it is made with the first token.

    Raises:
        UserError: if it can't be read.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        try:
            data = path.read_bytes() if path.exists() else b"{}"
            self._tokens = msgspec.json.decode(data, type=dict[str, str])
        except (OSError, msgspec.MsgspecError) as error:
            raise UserError(say("command.cannot-read", path=str(path), why=str(error))) from None

    def of(self, team: str) -> str:
        """Return a team's token; it is made when it is asked for the first time.

        Raises:
            UserError: if a new one can't be written.
        """
        if team not in self._tokens:
            tokens = {**self._tokens, team: new_token()}
            before = os.umask(0o077)
            try:
                write(self._path, msgspec.json.encode(tokens))
            except OSError as error:
                why = error.strerror or str(error)
                raise UserError(
                    say("command.cannot-write", path=str(self._path), why=why)
                ) from None
            finally:
                os.umask(before)
            self._tokens = tokens
        return self._tokens[team]
