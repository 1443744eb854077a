"""Which tokens open which seat of a court: those of the match that is assigned.

Pure. A team's token opens the team's seat, with the files that the office fixed before. A seat
without a team has a token too: whoever has it sends a name and files.
"""

from collections.abc import Collection, Iterator

from lacoc_server.doors.sessions import Why
from lacoc_shared import seal
from lacoc_shared.inputs import JoinSeat
from lacoc_shared.messages.office import WAITING, Assigned, AssignedSeat
from lacoc_shared.words import Phrase, say


class Openings:
    """The tokens that open each seat; before the first match no token opens a seat."""

    def __init__(self) -> None:
        self._assigned = self._before = WAITING
        """The assigned match, and the one before it. A team of the match before is told that its
        match is over, not that its token is wrong."""

    def admit(self, assigned: Assigned) -> None:
        """Take the tokens of a newly assigned match in place of those of the match before."""
        self._assigned, self._before = assigned, self._assigned

    def opened(self, seat: str, token: str) -> tuple[AssignedSeat, str] | None:
        """Return the assigned seat and the token's hash if the token opens the seat, else None."""
        assigned = self._assigned.seat(seat)
        token_hash = None if assigned is None else _opening(token, assigned.token_hashes)
        return None if assigned is None or token_hash is None else (assigned, token_hash)

    def why_closed(self, seat: str, token: str) -> tuple[Why, Phrase]:
        """Say why a token does not open a seat; a team of the contest is told what to do."""
        if self._assigned.waits:
            return Why.OTHER_MATCH, say("refused.waits-for-office")
        found = next(_opened(self._assigned, token), None)
        if found is not None and found.team:
            return Why.OTHER_MATCH, say("refused.other-seat", team=found.team, seat=found.id)
        if found is None and any(_opened(self._before, token)):
            return Why.OTHER_MATCH, say("refused.other-match", seat=seat)
        return Why.WRONG_TOKEN, say("refused.wrong-token", seat=seat)


def frozen_join(index: int, assigned: AssignedSeat, token_hash: str) -> JoinSeat:
    """Make a team's request to join, with the files that the office fixed before.

    Args:
        index: the seat's index.
        assigned: the team in the seat; its robot file must be there.
        token_hash: hash of the token that opened the seat.
    """
    robot, postures, locomotion = assigned.files
    assert robot is not None, "the court fills the robot file in"
    return JoinSeat(index, assigned.team, robot, postures, locomotion, token_hash)


def _opened(assigned: Assigned, token: str) -> Iterator[AssignedSeat]:
    """Yield the seats that a token opens in an assigned match."""
    for seat in assigned.seats:
        if _opening(token, seat.token_hashes) is not None:
            yield seat


def _opening(token: str, hashes: Collection[str]) -> str | None:
    return next((one for one in hashes if seal.verify_token(token, one)), None)
