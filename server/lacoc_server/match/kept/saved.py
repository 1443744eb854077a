"""A match between two beats as bytes: all that its later beats depend on (`Match.save`)."""

from typing import Any

import msgspec

from lacoc_server.match.drive import DriveState
from lacoc_server.match.entry import Entry, weigh_in
from lacoc_server.match.kept.history import SavedHistory
from lacoc_server.match.physics import Fault
from lacoc_server.match.seat import Seat
from lacoc_server.match.staging import Places
from lacoc_server.match.state import MatchState
from lacoc_shared.codec import decode, encode, message_hash
from lacoc_shared.inputs import JoinSeat
from lacoc_shared.mistakes import FileRefused
from lacoc_shared.seat import No, Phase
from lacoc_shared.words import Phrase

_FORMAT = 3
"""Version of the layout of saved bytes; bytes with another version are refused."""


class _SavedSeat(msgspec.Struct, frozen=True, array_like=True):
    """A saved seat: the fields of a `Seat` that change. Robot and gait are made from the files."""

    join: JoinSeat | None
    coming: JoinSeat | None
    ready: bool
    silent: bool
    left: bool
    idle: bool
    state: DriveState | None
    locked_until: int
    frozen_until: int
    applied: tuple[int, int]
    refused: tuple[int, No]
    restarting: bool
    strays: int


class _SavedMatch(msgspec.Struct, frozen=True, array_like=True):
    """A saved match; the fields from `phase` on are those of `MatchState`."""

    format: int
    made_of: bytes
    """Hash of the parts of the match's setup that describe the game."""
    physics: bytes | None
    """The state of physics; None: no robots are on the field."""
    places: Places
    history: SavedHistory
    seats: tuple[_SavedSeat, ...]
    phase: Phase
    beats: int
    entered_beat: int
    countdown_beats: int
    ticks: int
    silent_beats: int
    clock_offset: int
    adjustments: dict[int, tuple[int, int]]
    declared: str | None
    ended: Phrase | None
    advice: tuple[Phrase | str, ...]
    next_wanted: bool
    fault: Fault | None
    halted_by: str
    event_count: int
    sheet_is_new: bool
    told_result: tuple[str, tuple[int, ...]] | None


_SEAT_FIELDS = _SavedSeat.__struct_fields__
_PLAIN_FIELDS = tuple(
    name
    for name in _SavedMatch.__struct_fields__
    if name not in ("format", "made_of", "physics", "places", "history", "seats")
)
_MOST_BYTES = 1 << 28
"""Longest saved match that is accepted [bytes]; a match of three minutes has 1 MB."""


def save(match: MatchState) -> bytes:
    """Return the match as bytes; see `Match.save`."""
    return encode(
        _SavedMatch(
            _FORMAT,
            _made_of(match),
            match.physics.save() if _has_robots(match) else None,
            match.staging.save(),
            match.history.save(),
            tuple(_SavedSeat(*(getattr(seat, f) for f in _SEAT_FIELDS)) for seat in match.seats),
            *(getattr(match, name) for name in _PLAIN_FIELDS),
        )
    )


def load(match: MatchState, data: bytes) -> None:
    """Let the match go on from bytes; see `Match.load`."""
    saved = decode(data, _SavedMatch, _MOST_BYTES)
    if (saved.format, saved.made_of) != (_FORMAT, _made_of(match)):
        raise ValueError(
            "it was saved by another version, or with another arena, settings or limits"
        )
    entries = [_entry(match, *pair) for pair in zip(match.seats, saved.seats, strict=True)]
    stays = entries == [seat.entry for seat in match.seats] and _has_robots(match)
    for seat, was, entry in zip(match.seats, saved.seats, entries, strict=True):
        for name in _SEAT_FIELDS:
            setattr(seat, name, getattr(was, name))
        seat.entry = entry
    if saved.physics is None:
        match.staging.clear()
        for seat in match.seats:
            seat.drive = None
    else:
        if not stays:
            match.staging.build(match.seats)
            match.begin_drives()
            for seat, was in zip(match.seats, saved.seats, strict=True):
                seat.state, seat.strays, seat.idle = was.state, was.strays, was.idle
        match.staging.load(saved.places, saved.physics)
    match.history.load(saved.history)
    for name in _PLAIN_FIELDS:
        setattr(match, name, getattr(saved, name))


def _has_robots(match: MatchState) -> bool:
    return any(seat.drive for seat in match.seats)


def _made_of(match: MatchState) -> bytes:
    setup = match.setup
    return message_hash(encode((setup.arena, setup.settings, setup.limits)))


def _entry(match: MatchState, seat: Seat, saved: _SavedSeat) -> Entry | None:
    """Return the robot and gait of a saved seat; None if nobody had the seat.

    If the seat was saved with the files that `seat` has now, these are its robot and gait.
    Otherwise they are made from the saved files.
    """
    join: Any = saved.join
    if join is None:
        return None
    if seat.join == join:
        return seat.entry
    files = (join.robot, join.postures, join.locomotion)
    try:
        return weigh_in(*files, match.limits, match.rules.open_levels)
    except FileRefused as refused:
        raise ValueError(str(refused)) from None
