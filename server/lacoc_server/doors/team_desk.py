"""The door for teams that ask where they play; it answers with what the office told the court.

Pure. The court answers, not the office itself: nobody but the court may answer requests at its
address, so nobody can collect the tokens of teams by answering in the office's name.
"""

import hmac
from collections import Counter
from collections.abc import Mapping

from lacoc_server.doors.sessions import Why
from lacoc_shared import codec, seal
from lacoc_shared.keyspace import COMMAND_MAX_BYTES
from lacoc_shared.messages import Refusal
from lacoc_shared.messages.office import Where, Whereabouts
from lacoc_shared.words import say


class TeamDesk:
    """Keeps what the office told last, and shows each team its own part of it."""

    def __init__(self) -> None:
        self._teams: Mapping[str, Whereabouts] | None = None
        """By the hash of the team's token; None: the office has told nothing yet."""
        self._salts: tuple[bytes, ...] = ()
        self.refused: Counter[str] = Counter()
        """Number of refusals by `Why`."""

    def tell(self, teams: Mapping[str, Whereabouts]) -> None:
        """Keep what the office tells about all teams, in place of what it told before."""
        self._teams = teams
        self._salts = tuple({bytes.fromhex(one.partition("$")[0]) for one in teams})

    def where(self, payload: bytes) -> Whereabouts | Refusal:
        """Answer a team.

        Args:
            payload: should be a `Where`.
        """
        try:
            token = codec.decode(payload, Where, COMMAND_MAX_BYTES).token
        except codec.BadMessage as error:
            self.refused[Why.BAD_BYTES.value] += 1
            return Refusal(say("refused.bad-request", error=str(error)))
        if self._teams is None:
            return Refusal(say("refused.office-is-silent"), again=True)
        own = [seal.hash_token(token, salt) for salt in self._salts]
        # All are compared, each in constant time: the time does not depend on the token.
        found = [
            there
            for one, there in self._teams.items()
            for mine in own
            if hmac.compare_digest(one, mine)
        ]
        if not found:
            self.refused[Why.WRONG_TOKEN.value] += 1
            return Refusal(say("refused.no-team-token"))
        return found[0]
