"""A match that a killed court left behind, ready to go on (design.md, "Record")."""

from dataclasses import dataclass
from pathlib import Path

from lacoc_server.match import Match
from lacoc_server.replay import resume
from lacoc_shared.decisions import Halt
from lacoc_shared.inputs import Decide, Input, KeySeat
from lacoc_shared.messages import Event, HealthVerdict
from lacoc_shared.record.files import is_held, record_paths
from lacoc_shared.record.reader import Record
from lacoc_shared.seat import Phase


@dataclass(frozen=True)
class Unfinished:
    """A match as it was when its court died."""

    match: Match
    segment: int
    """Number of the record's next segment."""
    events: tuple[Event, ...]
    """To be published again: the history that died with the court."""
    last_seqs: dict[str, int]
    """By seat: its sequence numbers go on after this one."""
    token_hashes: dict[str, str]
    """By seat that is held: the token that opens it."""
    health: HealthVerdict | None
    """How well it had been held until then."""

    @property
    def inputs(self) -> list[Input]:
        """What the court does first: nobody may find a match already running."""
        if self.match.phase in (Phase.PLAYING, Phase.COUNTDOWN):
            return [Decide("court", "the court was started again", Halt())]
        return []


def unfinished(folder: Path, court: str) -> Unfinished | None:
    """Find the newest match of a court whose record was not finished; None if there is none.

    A record that a running court of this name writes right now was not left behind.

    Raises:
        UserError: if there is one and it can't go on here; the message says why.
    """
    segments = [
        path
        for path in sorted(folder.glob(f"*-{court}-[0-9][0-9][0-9].*.live.mcap"))
        if not is_held(path)
    ]
    if not segments:
        return None
    paths = record_paths(segments[-1])
    record = Record.read(paths)
    match = resume(record)
    held = [seat for seat in match.seats if seat.join]
    return Unfinished(
        match,
        record.headers[-1].segment + 1,
        tuple(event for event in record.events if event.beat <= match.beats),
        {seat.id: _last_seq(record, seat.index) for seat in match.seats},
        {seat.id: seat.join.token_hash for seat in held if seat.join},
        record.health,
    )


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
