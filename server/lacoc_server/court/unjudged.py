"""Decisions of a court in a match without a referee (`start = "ready"`, rules 7).

Each is a decision like a referee's, taken by `THE_COURT`. The record has it, so a replay does not
need to know why the court took it.
"""

from collections.abc import Callable, Sequence

from lacoc_server.match.match import Match
from lacoc_shared.decisions import Decision, Next, Official, Restart, Resume
from lacoc_shared.inputs import THE_COURT, Decide, Input
from lacoc_shared.seat import BEATS_PER_S, NOBODY, Phase
from lacoc_shared.words import Phrase, say

_RESULT_BEATS = 10 * BEATS_PER_S
"""Beats between a result and the next match, so that two players can read who has won."""
_RESUME_BEATS = BEATS_PER_S // 2
"""Beats between two attempts to resume: a fault that comes back at once must not fill the log."""


def decisions(match: Match, held: Callable[[], Sequence[bool]]) -> list[Input]:
    """Return the decisions that the court takes now in a match without a referee.

    Args:
        match: a match that begins when its seats are ready.
        held: returns for each seat whether a session holds it. After a restart of the court this is
            False until the controller has joined again, even while the seat does not yet count as
            silent.
    """
    if match.phase is Phase.FINISHED:
        return [_decide(Official())]
    if match.phase is Phase.OFFICIAL and match.by_office:
        return []  # the office says what is played next
    if match.phase is Phase.OFFICIAL:
        is_read = len(match.seats) == 1 or match.beats - match.entered_beat >= _RESULT_BEATS
        return [_decide(Next())] if is_read else []
    if match.phase is not Phase.HALTED or match.beats % _RESUME_BEATS:
        return []
    if match.halted_by != THE_COURT or match.rules_failed:
        return []  # a referee who halts a match resumes it, too; wrong rules would fail again
    if any(one and not seat.silent for one, seat in zip(held(), match.seats, strict=True)):
        return [*_put_back(match), _decide(Resume())]
    return []


def _put_back(match: Match) -> list[Input]:
    """Return decisions that restart the robots with which physics failed; none if it did not fail.

    Without these decisions physics would fail again after the match resumes.
    """
    if match.fault is None:
        return []
    return [
        _decide(Restart(seat.id), say("reason.physics-stopped"))
        for seat in match.seats
        if match.fault.seat in (seat.index, NOBODY)
    ]


def _decide(decision: Decision, reason: Phrase | str = "") -> Input:
    return Decide(THE_COURT, reason, decision)
