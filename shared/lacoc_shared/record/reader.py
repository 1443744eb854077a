"""Reads a record: from its packed file or its segments, whole or cut anywhere."""

import struct
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from typing import Any, TypeVar

import msgspec
import zstandard
from mcap.exceptions import McapError
from mcap.records import Channel, DataEnd, Message
from mcap.records import Header as FileHeader
from mcap.stream_reader import StreamReader
from mcap.writer import MCAP0_MAGIC

from lacoc_shared import codec
from lacoc_shared.inputs import Input
from lacoc_shared.messages import Event, Scene, Sheet
from lacoc_shared.mistakes import UserError
from lacoc_shared.record import files
from lacoc_shared.record.schema import BEAT_NS, FORMAT, PROFILE, Header, Result, Touch

V = TypeVar("V")

_MAX_BYTES = 1 << 26
"""A message that is longer is not a record's (a scene has some 100 kB)."""

_DAMAGE = (
    McapError,
    codec.BadMessage,
    struct.error,
    zstandard.ZstdError,
    ValueError,
    KeyError,
    MemoryError,
    OverflowError,
)
"""What bytes that are no MCAP raise in its reader."""


@dataclass
class Record:
    """Everything that is known of a match, by beat."""

    headers: list[Header] = field(default_factory=list)
    """One for each segment, in order."""
    inputs: dict[int, tuple[Input, ...]] = field(default_factory=dict)
    """What entered the match at a beat, in order."""
    events: list[Event] = field(default_factory=list)
    frames: list[tuple[int, bytes]] = field(default_factory=list)
    """(beat, encoded `Frame`)."""
    touches: dict[int, Touch] = field(default_factory=dict)
    snapshots: list[tuple[int, bytes]] = field(default_factory=list)
    """(beat, the court's state after it)."""
    sheets: list[tuple[int, Sheet]] = field(default_factory=list)
    scenes: list[tuple[int, Scene]] = field(default_factory=list)
    result: Result | None = None
    """The newest; None while the match has not ended."""
    last_beat: int = -1
    """The last beat of which anything is known; -1: none."""
    cut: str = ""
    """Where the record stops without an end, as a sentence; "" if it was closed."""

    @property
    def header(self) -> Header:
        """The first segment's header."""
        return self.headers[0]

    @classmethod
    def read(cls, paths: Path | Iterable[Path]) -> "Record":
        """Read a record.

        A file that was never closed (a killed court, a copy that broke off) gives every whole
        message up to where it stops, and `cut` says so.

        Args:
            paths: a packed file, or a segment, with which all segments of its match are read;
                or several segments, in order.

        Raises:
            UserError: if a file is not there, not a record, of another format, or damaged, or
                if a segment is missing.
        """
        if isinstance(paths, Path):
            paths = files.record_paths(paths)
        paths = list(paths)
        record = cls()
        for path in paths:
            record._read_file(path)
        if not record.headers:
            raise UserError(
                f"There is no match in {' '.join(map(str, paths)) or 'no files'}: a record begins "
                "with its header, and none was written."
            )
        return record

    def _read_file(self, path: Path) -> None:
        try:
            data = path.read_bytes()
        except OSError as error:
            raise UserError(f"The record {path} can't be read: {error.strerror}.") from None
        if data[: len(MCAP0_MAGIC)] != MCAP0_MAGIC[: len(data)]:
            raise UserError(
                f"{path} is not a LACOC record: it is no MCAP file. Give the .mcap of a match."
            )
        ended = False
        try:
            for record in _records(data):
                if isinstance(record, DataEnd):
                    ended = True
                elif isinstance(record, FileHeader) and record.profile != PROFILE:
                    raise UserError(
                        f"{path} is an MCAP file, but not a LACOC record. Give the .mcap of a "
                        "match (an MCAP exported for Foxglove can't be read back)."
                    )
                elif isinstance(record, tuple):
                    self._take(path, *record)
        except _DAMAGE as error:
            if data[len(MCAP0_MAGIC) :].endswith(MCAP0_MAGIC):
                raise UserError(
                    f"The record {path} is damaged after beat {self.last_beat} ({error}). "
                    "Copy it again from where it was made."
                ) from None
        self.cut = (
            ""
            if ended
            else (
                f"{path} stops after beat {self.last_beat} without an end: it was never closed, or "
                "not copied whole."
            )
        )

    def _take(self, path: Path, topic: str, beat: int, data: bytes) -> None:
        """Add one message."""
        match topic:
            case "/lacoc/header":
                self._begin_segment(path, data)
                return
            case "/lacoc/result":
                self.result = _decode(data, Result)
                return
            case "/lacoc/input":
                self.inputs[beat] = (*self.inputs.get(beat, ()), _decode(data, Input))
            case "/lacoc/event":
                self.events.append(_decode(data, Event))
            case "/lacoc/frame":
                self.frames.append((beat, data))
            case "/lacoc/touch":
                self.touches[beat] = _decode(data, Touch)
            case "/lacoc/snapshot":
                self.snapshots.append((beat, data))
            case "/lacoc/sheet":
                self.sheets.append((beat, _decode(data, Sheet)))
            case "/lacoc/scene":
                self.scenes.append((beat, _decode(data, Scene)))
        self.last_beat = max(self.last_beat, beat)

    def _begin_segment(self, path: Path, data: bytes) -> None:
        found = _decode(data, _Format).format
        if found != FORMAT:
            raise UserError(
                f"The record {path} has format {found}, and this software reads format {FORMAT}. "
                "Install the version of lacoc that wrote it."
            )
        header = _decode(data, Header)
        if self.headers and header.match_id != self.header.match_id:
            raise UserError(
                f"{path} belongs to match {header.match_id}, the files before it to "
                f"{self.header.match_id}. Give the files of one match."
            )
        if header.segment != len(self.headers):
            raise UserError(
                f"{path} is segment {header.segment} of match {header.match_id}, but segment "
                f"{len(self.headers)} comes next. Put all its segments into one folder."
            )
        self.headers.append(header)
        self._forget_from(header.first_beat)

    def _forget_from(self, beat: int) -> None:
        """Drop what earlier segments hold from a beat on (`Header.first_beat`)."""
        if self.last_beat < beat:
            return
        self.last_beat = beat - 1
        self.inputs = {at: items for at, items in self.inputs.items() if at < beat}
        self.touches = {at: touch for at, touch in self.touches.items() if at < beat}
        self.events = [event for event in self.events if event.beat < beat]
        self.frames = _before(beat, self.frames)
        self.snapshots = _before(beat, self.snapshots)
        self.sheets = _before(beat, self.sheets)
        self.scenes = _before(beat, self.scenes)


class _Format(msgspec.Struct):
    """The one entry of a header that every format has."""

    format: int


def _records(data: bytes) -> Iterator[FileHeader | DataEnd | tuple[str, int, bytes]]:
    """Walk through a file: its own header, each message as (topic, beat, data), its end."""
    topics: dict[int, str] = {}
    reader = StreamReader(BytesIO(data), validate_crcs=True, record_size_limit=len(data))
    for record in reader.records:
        if isinstance(record, Message):
            yield topics[record.channel_id], record.log_time // BEAT_NS, record.data
        elif isinstance(record, Channel):
            topics[record.id] = record.topic
        elif isinstance(record, FileHeader | DataEnd):
            yield record


def _decode(data: bytes, kind: Any) -> Any:
    return codec.decode(data, kind, _MAX_BYTES)


def _before(beat: int, items: list[tuple[int, V]]) -> list[tuple[int, V]]:
    return [item for item in items if item[0] < beat]
