"""The part of a record before a fork, copied for the fork's own record.

The copy has the fork's match id, and the court's name "fork".
"""

import hashlib
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from msgspec.structs import replace

from lacoc_shared import codec
from lacoc_shared.messages import Sheet
from lacoc_shared.mistakes import UserError
from lacoc_shared.record.packed import Message
from lacoc_shared.record.reader import Record
from lacoc_shared.record.schema import ForkChanges, Header, Origin, Result, Setup
from lacoc_shared.words import say

COURT = "fork"
"""Name of the court in records of forks, which no court has played."""
_CALL = "fork"


@dataclass(frozen=True)
class ForkSource:
    """A record from which forks go on."""

    record: Record
    messages: tuple[Message, ...]
    """All messages of the record, as they are in the file."""

    @property
    def match_id(self) -> str:
        """Id of the recorded match."""
        return self.record.header.match_id

    @property
    def last_beat(self) -> int:
        """The last beat of the record from which a fork can go on."""
        return self.record.last_whole_beat

    @property
    def seats(self) -> tuple[str, ...]:
        """Ids of the seats."""
        return tuple(str(seat["id"]) for seat in self.record.header.setup.settings["seat"])

    @cached_property
    def hash(self) -> str:
        """Hash of the messages, hexadecimal; it does not change when segments become one file."""
        digest = hashlib.blake2b(digest_size=16)
        for topic, beat, data in self.messages:
            digest.update(f"{topic} {beat} {len(data)}\n".encode())
            digest.update(data)
        return digest.hexdigest()


def read_source(path: Path) -> ForkSource:
    """Read a record that is to be forked.

    Args:
        path: the file of a finished record, or any segment of one.

    Raises:
        UserError: if it can't be read, or if a part of it is lost or damaged.
    """
    messages: list[Message] = []
    record = Record.read(path, lambda *message: messages.append(message))
    if record.lost:
        raise UserError(say("fork.damaged", cut=record.cut))
    return ForkSource(record, tuple(messages))


@dataclass(frozen=True)
class Stem:
    """A record up to the beat before a fork, copied for the fork's own record."""

    record: Record
    """The record; its header, sheets and results name the fork, all else is as recorded."""
    messages: tuple[Message, ...]
    """`record` as messages, for the fork's own record; the court's health is left out."""
    setup: Setup
    """Setup of the fork."""


def stem(source: ForkSource, beat: int, match_id: str, changes: ForkChanges | None = None) -> Stem:
    """Return the part of a record before a fork, copied for the fork's own record.

    Args:
        source: the record.
        beat: first beat that the fork plays itself.
        match_id: id of the fork.
        changes: how the fork differs, to be written in its record; None: nothing is written of it.

    Raises:
        UserError: if it is neither a beat of the record nor the one after the last.
    """
    first, last = 1, source.last_beat + 1
    if not first <= beat <= last:
        raise UserError(say("fork.no-beat", beat=beat, first=first, last=last))
    setup = _setup(source, beat, match_id, changes)
    before = source.record.until(beat - 1)
    headers = [_header(header, setup) for header in before.headers]
    before.headers = headers
    before.sheets = [(number, _sheet(sheet, setup)) for number, sheet in before.sheets]
    before.results = [_result(result, setup) for result in before.results]
    return Stem(before, tuple(_messages(source, beat, setup)), setup)


def _setup(source: ForkSource, beat: int, match_id: str, changes: ForkChanges | None) -> Setup:
    """Return a fork's setup; court, match id and call of the recorded match are replaced."""
    was = source.record.header.setup
    origin = Origin(
        match_id=was.match_id or source.match_id,
        beat=beat,
        record_hash=source.hash,
        changes=changes,
    )
    assigned = was.assigned
    if assigned is not None and assigned.call:
        # The call would make this the game of a contest. Seats and files stay, because the match
        # asks for them when a team comes back.
        said = say("fixture.fork", match=origin.match_id, beat=beat)
        assigned = replace(assigned, call=_CALL, fixture=said)
    return replace(was, match_id=match_id, court=COURT, assigned=assigned, origin=origin)


def _messages(source: ForkSource, beat: int, setup: Setup) -> list[Message]:
    """Return the record's messages before a beat, with the fork's match id.

    Verdicts on how well the match was held are left out.
    """
    found: list[Message] = []
    for topic, number, data in source.messages:
        # A result has the number of beats so far, which is one more than its beat's number.
        if number >= beat + (topic == "/lacoc/result"):
            continue
        match topic:
            case "/lacoc/health":
                continue  # it was measured at a court, over more than these beats
            case "/lacoc/header":
                data = codec.encode(_header(codec.decode(data, Header, len(data)), setup))
            case "/lacoc/sheet":
                data = codec.encode(_sheet(codec.decode(data, Sheet, len(data)), setup))
            case "/lacoc/result":
                data = codec.encode(_result(codec.decode(data, Result, len(data)), setup))
        found.append((topic, number, data))
    return found


def _header(header: Header, setup: Setup) -> Header:
    return replace(header, match_id=setup.match_id, setup=setup)


def _sheet(sheet: Sheet, setup: Setup) -> Sheet:
    found = replace(sheet, match_id=setup.match_id, court=setup.court)
    assigned = setup.assigned
    if assigned is None or assigned.is_alone:
        return found
    return replace(found, call=assigned.call, fixture=assigned.fixture)


def _result(result: Result, setup: Setup) -> Result:
    return replace(result, match_id=setup.match_id, court=setup.court)
