"""The secrets of a contest: all its tokens, in a file beside the contest file.

The contest file itself contains no secret. Most tokens are made when they are first needed. If an
organiser removes or replaces a token in the file, the old token is not valid any more.
"""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import RLock

import msgspec

from lacoc_shared.command.holding import hold
from lacoc_shared.command.replacing import write
from lacoc_shared.contest.codes import code_of
from lacoc_shared.contest.tokens import digest, new_token
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

_OFFICE, _STANDBY, _ORGANISER = "office", "standby", "organiser"
_ALWAYS = (_OFFICE, _STANDBY, _ORGANISER)
"""Tokens that are made together with the first one, so that every copy of the file has them."""
_TEAM, _STAFF = "team.", "staff."
_WAIT_S = 5.0
"""Longest wait for another program that is making a token [s]."""


class Secrets:
    """The file with all tokens; only the user who made it can read it.

    Any thread or program may use it. All its methods raise `UserError` if the file can't be read or
    written.

    Args:
        path: the file; it is made when the first token is made.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._lock = RLock()
        self._read_at: tuple[int, int] | None = (0, 0)
        """State of the file (`_state`) when it was read; at first a value that no file has."""
        self._tokens: dict[str, str] = {}

    def __repr__(self) -> str:
        return f"Secrets({str(self._path)!r})"

    @property
    def office(self) -> str:
        """Token with which the office assigns matches to courts."""
        return self._of(_OFFICE)

    @property
    def standby(self) -> str:
        """Token from which the key is made that encrypts the copies for the second machine."""
        return self._of(_STANDBY)

    @property
    def organiser(self) -> str:
        """Token that opens the organiser's page."""
        return self._of(_ORGANISER)

    @property
    def event_code(self) -> str:
        """The code with which a team applies, unless the organiser has changed it."""
        return code_of(self.office)

    def referee(self, court: str) -> str:
        """Return the token of a court's referee."""
        return self._of(f"referee.{court}")

    def seat(self, court: str, seat: str) -> str:
        """Return the token of an open seat: whoever has it may sit there in an open match."""
        return self._of(f"seat.{court}.{seat}")

    def team(self, name: str) -> str:
        """Return a team's token, which is the same for the whole contest."""
        return self._of(f"{_TEAM}{name}")

    def team_of(self, token: str) -> str | None:
        """Return the team that has a token; None: nobody has it."""
        return self._owner(_TEAM, token)

    def staff(self, name: str) -> str:
        """Return the token of a member of the staff, who may do all but choose the staff."""
        return self._of(f"{_STAFF}{name}")

    def staff_of(self, token: str) -> str | None:
        """Return the member of the staff who has a token; None: nobody has it."""
        return self._owner(_STAFF, token)

    @property
    def staff_names(self) -> tuple[str, ...]:
        """The names of those members of the staff who have a token."""
        names = (name for name in self._read() if name.startswith(_STAFF))
        return tuple(sorted(name.removeprefix(_STAFF) for name in names))

    def forget(self, *teams: str) -> None:
        """Forget the tokens of teams, so that their links are not valid any more."""
        self._forget({f"{_TEAM}{name}" for name in teams})

    def forget_staff(self, name: str) -> None:
        """Forget the token of a member of the staff, so that the link is not valid any more."""
        self._forget({f"{_STAFF}{name}"})

    def _owner(self, kind: str, token: str) -> str | None:
        shown = digest(token)
        # Digests are compared, so the time that this takes tells nothing of a token.
        found = [name for name, one in self._read().items() if digest(one) == shown]
        return next((name.removeprefix(kind) for name in found if name.startswith(kind)), None)

    def _forget(self, gone: set[str]) -> None:
        self._change(lambda there: {name: one for name, one in there.items() if name not in gone})

    def check_copied(self, *courts: str) -> None:
        """Check that this file is a copy of the office's file: it has all tokens that it needs.

        On another machine than the office's, no token may be made.

        Args:
            courts: courts whose referees have tokens.

        Raises:
            UserError: if one of the tokens is missing.
        """
        wanted = {*_ALWAYS, *(f"referee.{court}" for court in courts)}
        if wanted - self._read().keys():
            raise UserError(say("contest.no-secrets", file=str(self._path)))

    def _of(self, name: str) -> str:
        tokens = self._read()
        if name not in tokens:
            missing = {one: new_token() for one in (*_ALWAYS, name)}
            tokens = self._change(lambda there: missing | there)
        return tokens[name]

    def _read(self) -> dict[str, str]:
        """Return all tokens by name, as they are in the file of the contest's tokens now."""
        with self._lock:
            try:
                now = _state(self._path)
                if now != self._read_at:
                    data = b"{}" if now is None else self._path.read_bytes()
                    self._tokens = msgspec.json.decode(data, type=dict[str, str])
                    self._read_at = now
            except (OSError, msgspec.MsgspecError) as error:
                path = str(self._path)
                raise UserError(say("command.cannot-read", path=path, why=str(error))) from None
            return self._tokens

    def _change(self, changed: Callable[[dict[str, str]], dict[str, str]]) -> dict[str, str]:
        """Change tokens in the file, and return all tokens.

        Args:
            changed: takes all tokens by name; returns those that the file shall have.
        """
        with self._lock:
            try:
                with _alone(self._path.with_name(f".{self._path.name}.lock")):
                    text = msgspec.json.format(msgspec.json.encode(changed(self._read())))
                    write(self._path, text + b"\n", secret=True, lasting=True)
            except OSError as error:
                path, why = str(self._path), error.strerror or str(error)
                raise UserError(say("command.cannot-write", path=path, why=why)) from None
            return self._read()


@contextmanager
def _alone(path: Path) -> Iterator[None]:
    """Keep other programs from changing the tokens until the `with` block ends."""
    with path.open("ab") as lock:
        end_s = time.monotonic() + _WAIT_S
        while not hold(lock):
            if time.monotonic() > end_s:
                raise TimeoutError(path)
            time.sleep(0.01)
        yield


def _state(path: Path) -> tuple[int, int] | None:
    """Return two numbers that change when the file is replaced; None: there is no file."""
    try:
        found = path.stat()
    except FileNotFoundError:
        return None
    return found.st_ino, found.st_mtime_ns
