"""The door for whoever asks where to play; it answers with what the office told the court.

A court that was started alone tells where its own seats are. Pure. The court answers, not the
office itself: nobody but the court may answer requests at its address, so nobody can collect the
tokens of teams by answering in the office's name.
"""

import hmac
from collections import Counter
from collections.abc import Mapping

from lacoc_server.doors.sessions import Why
from lacoc_shared import codec, seal
from lacoc_shared.keyspace import COMMAND_MAX_BYTES
from lacoc_shared.messages import Refusal
from lacoc_shared.messages.office import Assigned, Where, Whereabouts
from lacoc_shared.words import say


class TeamDesk:
    """Keeps where all teams play, as the office told last, and tells each team only its own part.

    Args:
        teams: where each team plays, by the hash of its token; None: nothing is known until the
            office tells it.
    """

    def __init__(self, teams: Mapping[str, Whereabouts] | None = None) -> None:
        self._teams: Mapping[str, Whereabouts] | None = None
        self._salts: tuple[bytes, ...] = ()
        if teams is not None:
            self.tell(teams)
        self.refused: Counter[str] = Counter()
        """Number of refusals by `Why`."""

    def tell(self, teams: Mapping[str, Whereabouts]) -> None:
        """Keep what the office tells about all teams, in place of what it told before."""
        self._teams = teams
        self._salts = tuple({bytes.fromhex(one.partition("$")[0]) for one in teams})

    def where(self, payload: bytes) -> Whereabouts | Refusal:
        """Answer a team that asks where it plays.

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


def alone(court: str, assigned: Assigned) -> dict[str, Whereabouts] | None:
    """Return where the open seats are, if the court was started alone; else None.

    Args:
        court: the court's name.
        assigned: the match that the court opens without an office.
    """
    if not assigned.is_alone:
        return None
    return {
        token_hash: Whereabouts(
            team="",
            state="court",
            said=say("team.open-seat", court=court, seat=seat.id),
            court=court,
            seat=seat.id,
            open=True,
        )
        for seat in assigned.seats
        for token_hash in seat.token_hashes
    }
