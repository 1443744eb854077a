"""Checks who sends a request: the organiser, staff, a team, a referee or an applicant; pure."""

import hashlib
import hmac
from collections.abc import Callable

from lacoc_shared.contest.codes import read_code
from lacoc_shared.mistakes import UserError
from lacoc_shared.network.allowance import Allowance
from lacoc_shared.words import Phrase, say

_GUESSES_HZ, _GUESSES_BURST = 20.0, 200
"""Whoever shows a wrong secret is told so: this often in a second, and this often at once. Beyond
that the answer is `Slower`. What slows down whoever guesses is the gateway
(`web.gateway.guesses`)."""


class Slower(UserError):
    """Too many wrong secrets were shown. A request with a right secret is still answered."""


class Admission:
    """Lets in requests that show the right secret.

    Args:
        organiser: the organiser's key.
        staff_of: takes a token; returns the name of the member of staff who has it, or None.
        code: returns the event code.
        team_of: takes a token; returns the team that has it, or None.
    """

    def __init__(
        self,
        organiser: str,
        staff_of: Callable[[str], str | None],
        code: Callable[[], str],
        team_of: Callable[[str], str | None],
    ) -> None:
        self._organiser = organiser
        self._staff_of = staff_of
        self._code = code
        self._team_of = team_of
        self._guesses = Allowance(_GUESSES_HZ, _GUESSES_BURST)
        self.refused = 0
        """Number of wrong secrets that were shown so far."""

    def organiser(self, secret: str, now_s: float) -> str:
        """Check the secret of the organiser or of staff; return the staff's name, or "".

        Raises:
            UserError: if this is neither the organiser's key nor a token of the staff.
        """
        if _same(secret, self._organiser):
            return ""
        if secret and (name := self._staff_of(secret)):
            return name
        raise self._wrong(say("desk.not-organiser"), now_s)

    def applicant(self, secret: str, now_s: float) -> None:
        """Check that somebody who applies has the event code.

        Raises:
            UserError: if this is not the event code.
        """
        if not _same(read_code(secret), self._code()):
            raise self._wrong(say("desk.wrong-code"), now_s)

    def team(self, secret: str, now_s: float) -> str:
        """Check the secret of a team; return the team's name.

        Raises:
            UserError: if no team has this token.
        """
        found = self._team_of(secret) if secret else None
        if found is None:
            raise self._wrong(say("desk.no-such-team"), now_s)
        return found

    def referee(self, secret: str, token: str | None, now_s: float) -> None:
        """Check that a secret is the token of a court's referee.

        Args:
            secret: the secret in the request.
            token: the token of the court's referee; None: there is no such court.
            now_s: monotonic time [s].

        Raises:
            UserError: if the secret is not this token, or there is no such court.
        """
        if not _same(secret, token or "") or not token:
            raise self._wrong(say("refused.no-referee-token"), now_s)

    def _wrong(self, why: Phrase, now_s: float) -> UserError:
        self.refused += 1
        if not self._guesses.take(1, now_s):
            return Slower(say("desk.slower"))
        return UserError(why)


def _same(shown: str, wanted: str) -> bool:
    """Return whether two secrets are equal, in a time that reveals nothing about the right one."""
    digests = (
        hashlib.blake2b(one.encode("utf-8", "surrogatepass")).digest() for one in (shown, wanted)
    )
    return hmac.compare_digest(*digests)
