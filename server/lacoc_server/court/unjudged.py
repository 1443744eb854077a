"""What a court decides by itself in a match that no referee judges (`start = "ready"`, rules 4).

Each is a decision like a referee's, in the record with the court's name: a replay needs
nothing but the record.
"""

from collections.abc import Callable, Sequence

from lacoc_server.match.match import Match
from lacoc_shared.decisions import Decision, Next, Official, Restart, Resume
from lacoc_shared.inputs import Decide, Input
from lacoc_shared.seat import BEATS_PER_S, NOBODY, Phase
from lacoc_shared.words import Phrase, say

_RESULT_BEATS = 10 * BEATS_PER_S
"""How long two can read who has won, before the next match opens."""
_RESUME_BEATS = BEATS_PER_S // 2
"""Play is resumed at most twice a second: a fault that comes back at once fills no log."""


def decisions(match: Match, held: Callable[[], Sequence[bool]]) -> list[Input]:
    """What follows from how the match is now.

    Args:
        match: begins when its seats are ready.
        held: says for each seat whether a session holds it. After a restart of the court none
            does until its controller has joined again, though the match has not missed it yet.
    """
    if match.phase is Phase.FINISHED:
        return [_decide(Official())]
    if match.phase is Phase.OFFICIAL:
        is_read = len(match.seats) == 1 or match.beats - match.entered_beat >= _RESULT_BEATS
        return [_decide(Next())] if is_read else []
    if match.phase is not Phase.HALTED or match.beats % _RESUME_BEATS:
        return []
    if any(one and not seat.silent for one, seat in zip(held(), match.seats, strict=True)):
        return [*_put_back(match), _decide(Resume())]
    return []


def _put_back(match: Match) -> list[Input]:
    """From where physics stopped it would only stop again."""
    if match.fault is None:
        return []
    return [
        _decide(Restart(seat.id), say("reason.physics-stopped"))
        for seat in match.seats
        if match.fault.seat in (seat.index, NOBODY)
    ]


def _decide(decision: Decision, reason: Phrase | str = "") -> Input:
    return Decide("court", reason, decision)
