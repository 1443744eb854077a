"""Which tokens open which seat of a court: its own ones, or those of the match that is assigned.

Pure. The tokens of an assigned match belong to teams, and open a seat with the files that the
office froze.
"""

from collections.abc import Collection, Iterator, Mapping

from lacoc_server.doors.sessions import Why
from lacoc_shared import seal
from lacoc_shared.inputs import JoinSeat
from lacoc_shared.messages.office import Assigned, AssignedSeat
from lacoc_shared.words import Phrase, say


class Openings:
    """The tokens of all seats.

    Args:
        own: hashes of the court's own tokens, by seat.
    """

    def __init__(self, own: Mapping[str, Collection[str]]) -> None:
        self._own = own
        self._assigned: Assigned | None = None
        self._before: Assigned | None = None
        """What was assigned before, so that its teams are told more than that a token is wrong."""

    def admit(self, assigned: Assigned | None) -> None:
        """Take what the office assigned; None: the court's own tokens open the seats."""
        self._assigned, self._before = assigned, self._assigned

    def team(self, seat: str) -> AssignedSeat | None:
        """Return the team that the office seated; None: it seated none."""
        return None if self._assigned is None else self._assigned.seat(seat)

    def hash_of(self, seat: str, token: str) -> str | None:
        """Return the hash of a token that opens a seat; None: it does not open it."""
        assigned = self.team(seat)
        own = self._own.get(seat, ()) if self._assigned is None else ()
        return _opening(token, own if assigned is None else assigned.token_hashes)

    def why_closed(self, seat: str, token: str) -> tuple[Why, Phrase]:
        """Say why a token does not open a seat; a team of the contest is told what to do."""
        if self._assigned is not None and self._assigned.waits:
            return Why.OTHER_MATCH, say("refused.waits-for-office")
        if (found := next(_teams(self._assigned, token), None)) is not None:
            return Why.OTHER_MATCH, say("refused.other-seat", team=found.team, seat=found.id)
        if any(_teams(self._before, token)):
            return Why.OTHER_MATCH, say("refused.other-match", seat=seat)
        return Why.WRONG_TOKEN, say("refused.wrong-token", seat=seat)


def frozen_join(index: int, assigned: AssignedSeat, token_hash: str) -> JoinSeat:
    """Make the join of a team with its frozen files.

    Args:
        index: the seat's index.
        assigned: the team in the seat; its robot file must be there.
        token_hash: hash of the token that opened the seat.
    """
    robot, postures, locomotion = assigned.files
    assert robot is not None, "the court fills the robot file in"
    return JoinSeat(index, assigned.team, robot, postures, locomotion, token_hash)


def _teams(assigned: Assigned | None, token: str) -> Iterator[AssignedSeat]:
    """Yield the seats that a token opens in an assigned match."""
    for seat in assigned.seats if assigned is not None else ():
        if _opening(token, seat.token_hashes) is not None:
            yield seat


def _opening(token: str, hashes: Collection[str]) -> str | None:
    return next((one for one in hashes if seal.verify_token(token, one)), None)
