"""Reads a summary of a record, without reading all of it."""

from pathlib import Path

import msgspec
from mcap.reader import make_reader

from lacoc_shared import codec
from lacoc_shared.messages import Sheet
from lacoc_shared.record.schema import Header, Result
from lacoc_shared.record.stream import DAMAGE

_TOPICS = ("/lacoc/header", "/lacoc/sheet", "/lacoc/result")
_MAX_BYTES = 1 << 20


class Summary(msgspec.Struct, frozen=True):
    """What a list of recordings shows of a match."""

    title: str
    """Title of the arena."""
    court: str
    number: int
    """Number of the match at its court."""
    started: str
    """Time when the match was opened, ISO 8601, UTC."""
    teams: tuple[str, ...]
    scores: tuple[int, ...]
    """Points by seat; empty: there is no result."""
    winner: str
    """Id of the winner's seat, "draw" or "void"; "": there is no result."""
    seats: tuple[str, ...]
    """The ids of the seats."""
    fork_of: str = ""
    """Id of the match of which this is a fork; "": it is not a fork."""


def summary(path: Path) -> Summary | None:
    """Read the summary of a finished record's one file; None if it is incomplete or no record.

    It reads only the parts of the file with header, sheets and results.
    """
    header: Header | None = None
    sheet: Sheet | None = None
    result: Result | None = None
    try:
        with path.open("rb") as file:
            for _, channel, message in make_reader(file).iter_messages(topics=_TOPICS):
                match channel.topic:
                    case "/lacoc/header":
                        header = header or codec.decode(message.data, Header, _MAX_BYTES)
                    case "/lacoc/sheet":
                        sheet = codec.decode(message.data, Sheet, _MAX_BYTES)
                    case _:
                        result = codec.decode(message.data, Result, _MAX_BYTES)
    except (OSError, AttributeError, *DAMAGE):  # AttributeError: the file is not MCAP
        return None
    if header is None or sheet is None:
        return None
    return Summary(
        title=sheet.title,
        court=sheet.court,
        number=sheet.match,
        started=header.started,
        teams=tuple(seat.team for seat in sheet.seats),
        scores=() if result is None else result.scores,
        winner="" if result is None else result.official or result.computed,
        seats=tuple(seat.id for seat in sheet.seats),
        fork_of=header.setup.origin.match_id if header.setup.origin else "",
    )
