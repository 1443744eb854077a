"""A court's log: every event of the match, and problems outside of the match."""

from collections import Counter
from collections.abc import Callable, Iterator

import msgspec

from lacoc_shared.command import log
from lacoc_shared.messages import Event, Health
from lacoc_shared.messages.office import Assigned
from lacoc_shared.seat import BEATS_PER_S
from lacoc_shared.words import Phrase, render, say

_TROUBLE = frozenset({"advice", "fault", "rules", "silent"})
"""Kinds of events that are logged as warnings."""
_SLOW_BEATS = 30 * BEATS_PER_S
"""Fewest beats between two reports of slow beats; a busy machine has some every second."""

_Refused = tuple[str, str]
"""A seat ("": the referee's desk) and why its messages were refused."""


class CourtLog:
    """The log of one court.

    Args:
        court: its name.
    """

    def __init__(self, court: str) -> None:
        self._log = log.get(court=court)
        self._refused: Counter[_Refused] = Counter()
        self._slow_beats = 0
        self._slow_told = (0, 0)
        """Match and beat of the last report of slow beats."""
        self._trouble: Phrase | None = None
        self._wrong: Phrase | None = None
        """What was wrong with the game's code when it was last logged."""

    def event(self, match_id: str, event: Event, duration_ticks: int = 0) -> None:
        """Log an event; `duration_ticks` is the length of its match, 0 if it has no end."""
        write = self._log.warning if event.kind in _TROUBLE else self._log.info
        fields = msgspec.structs.asdict(event)
        if duration_ticks:
            fields["left_ticks"] = duration_ticks - event.clock_ticks
        _write(write, fields.pop("said"), match_id=match_id, **fields)

    def assigned(self, match_id: str, assigned: Assigned) -> None:
        """Log what the office assigned, or that the court waits for it."""
        teams = [seat.team for seat in assigned.seats]
        said = say("log.assigned", fixture=assigned.fixture, teams=teams)
        _write(self._log.info, said, match_id=match_id, kind="assigned", call=assigned.call)

    def health(self, match_id: str, health: Health) -> None:
        """Log what is new in a health message: refusals, slow beats, and trouble with the disk."""
        write = self._log.bind(match_id=match_id, match=health.match, beat=health.beat).warning
        refused = Counter(dict(_refused(health)))
        for (seat, why), count in _grown(refused, self._refused).items():
            said = say("log.refused", seat=seat, why=why, count=count)
            if not seat:
                said = say("log.refused-at-desk", why=why, count=count)
            _write(write, said, kind="refused", seat=seat, why=why, count=count)
        self._refused = refused
        slow = health.slow_beats - self._slow_beats
        at = health.match, health.beat
        if not any(seat.joined for seat in health.seats):  # a slow beat disturbs nobody yet
            self._slow_beats = health.slow_beats
        elif slow and not (
            self._slow_told[0] == at[0] and at[1] - self._slow_told[1] < _SLOW_BEATS
        ):
            worst_ms = health.worst_late_ms
            said = say("log.slow-beats", count=slow, all=health.slow_beats, worst_ms=worst_ms)
            _write(write, said, kind="slow", count=slow, worst_late_ms=worst_ms)
            self._slow_beats, self._slow_told = health.slow_beats, at
        if health.record_trouble != self._trouble:
            self._trouble = health.record_trouble
            _write(write, self._trouble or say("log.record-again"), kind="record")

    def disk(self, match_id: str, trouble: Phrase | None) -> None:
        """Log the disk's error in writing the record of a finished match, if there was one."""
        if trouble:
            _write(self._log.warning, trouble, match_id=match_id, kind="record")

    def rules(self, match_id: str, wrong: Phrase) -> None:
        """Log what is wrong with the code of the game, unless the last such line says the same."""
        if wrong != self._wrong:
            self._wrong = wrong
            _write(self._log.warning, wrong, match_id=match_id, kind="rules")

    def not_packed(self, match_id: str, error: OSError) -> None:
        """Log that a finished record could not be closed, or its segments not made one file."""
        said = say("log.not-packed", why=str(error))
        _write(self._log.warning, said, match_id=match_id, kind="record")


def _write(write: Callable[..., object], said: Phrase, **fields: object) -> None:
    """Write a line with the sentence for people and its code for programs."""
    write(render(said), code=said.code, **fields)


def _grown(now: Counter[_Refused], before: Counter[_Refused]) -> Counter[_Refused]:
    """Return by how much each count has grown.

    A count that became smaller was set to 0 for another team, so it is taken as it is.
    """
    return now - Counter({which: count for which, count in before.items() if now[which] >= count})


def _refused(health: Health) -> Iterator[tuple[_Refused, int]]:
    for seat in health.seats:
        yield from (((seat.id, why), count) for why, count in seat.refused.items())
    yield from ((("", why), count) for why, count in health.dropped.items())
