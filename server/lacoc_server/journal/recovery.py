"""Finds the match that a killed court left unfinished, so that it can go on."""

from dataclasses import dataclass, replace
from pathlib import Path

from lacoc_arenas.arena import Arena, is_installed
from lacoc_server.journal.replay import ResumedMatch, resume
from lacoc_server.journal.verdict import other_arithmetic
from lacoc_server.match.match import Match
from lacoc_server.world import arithmetic
from lacoc_shared.decisions import Halt
from lacoc_shared.inputs import THE_COURT, Decide, Input, JoinSeat, KeySeat
from lacoc_shared.keyspace import ASSIGN_MAX_BYTES
from lacoc_shared.messages import Event, HealthVerdict
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.files import is_held, packed_path
from lacoc_shared.record.matches import MatchName, court_matches, is_over
from lacoc_shared.record.reader import NoMatch, Record
from lacoc_shared.seat import IN_PLAY
from lacoc_shared.words import Phrase, say

_OPENING_BYTES = ASSIGN_MAX_BYTES + (1 << 14)
"""Size of a file [bytes] below which a file without a header is skipped: its court was killed while
it opened the match. The bound is that large because a header has the files of both teams.
"""


@dataclass(frozen=True)
class Unfinished:
    """A match as it was when its court was killed."""

    match: Match
    segment: int
    """Number of the record's next segment."""
    events: tuple[Event, ...]
    """Events to publish again: the court's list of them was lost."""
    last_seqs: dict[str, int]
    """Newest sequence number in the record, by seat; newer commands must have larger numbers."""
    token_hashes: dict[str, list[str]]
    """Hashes of the tokens that opened each held seat in this match, by seat, the newest first."""
    health: HealthVerdict | None
    """The newest verdict before the court was killed; None: there is none."""
    cut: Phrase | None
    """Where the match's record ends early and why; None if it is whole."""
    other_arithmetic: Phrase | None = None
    """How this machine computes differently from the machine that made the record; None: both gave
    the same bits.
    """
    is_recorded: bool = False
    """True if the match is over and its record is finished: then nothing more is recorded."""

    @property
    def inputs(self) -> list[Input]:
        """Inputs of the first beat after the restart: a halt of a match in play, else none."""
        if self.match.phase in IN_PLAY:
            why = say("reason.court-restarted")
            if self.other_arithmetic:
                why = say("reason.court-restarted-elsewhere")
            return [Decide(THE_COURT, why, Halt())]
        return []


def unfinished(folder: Path, court: str, arena: Arena) -> Unfinished | None:
    """Find the newest match of a court, if it was left unfinished; else None.

    Two kinds of matches are passed over. One is a match whose files a running process still has
    open, such as another court of this name. The other is a match with a small file without a
    header: its court was killed while it opened the match.

    Args:
        folder: folder of the records.
        court: the court's name.
        arena: arena that the court is to play.

    Raises:
        UserError: if the match was left unfinished but can't go on here; the message says why.
    """
    for name, segments in reversed(court_matches(folder, court).items()):
        if is_over(name, segments):
            return None
        if any(map(is_held, segments.values())):
            continue
        number = max(segments)
        newest = segments[number]
        try:
            record = Record.read(segments.values())
            _check_origin(record, name, arena)
            if record.gap and record.cut:
                raise UserError(record.cut)
            resumed = resume(record, folder=arena.folder)
            _check_seats(resumed.match, arena)
        except NoMatch as error:
            if newest.stat().st_size < _OPENING_BYTES:
                continue
            raise _can_not_go_on(newest, error) from None
        except UserError as error:
            raise _can_not_go_on(newest, error) from None
        return _as_left(record, resumed, number + 1)
    return None


def last_result(folder: Path, court: str, arena: Arena) -> Unfinished | None:
    """Find the newest match of a court, if the office assigned it and it is over; else None.

    Perhaps the court was ended before the office heard the result. So a court that is started again
    shows this result until the office assigns the next match. If the record can't be played
    again here, return None.

    Args:
        folder: folder of the records.
        court: the court's name.
        arena: arena that the court is to play.
    """
    name, segments = next(reversed(court_matches(folder, court).items()), (None, {}))
    if name is None or not is_over(name, segments):
        return None
    packed = packed_path(folder, str(name))
    try:
        record = Record.read([packed] if packed.exists() else segments.values())
        assigned = record.header.setup.assigned
        if assigned is None or assigned.is_alone:
            return None
        _check_origin(record, name, arena)
        resumed = resume(record, folder=arena.folder)
        _check_seats(resumed.match, arena)
    except UserError:  # another version made it, or it is damaged: the record itself remains
        return None
    found = _as_left(record, resumed, len(record.headers))
    return replace(found, is_recorded=True) if found.match.is_over else None


def _check_origin(record: Record, name: MatchName, arena: Arena) -> None:
    """Check that a record is of this arena, and of the match that its file name names.

    Raises:
        UserError: if it is not.
    """
    setup = record.header.setup
    if (setup.match_id, setup.court) != (str(name), name.court):
        raise UserError(
            say("resume.other-match", match=setup.match_id[:80], court=setup.court[:40])
        )
    by_office = setup.assigned is not None and not setup.assigned.is_alone
    if not ((by_office and is_installed(setup.arena)) or arena.plays(setup.arena)):
        raise UserError(say("resume.other-arena", played=setup.arena[:80], arena=arena.name[:80]))


def _check_seats(match: Match, arena: Arena) -> None:
    seats, wanted = ([seat.id for seat in of] for of in (match.arena.seats, arena.seats))
    if seats != wanted:
        raise UserError(say("resume.other-seats", seats=seats, wanted=wanted))


def _can_not_go_on(path: Path, error: UserError) -> UserError:
    return UserError(say("resume.cannot", file=str(path), why=error.phrase))


def _as_left(record: Record, resumed: ResumedMatch, segment: int) -> Unfinished:
    match = resumed.match
    return Unfinished(
        match,
        segment,
        tuple(event for event in record.events if event.beat <= match.beats),
        {seat.id: _last_seq(record, seat.index) for seat in match.seats},
        {seat.id: _token_hashes(record, seat.index) for seat in match.seats if seat.join},
        record.health,
        record.cut,
        _other_arithmetic(record, resumed.distance),
    )


def _other_arithmetic(record: Record, distance: float | None) -> Phrase | None:
    if distance is None:
        return None
    why = other_arithmetic(record.headers[-1].arithmetic, arithmetic.here())
    return say("resume.other-arithmetic", distance=f"{distance:.1e}", why=why)


def _token_hashes(record: Record, seat: int) -> list[str]:
    """Return the hashes of a seat's recorded joins, the newest first.

    Each start of a court without a contest file prints a new token, and people come back with it.
    """
    joins = [
        item.token_hash
        for _, items in sorted(record.inputs.items(), reverse=True)
        for item in reversed(items)
        if isinstance(item, JoinSeat) and item.seat == seat
    ]
    return [*dict.fromkeys(joins)]


def _last_seq(record: Record, seat: int) -> int:
    return max(
        (
            item.seq
            for items in record.inputs.values()
            for item in items
            if isinstance(item, KeySeat) and item.seat == seat
        ),
        default=0,
    )
